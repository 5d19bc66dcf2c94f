#pragma once
// Text files that notice when they could not be written or read.

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "checksum.hpp"

namespace crossdem {

/// The system refused a file: which, and why.
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& what)
      : std::runtime_error(path.string() + ": " + what) {}
};

/// A file that was begun could not be finished.
class WriteError : public FileError {
 public:
  using FileError::FileError;
};

/// The whole text of a file of at most `most_bytes`.
std::string read_text(const std::filesystem::path& path, std::uintmax_t most_bytes);

/// A number with all the digits it takes to read the same double back.
std::string exact(double number);

/// The first bytes of a file.
struct Beginning {
  std::uintmax_t bytes = 0;
  Checksum checksum;

  void add(std::string_view more) {
    bytes += more.size();
    checksum.add(more);
  }
};

/// The first `bytes` of a file, or as many as there are.
Beginning beginning_of(const std::filesystem::path& path, std::uintmax_t bytes);

/// Cuts off what stands behind `kept`, and nothing where that is nothing. Throws FileError.
void cut_behind(const Beginning& kept, const std::filesystem::path& path);

/// Returns when the disk has all that was written to a file or folder. Throws WriteError.
void force_to_disk(const std::filesystem::path& path);

/// A text file written line by line; each line is handed to the system at once, so that a full disk is an error and
/// readers see progress.
class LineFile {
 public:
  /// Goes on behind `kept`.
  explicit LineFile(std::filesystem::path path, const Beginning& kept = {});
  void line(const std::string& text);
  [[nodiscard]] const Beginning& written() const { return written_; }

 private:
  std::filesystem::path path_;
  std::ofstream out_;
  Beginning written_;
};

}  // namespace crossdem
