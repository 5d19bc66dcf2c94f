#pragma once
// A run on its way, in a file from which it can be carried on to the last bit.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "crossdem/packing.hpp"
#include "crossdem/simulation.hpp"

namespace crossdem {

/// How far a run has come, and how much of its files belongs to that.
struct Progress {
  long rested = 0;     // steps of the rest
  long recorded = -1;  // steps since the rest was over, of the latest output; -1: none
  long frames = 0;
  long samples = 0;
  std::uintmax_t resistance_bytes = 0;
  std::uintmax_t ledger_bytes = 0;
};

/// The file `checkpoint` of a run's folder. It is there as a whole or not at all.
class CheckpointFile {
 public:
  CheckpointFile(const std::filesystem::path& folder, const Case& setup, const Packing& packing);

  /// Whether `folder` holds one.
  static bool is_in(const std::filesystem::path& folder);

  /// Names case and packing [hex].
  [[nodiscard]] std::string run() const;

  /// Removes one that was being written when its run was cut short.
  static void remove_unfinished(const std::filesystem::path& folder);

  /// In the place of the one before. Throws WriteError.
  void write(const Progress& progress, const Simulation& simulation) const;

  /// Carries `simulation`, of the same case and packing, to where it was. Throws FileError where the file is damaged,
  /// or of another case, packing or build of the solver.
  void read(Progress& progress, Simulation& simulation) const;

  void remove() const;

 private:
  std::filesystem::path path_;
  std::uint64_t case_;  // checksums
  std::uint64_t packing_;
};

}  // namespace crossdem
