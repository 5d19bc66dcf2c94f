#pragma once
// Text files that notice when they could not be written or read.

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

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

/// Cuts off what stands behind the first `bytes` of a file. Throws FileError where there are fewer.
void cut_to(const std::filesystem::path& path, std::uintmax_t bytes);

/// A text file written line by line; each line is handed to the system at once, so that a full disk is an error and
/// readers see progress.
class LineFile {
 public:
  /// Goes on behind the first `keep` bytes of what is there. Throws FileError where there are fewer.
  explicit LineFile(std::filesystem::path path, std::uintmax_t keep = 0);
  void line(const std::string& text);
  [[nodiscard]] std::uintmax_t bytes() const { return bytes_; }

 private:
  std::filesystem::path path_;
  std::ofstream out_;
  std::uintmax_t bytes_;
};

}  // namespace crossdem
