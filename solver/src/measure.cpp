#include "crossdem/measure.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <string>

#include "crossdem/simulation.hpp"

namespace crossdem {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Not getrusage's, which still counts what the process was before it became this program: a large Python, perhaps.
std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::uint64_t kibibytes = 0;
  while (status >> word)
    if (word == "VmHWM:") status >> kibibytes;
  return 1024 * kibibytes;
}

/// In stretches of a sample's length, after each of which run() too looks whether the motion is still sound.
void advance(Simulation& simulation, long steps, long stretch) {
  for (; steps > 0; steps -= stretch) {
    simulation.advance(std::min(steps, stretch));
    simulation.check();
  }
}

}  // namespace

Measurement measure(const Case& setup, Packing packing, std::optional<long> steps, std::size_t threads) {
  const long rest = setup.time.steps_in(setup.time.rest);
  const long all = rest + setup.time.steps_in(setup.time.penetration);
  const long asked = steps.value_or(all);
  if (asked > all)
    throw CaseError({"time: the case has " + std::to_string(all) + " steps, not " + std::to_string(asked)});
  const long resting = std::min(asked, rest);
  const long stretch = setup.time.steps_in(setup.time.sample_interval);

  Simulation simulation(setup, particles_of(packing, setup), packing.bar_tip, threads);
  packing = {};  // a large one takes a tenth of all memory
  const double cpu_before = cpu_seconds();
  const auto started = std::chrono::steady_clock::now();
  advance(simulation, resting, stretch);
  if (setup.bar) simulation.start_bar();
  advance(simulation, asked - resting, stretch);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  return {.steps = simulation.steps(),
          .particles = simulation.particles().count(),
          .wall = wall.count(),
          .cpu = cpu_seconds() - cpu_before,
          .peak_memory = peak_memory()};
}

}  // namespace crossdem
