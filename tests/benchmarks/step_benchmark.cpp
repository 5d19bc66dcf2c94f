// The step on a settled bed at rest: whole, by each scheme; and the two loops of the batches, on each set of
// instructions.

#include "bed.hpp"
#include "scheme.hpp"
#include "schemes/paper_batches.hpp"

namespace crossdem::benchmarks {
namespace {

constexpr long steps_at_a_time = 100;  // as between two samples of the paper's case

std::size_t count_of(const benchmark::State& state) { return static_cast<std::size_t>(state.range(0)); }

template <class Maker>
void advance(benchmark::State& state, const Case& setup, Maker make) {
  World world = make_world(setup, bed_of(count_of(state)), std::nullopt);
  const std::unique_ptr<Stepper> stepper = make(world);
  for (auto _ : state) stepper->advance(world, steps_at_a_time);
  report(state, "particle_step", count_of(state) * steps_at_a_time);
}

void step(benchmark::State& state, const char* scheme, double dt) {
  const Case setup = case_of(count_of(state), scheme, dt);
  advance(state, setup, [&](World& world) { return make_stepper(setup, world); });
}
BENCHMARK_CAPTURE(step, liggghts, "liggghts", 5e-5)->Apply(bed_sizes);
BENCHMARK_CAPTURE(step, yade, "yade", 5e-5)->Apply(bed_sizes);

void plain_step(benchmark::State& state) {
  advance(state, case_of(count_of(state)),
          [](World& world) { return std::make_unique<PaperStepper<PaperScheme>>(PaperScheme{}, Readings{}, world); });
}
BENCHMARK(plain_step)->Name("step/paper_plain")->Apply(bed_sizes);

void batched_step(benchmark::State& state, std::string_view instructions) {
  batch::use_instruction_set(instructions);
  step(state, "paper", 1e-4);
}

/// A bed as the kernels read it, at rest: its springs keep their forces however often these are evaluated.
struct Batches {
  std::vector<batch::Pairs> pairs;
  std::vector<batch::Disc> discs;
  std::vector<batch::Load> loads;
  std::vector<batch::Group> groups;

  explicit Batches(const Particles& bed)
      : discs(bed.count()), loads(bed.count()), groups((bed.count() + batch::width - 1) / batch::width) {
    for (std::size_t i = 0; i < bed.count(); ++i)
      discs[i] = {.x = bed.position[i].x(), .y = bed.position[i].y(), .radius = bed.radius[i]};
    const std::vector<ParticlePair> close = close_pairs(bed, ListSkin(bed).now());
    pairs.resize(close.size() / batch::width);  // the last few do not fill a batch
    for (std::size_t n = 0; n < pairs.size() * batch::width; ++n) {
      batch::Pairs& batch = pairs[n / batch::width];
      const std::size_t k = n % batch::width;
      const bool touching = closer_than(0.0, bed, close[n]);
      batch.i[k] = close[n].i;
      batch.j[k] = close[n].j;
      batch.normal_spring[k] = touching ? 0.1 : batch::not_touching;
      batch.shear_spring[k] = 0.0;
    }
  }
};

void add_pair_forces(benchmark::State& state, std::string_view instructions) {
  batch::use_instruction_set(instructions);
  const Case setup = case_of(count_of(state));
  Batches bed(bed_of(count_of(state)));
  for (auto _ : state) {
    batch::add_pair_forces(bed.pairs, bed.discs.data(), bed.loads.data(), setup.particle_particle, setup.time.step);
    benchmark::ClobberMemory();
  }
  report(state, "pair", bed.pairs.size() * batch::width);
}

void move(benchmark::State& state, std::string_view instructions) {
  batch::use_instruction_set(instructions);
  Batches bed(bed_of(count_of(state)));
  for (auto _ : state)
    benchmark::DoNotOptimize(
        batch::move(bed.discs.size(), bed.groups.data(), bed.discs.data(), bed.loads.data(), 0.0, 1e-4));
  report(state, "particle", bed.discs.size());
}

/// Which sets of instructions there are is known only when the program runs.
[[maybe_unused]] const bool registered = [] {
  for (const std::string_view set : batch::instruction_sets()) {
    const auto add = [&](const std::string& name, void (*function)(benchmark::State&, std::string_view)) {
      benchmark::RegisterBenchmark((name + "/" + std::string(set)).c_str(), function, set)->Apply(bed_sizes);
    };
    add("step/paper", batched_step);
    add("batch::add_pair_forces", add_pair_forces);
    add("batch::move", move);
  }
  return true;
}();

}  // namespace
}  // namespace crossdem::benchmarks
