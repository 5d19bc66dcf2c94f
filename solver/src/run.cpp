#include "crossdem/run.hpp"

#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>

#include "checkpoint.hpp"
#include "crossdem/version.hpp"
#include "recorder.hpp"
#include "run_folder.hpp"

namespace crossdem {
namespace {

constexpr const char* resistance_file = "resistance.csv";
constexpr const char* ledger_file = "ledger.csv";
constexpr const char* motion_file = "motion.h5";
constexpr const char* spool_file = "frames.f64";
constexpr const char* end_file = "run.json";  // written last

/// What of a run's files belongs to its checkpoint.
struct Kept {
  Beginning resistance;
  Beginning ledger;
  Beginning spool;
};

/// Throws FileError where they are not as they were then.
Kept kept_of(const CheckpointFile& checkpoint, const Progress& progress, const std::filesystem::path& folder) {
  const auto kept = [&](const char* name, const FileMark& mark) {
    const Beginning found = beginning_of(folder / name, mark.bytes);
    if (found.bytes == mark.bytes && found.checksum.value() == mark.checksum) return found;
    throw checkpoint.refusal(folder / name, "is not as the checkpoint says");
  };
  return {kept(resistance_file, progress.resistance), kept(ledger_file, progress.ledger),
          kept(spool_file, progress.spool)};
}

/// The files of a run, behind what is kept of them.
class Recording {
 public:
  /// `spools`: the run may be cut short and carried on.
  Recording(const Case& setup, const std::filesystem::path& folder, const Particles& particles, Progress& progress,
            const Kept& kept, bool spools)
      : setup_(setup),
        folder_(folder),
        progress_(progress),
        resistance_(folder / resistance_file, kept.resistance),
        ledger_(folder / ledger_file, kept.ledger) {
    if (spools)
      spool_.emplace(folder / spool_file, particles.count(), progress.frames, kept.spool);
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
  }

  /// Enters into the progress how far the files go, with all of that on the disk.
  void mark() {
    force_to_disk(folder_ / resistance_file);
    force_to_disk(folder_ / ledger_file);
    force_to_disk(folder_ / spool_file);
    progress_.resistance = mark_of(resistance_.written());
    progress_.ledger = mark_of(ledger_.written());
    progress_.spool = mark_of(spool_->written());
  }

  /// Makes motion.h5 of the frames that were spooled.
  void make_motion(const Particles& particles) {
    motion_.emplace(folder_ / motion_file, setup_, particles);
    spool_->copy_to(*motion_);
    motion_.reset();
    for (const char* file : {resistance_file, ledger_file, motion_file}) force_to_disk(folder_ / file);
  }

 private:
  const Case& setup_;
  std::filesystem::path folder_;
  Progress& progress_;
  ResistanceFile resistance_;
  LedgerFile ledger_;
  std::optional<MotionFile> motion_;
  std::optional<FrameSpool> spool_;

  static FileMark mark_of(const Beginning& written) { return {written.bytes, written.checksum.value()}; }
};

/// Writes a checkpoint when one is due.
class Checkpoints {
 public:
  Checkpoints(const CheckpointFile& file, Recording& recording, double every)
      : file_(file), recording_(recording), every_(every) {}

