#pragma once
// What a run leaves behind: frames of motion in H5MD, rows of resistance and of the ledgers as CSV.

#include <filesystem>
#include <memory>

#include "crossdem/simulation.hpp"
#include "text_file.hpp"

namespace crossdem {

/// motion.h5 in the H5MD 1.1 layout (nongnu.org/h5md). Each frame is handed to the system as it comes.
class MotionFile {
 public:
  MotionFile(const std::filesystem::path& path, const Case& setup, const Particles& particles);
  ~MotionFile();
  MotionFile(const MotionFile&) = delete;
  MotionFile& operator=(const MotionFile&) = delete;

  /// `step` and `time` [s] since the rest was over, `bar_tip` [m].
  void frame(long step, double time, std::optional<double> bar_tip, const Particles& particles);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// resistance.csv: force of the particles on the bar, +y up.
class ResistanceFile {
 public:
  explicit ResistanceFile(const std::filesystem::path& path);
  void row(double time, double depth, const Simulation& simulation);

 private:
  LineFile file_;
};

/// ledger.csv: the momentum and energy accounts.
class LedgerFile {
 public:
  explicit LedgerFile(const std::filesystem::path& path);
  void row(double time, const Simulation& simulation);

 private:
  LineFile file_;
};

}  // namespace crossdem
