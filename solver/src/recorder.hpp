#pragma once
// What a run leaves behind: frames of motion in H5MD, rows of resistance and of the ledgers as CSV.

#include <filesystem>
#include <fstream>
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

/// frames.f64: the same frames, of a run that may be cut short at any moment; what is on its way into a file in HDF5
/// then may take all of it along. Doubles, one frame behind the other.
class FrameSpool {
 public:
  /// Goes on behind `kept`, which is `frames` whole frames.
  FrameSpool(const std::filesystem::path& path, std::size_t particles, long frames, const Beginning& kept);

  void frame(long step, double time, std::optional<double> bar_tip, const Particles& particles);
  /// All of them, from the first on.
  void copy_to(MotionFile& motion);
  [[nodiscard]] const Beginning& written() const { return written_; }

 private:
  std::filesystem::path path_;
  std::size_t particles_;
  long frames_;
  Beginning written_;
  std::fstream file_;
};

/// resistance.csv: force of the particles on the bar, +y up.
class ResistanceFile {
 public:
  /// Both go on behind `kept`.
  explicit ResistanceFile(const std::filesystem::path& path, const Beginning& kept = {});
  void row(double time, double depth, const Simulation& simulation);
  [[nodiscard]] const Beginning& written() const { return file_.written(); }

 private:
  LineFile file_;
};

/// ledger.csv: the momentum and energy accounts.
class LedgerFile {
 public:
  explicit LedgerFile(const std::filesystem::path& path, const Beginning& kept = {});
  void row(double time, const Simulation& simulation);
  [[nodiscard]] const Beginning& written() const { return file_.written(); }

 private:
  LineFile file_;
};

}  // namespace crossdem