  void look(const Progress& progress, const Simulation& simulation) {
    if (std::chrono::duration<double>(Clock::now() - latest_).count() < every_) return;
    recording_.mark();
    file_.write(progress, simulation);
    latest_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  const CheckpointFile& file_;
  Recording& recording_;
  double every_;  // [s]
  Clock::time_point latest_ = Clock::now();
};

/// Removes what a run that has ended no longer needs; the checkpoint last, which says whose the spool is.
void remove_checkpoint(const CheckpointFile& checkpoint, const std::filesystem::path& folder) {
  std::error_code none;
  if (CheckpointFile::is_in(folder)) std::filesystem::remove(folder / spool_file, none);
  checkpoint.remove();
}

/// `error`: why the motion could not go on.
void write_end(const Case& setup, const std::filesystem::path& folder, const CheckpointFile& checkpoint,
               const Progress& progress, const Simulation& simulation, const char* error) {
  nlohmann::json done = {{"completed", error == nullptr},
                         {"engine", "native"},
                         {"run", checkpoint.run()},
                         {"version", version_line()},
                         {"rest_steps", setup.time.steps_in(setup.time.rest)},
                         {"penetration_steps", progress.recorded},
                         {"particles", simulation.particles().count()},
                         {"frames", progress.frames},
                         {"samples", progress.samples}};
  if (error != nullptr) done["error"] = error;
  LineFile(folder / end_file).line(done.dump(2));
}

/// Whether the run of `checkpoint` has ended in `folder`. Throws SimulationError where that was because of one,
/// FileError where another run has ended.
bool has_ended(const CheckpointFile& checkpoint, const std::filesystem::path& folder) {
  const auto is_file = [&](const char* name) {
    std::error_code none;
    return std::filesystem::is_regular_file(folder / name, none);
  };
  if (!is_file(end_file)) return false;
  const nlohmann::json told = nlohmann::json::parse(read_text(folder / end_file, 1 << 20), nullptr, false);
  if (!told.is_object() || told.value("run", nlohmann::json()) != checkpoint.run()) {
    if (CheckpointFile::is_in(folder)) return false;  // it was being written
    throw checkpoint.refusal(folder / end_file, "is of a run of another case, packing or build, or damaged");
  }
  for (const char* name : {motion_file, resistance_file, ledger_file})
    if (!is_file(name)) throw checkpoint.refusal(folder / name, "is missing");
  remove_checkpoint(checkpoint, folder);
  const nlohmann::json error = told.value("error", nlohmann::json());
  if (error.is_string()) throw SimulationError(error.get<std::string>());
  return true;
}

}  // namespace

void run(const Case& setup, Packing packing, const std::filesystem::path& folder, std::size_t threads,
         std::optional<double> checkpoint_every) {
  const TimeControl& time = setup.time;
  const long rest = time.steps_in(time.rest);
  const long total = time.steps_in(time.penetration);
  const long per_sample = time.steps_in(time.sample_interval);
  const long between_outputs = std::gcd(per_sample, time.steps_in(time.frame_interval));

  const FolderLock lock(folder);
  const CheckpointFile checkpoint(folder, setup, packing);
  const bool keeps_checkpoints = checkpoint_every.has_value();
  if (keeps_checkpoints && has_ended(checkpoint, folder)) return;
  const bool was_cut_short = CheckpointFile::is_in(folder);
  if (was_cut_short && !keeps_checkpoints)
    throw FileError(folder, "holds a run that was cut short; give --checkpoint-every, with which it goes on");
  if (!was_cut_short && !(keeps_checkpoints && checkpoint.was_begun())) claim_folder(folder);

  Simulation simulation(setup, particles_of(packing, setup), packing.bar_tip, threads);
  packing = {};  // a large one takes a tenth of all memory
  Progress progress;
  Kept kept;
  if (was_cut_short) {
    checkpoint.read(progress, simulation);
    kept = kept_of(checkpoint, progress, folder);
  } else if (keeps_checkpoints) {
    checkpoint.write(progress, simulation);  // before all other files: where there are any, it is there
  }
  Recording recording(setup, folder, simulation.particles(), progress, kept, keeps_checkpoints);
  std::optional<Checkpoints> checkpoints;
  if (keeps_checkpoints) checkpoints.emplace(checkpoint, recording, *checkpoint_every);
  const auto look = [&] {
    if (checkpoints) checkpoints->look(progress, simulation);
  };
  const auto end = [&](const char* error = nullptr) {
    if (keeps_checkpoints) recording.make_motion(simulation.particles());
    if (keeps_checkpoints || error == nullptr) write_end(setup, folder, checkpoint, progress, simulation, error);
    if (!keeps_checkpoints) return;
    force_to_disk(folder / end_file);
    force_to_disk(folder);
    remove_checkpoint(checkpoint, folder);
  };

  try {
    while (progress.rested < rest) {
      const long steps = std::min(rest - progress.rested, per_sample);
      simulation.advance(steps);
      progress.rested += steps;
      simulation.check();
      look();
    }
    if (progress.recorded < 0) {
      if (setup.bar) simulation.start_bar();
      simulation.check();
      recording.record(0, simulation);
    }
    while (progress.recorded < total) {
      look();
      simulation.advance(between_outputs);
      simulation.check();
      recording.record(progress.recorded + between_outputs, simulation);
    }
  } catch (const SimulationError& error) {
    end(error.what());
    throw;
  }
  end();
}

}  // namespace crossdem
