#include "crossdem/run.hpp"

#include <nlohmann/json.hpp>
#include <numeric>

#include "crossdem/version.hpp"
#include "recorder.hpp"

namespace crossdem {

void run(const Case& setup, Packing packing, const std::filesystem::path& folder, std::size_t threads) {
  const long total = setup.time.steps_in(setup.time.penetration);
  const long per_sample = setup.time.steps_in(setup.time.sample_interval);
  const long per_frame = setup.time.steps_in(setup.time.frame_interval);
  const long between_outputs = std::gcd(per_sample, per_frame);

  Simulation simulation(setup, particles_of(packing, setup), packing.bar_tip, threads);
  packing = {};  // a large one takes a tenth of all memory
  MotionFile motion(folder / "motion.h5", setup, simulation.particles());
  ResistanceFile resistance(folder / "resistance.csv");
  LedgerFile ledger(folder / "ledger.csv");

  for (long left = setup.time.steps_in(setup.time.rest); left > 0; left -= per_sample) {
    simulation.advance(std::min(left, per_sample));
    simulation.check();
  }
  const long rest_steps = simulation.steps();
  if (setup.bar) simulation.start_bar();
  const double bar_speed = setup.bar ? setup.bar->speed : 0.0;

  long frames = 0;
  long samples = 0;
  for (long step = 0;; step += between_outputs) {
    simulation.check();
    // Times come from the count of intervals, not of steps: engines with other time steps must write the same times.
    if (step % per_sample == 0) {
      const double time = static_cast<double>(samples) * setup.time.sample_interval;
      resistance.row(time, bar_speed * time, simulation);
      ledger.row(time, simulation);
      ++samples;
    }
    if (step % per_frame == 0) {
      const double time = static_cast<double>(frames) * setup.time.frame_interval;
      motion.frame(step, time, simulation.bar_tip(), simulation.particles());
      ++frames;
    }
    if (step == total) break;
    simulation.advance(between_outputs);
  }

  const nlohmann::json done = {{"completed", true},          {"engine", "native"},
                               {"version", version_line()},  {"rest_steps", rest_steps},
                               {"penetration_steps", total}, {"particles", simulation.particles().count()},
                               {"frames", frames},           {"samples", samples}};
  LineFile(folder / "run.json").line(done.dump(2));
}

}  // namespace crossdem
