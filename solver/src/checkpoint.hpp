#pragma once
// A run on its way, in a file from which it can be carried on to the last bit.

#include <cstdint>
#include <filesystem>
#include <string>

#include "crossdem/packing.hpp"
#include "crossdem/simulation.hpp"
#include "text_file.hpp"

namespace crossdem {

/// How much of a file belongs to a checkpoint.
struct FileMark {
  std::uintmax_t bytes = 0;
  std::uint64_t checksum = Checksum().value();
};

/// How far a run has come, and how much of its files belongs to that.
struct Progress {
  long rested = 0;     // steps of the rest
  long recorded = -1;  // steps since the rest was over, of the latest output; -1: none
  long frames = 0;
  long samples = 0;
  FileMark resistance;
  FileMark ledger;
  FileMark spool;
};

/// The file `checkpoint` of a run's folder. It is there as a whole or not at all.
class CheckpointFile {
 public:
  CheckpointFile(const std::filesystem::path& folder, const Case& setup, const Packing& packing);

  /// Whether `folder` holds one.
  static bool is_in(const std::filesystem::path& folder);

  /// Whether the folder holds nothing but the first one, which was being written when its run was cut short.
  [[nodiscard]] bool was_begun() const;

  /// Names case, packing and program [hex].
  [[nodiscard]] std::string run() const;

  /// In the place of the one before. Throws WriteError, FileError.
  void write(const Progress& progress, const Simulation& simulation) const;

  /// Carries `simulation`, of the same case and packing, to where it was. Throws FileError where the file is damaged,
  /// or of another case, packing or program.
  void read(Progress& progress, Simulation& simulation) const;

  /// Why the run cannot be carried on.
  [[nodiscard]] FileError refusal(const std::filesystem::path& file, const std::string& why) const;

  void remove() const;

 private:
  std::filesystem::path path_;
  std::uint64_t case_;  // checksums
  std::uint64_t packing_;
  std::uint64_t program_;
};

}  // namespace crossdem
