#include "crossdem/run.hpp"

#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>

#include "checkpoint.hpp"
#include "crossdem/version.hpp"
#include "recorder.hpp"

namespace crossdem {
namespace {

constexpr const char* motion_file = "motion.h5";
constexpr const char* spool_file = "frames.f64";
constexpr const char* end_file = "run.json";  // written last

/// The files of a run, as far as `progress` says.
class Recording {
 public:
  /// `spools`: the run may be cut short and carried on.
  Recording(const Case& setup, const std::filesystem::path& folder, const Particles& particles, Progress& progress,
            bool spools)
      : setup_(setup),
        folder_(folder),
        progress_(progress),
        resistance_(folder / "resistance.csv", progress.resistance_bytes),
        ledger_(folder / "ledger.csv", progress.ledger_bytes) {
    if (spools)
      spool_.emplace(folder / spool_file, particles.count(), progress.frames);
    else
      motion_.emplace(folder / motion_file, setup, particles);
  }

  /// What is due `step` steps after the rest.
  void record(long step, const Simulation& simulation) {
    const TimeControl& time = setup_.time;
    // Times come from the count of intervals, not of steps: engines with other time steps must write the same times.
    if (step % time.steps_in(time.sample_interval) == 0) {
      const double now = static_cast<double>(progress_.samples) * time.sample_interval;
      const double bar_speed = setup_.bar ? setup_.bar->speed : 0.0;
      resistance_.row(now, bar_speed * now, simulation);
      ledger_.row(now, simulation);
      ++progress_.samples;
    }
    if (step % time.steps_in(time.frame_interval) == 0) {
      const double now = static_cast<double>(progress_.frames) * time.frame_interval;
      if (spool_)
        spool_->frame(step, now, simulation.bar_tip(), simulation.particles());
      else
        motion_->frame(step, now, simulation.bar_tip(), simulation.particles());
      ++progress_.frames;
    }
    progress_.recorded = step;
    progress_.resistance_bytes = resistance_.bytes();
    progress_.ledger_bytes = ledger_.bytes();
  }

  /// Makes motion.h5 of the frames that were spooled.
  void make_motion(const Particles& particles) {
    if (!spool_) return;
    motion_.emplace(folder_ / motion_file, setup_, particles);
    spool_->copy_to(*motion_);
    motion_.reset();
  }

 private:
  const Case& setup_;
  std::filesystem::path folder_;
  Progress& progress_;
  ResistanceFile resistance_;
  LedgerFile ledger_;
  std::optional<MotionFile> motion_;
  std::optional<FrameSpool> spool_;
};

/// Writes a checkpoint when one is due; never without an interval.
class Checkpoints {
 public:
  Checkpoints(const CheckpointFile& file, std::optional<double> every) : file_(file), every_(every) {}

  void look(const Progress& progress, const Simulation& simulation) {
    if (!every_ || std::chrono::duration<double>(Clock::now() - latest_).count() < *every_) return;
    file_.write(progress, simulation);
    latest_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  const CheckpointFile& file_;
  std::optional<double> every_;  // [s]
  Clock::time_point latest_ = Clock::now();
};

void remove_spool(const std::filesystem::path& folder) {
  std::error_code none;
  std::filesystem::remove(folder / spool_file, none);
}

/// Whether the run named so has ended in `folder`. Throws FileError where another one has.
bool has_ended(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path end = folder / end_file;
  if (CheckpointFile::is_in(folder) || !std::filesystem::exists(end)) return false;
  const nlohmann::json told = nlohmann::json::parse(read_text(end, 1 << 20), nullptr, false);
  if (!told.is_object() || told.value("run", nlohmann::json()) != name)
    throw FileError(folder, "holds a run of another case or packing, which has ended; choose another folder");
  remove_spool(folder);
  return true;
}

void write_end(const Case& setup, const std::filesystem::path& folder, const std::string& name,
               const Progress& progress, const Simulation& simulation) {
  const nlohmann::json done = {{"completed", true},
                               {"engine", "native"},
                               {"run", name},
                               {"version", version_line()},
                               {"rest_steps", setup.time.steps_in(setup.time.rest)},
                               {"penetration_steps", progress.recorded},
                               {"particles", simulation.particles().count()},
                               {"frames", progress.frames},
                               {"samples", progress.samples}};
  LineFile(folder / end_file).line(done.dump(2));
}

}  // namespace

bool can_be_carried_on(const std::filesystem::path& folder) {
  CheckpointFile::remove_unfinished(folder);
  return CheckpointFile::is_in(folder) || std::filesystem::exists(folder / end_file);
}

void run(const Case& setup, Packing packing, const std::filesystem::path& folder, std::size_t threads,
         std::optional<double> checkpoint_every) {
  const TimeControl& time = setup.time;
  const long rest = time.steps_in(time.rest);
  const long total = time.steps_in(time.penetration);
  const long per_sample = time.steps_in(time.sample_interval);
  const long between_outputs = std::gcd(per_sample, time.steps_in(time.frame_interval));

  const CheckpointFile checkpoint(folder, setup, packing);
  if (checkpoint_every && has_ended(folder, checkpoint.run())) return;
  Simulation simulation(setup, particles_of(packing, setup), packing.bar_tip, threads);
  packing = {};  // a large one takes a tenth of all memory
  Progress progress;
  if (checkpoint_every) {
    if (CheckpointFile::is_in(folder))
      checkpoint.read(progress, simulation);
    else
      checkpoint.write(progress, simulation);  // before all other files: where there are any, it is there
  }
  Checkpoints checkpoints(checkpoint, checkpoint_every);
  Recording recording(setup, folder, simulation.particles(), progress, checkpoint_every.has_value());

  try {
    while (progress.rested < rest) {
      const long steps = std::min(rest - progress.rested, per_sample);
      simulation.advance(steps);
      progress.rested += steps;
      simulation.check();
      checkpoints.look(progress, simulation);
    }
    if (progress.recorded < 0) {
      if (setup.bar) simulation.start_bar();
      simulation.check();
      recording.record(0, simulation);
    }
    while (progress.recorded < total) {
      checkpoints.look(progress, simulation);
      simulation.advance(between_outputs);
      simulation.check();
      recording.record(progress.recorded + between_outputs, simulation);
    }
  } catch (const SimulationError&) {
    recording.make_motion(simulation.particles());
    checkpoint.remove();
    remove_spool(folder);
    throw;
  }
  recording.make_motion(simulation.particles());
  write_end(setup, folder, checkpoint.run(), progress, simulation);
  if (!checkpoint_every) return;
  checkpoint.remove();
  remove_spool(folder);
}

}  // namespace crossdem
