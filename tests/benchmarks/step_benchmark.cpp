// The step on a settled bed at rest: whole, by each scheme; and the loops of the batches, on each set of instructions.

#include "bed.hpp"
#include "scheme.hpp"
#include "schemes/liggghts_batches.hpp"
#include "schemes/paper_batches.hpp"
#include "schemes/yade_batches.hpp"

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

using PlainLiggghts = ConventionalStepper<LiggghtsScheme<LiggghtsVerlet>>;
using PlainYade = ConventionalStepper<YadeScheme<YadeLeapFrog>>;

template <class Plain>
void plain_step(benchmark::State& state) {
  const bool liggghts = std::is_same_v<Plain, PlainLiggghts>;
  const Case setup = case_of(count_of(state), liggghts ? "liggghts" : "yade", 5e-5);
  advance(state, setup, [&](World& world) { return std::make_unique<Plain>(setup, world); });
}
BENCHMARK_TEMPLATE(plain_step, PlainLiggghts)->Apply(bed_sizes);
BENCHMARK_TEMPLATE(plain_step, PlainYade)->Apply(bed_sizes);

void plain_paper_step(benchmark::State& state) {
  advance(state, case_of(count_of(state)),
          [](World& world) { return std::make_unique<PaperStepper<PaperScheme>>(PaperScheme{}, Readings{}, world); });
}
BENCHMARK(plain_paper_step)->Apply(bed_sizes);

template <class Scheme>
void step(benchmark::State& state, std::string_view instructions) {
  batch::use_instruction_set(instructions);
  const bool paper = std::is_same_v<Scheme, PaperBatches<PaperScheme>>;
  const bool liggghts = std::is_same_v<Scheme, LiggghtsBatches<LiggghtsVerlet>>;
  const Case setup = case_of(count_of(state), paper ? "paper" : liggghts ? "liggghts" : "yade", paper ? 1e-4 : 5e-5);
  advance(state, setup, [&](World& world) { return make_stepper(setup, world); });
}

/// A bed as the kernels read it, at rest: its springs keep their forces however often these are evaluated.
template <class Scheme>
struct Batches {
  std::vector<typename Scheme::Pairs> pairs;
  std::vector<batch::Disc> discs;
  std::vector<batch::Load> loads;
  std::vector<typename Scheme::Group> groups;

  explicit Batches(const Particles& bed)
      : discs(bed.count()), loads(bed.count()), groups((bed.count() + batch::width - 1) / batch::width) {
    for (std::size_t i = 0; i < bed.count(); ++i)
      discs[i] = {.x = bed.position[i].x(), .y = bed.position[i].y(), .radius = bed.radius[i]};
    const std::vector<ParticlePair> close = close_pairs(bed, ListSkin(bed).now());
    pairs.resize(close.size() / batch::width);  // the last few do not fill a batch
    for (std::size_t n = 0; n < pairs.size() * batch::width; ++n) {
      typename Scheme::Pairs& batch = pairs[n / batch::width];
      const std::size_t k = n % batch::width;
      batch.i[k] = close[n].i;
      batch.j[k] = close[n].j;
      for (batch::Column& column : batch.memory) column[k] = 0.0;
      if constexpr (std::is_same_v<Scheme, PaperBatches<PaperScheme>>)
        batch.memory[0][k] = closer_than(0.0, bed, close[n]) ? 0.1 : not_touching;
    }
  }
};

template <class Scheme>
void add_pair_forces(benchmark::State& state, std::string_view instructions) {
  batch::use_instruction_set(instructions);
  const Case setup = case_of(count_of(state));
  World world = make_world(setup, bed_of(count_of(state)), std::nullopt);
  auto plain = Scheme::plain(setup, world);
  const Scheme scheme(plain);
  Batches<Scheme> bed(bed_of(count_of(state)));
  for (auto _ : state) {
    scheme.add_pair_forces(world, bed.pairs, bed.discs.data(), bed.loads.data());
    benchmark::ClobberMemory();
  }
  report(state, "pair", bed.pairs.size() * batch::width);
}

template <class Scheme>
void move(benchmark::State& state, std::string_view instructions) {
  batch::use_instruction_set(instructions);
  const World world = make_world(case_of(count_of(state)), bed_of(count_of(state)), std::nullopt);
  Batches<Scheme> bed(world.particles);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        Scheme::move(world, bed.discs.size(), bed.groups.data(), bed.discs.data(), bed.loads.data()));
  report(state, "particle", bed.discs.size());
}

/// Which sets of instructions there are is known only when the program runs.
[[maybe_unused]] const bool registered = [] {
  for (const std::string_view set : batch::instruction_sets()) {
    const auto add = [&](const std::string& name, void (*function)(benchmark::State&, std::string_view)) {
      benchmark::RegisterBenchmark((name + "/" + std::string(set)).c_str(), function, set)->Apply(bed_sizes);
    };
    const auto add_scheme = [&]<class Scheme>(const std::string& name) {
      add("step/" + name, step<Scheme>);
      add("add_pair_forces/" + name, add_pair_forces<Scheme>);
      add("move/" + name, move<Scheme>);
    };
    add_scheme.template operator()<PaperBatches<PaperScheme>>("paper");
    add_scheme.template operator()<LiggghtsBatches<LiggghtsVerlet>>("liggghts");
    add_scheme.template operator()<YadeBatches<YadeLeapFrog>>("yade");
  }
  return true;
}();

}  // namespace
}  // namespace crossdem::benchmarks
