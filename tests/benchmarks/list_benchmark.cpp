// The list of contacts, on a settled bed.

#include "bed.hpp"
#include "step.hpp"

namespace crossdem::benchmarks {
namespace {

std::size_t particles_of(const benchmark::State& state) { return static_cast<std::size_t>(state.range(0)); }

/// The search among all particles, of which Contacts makes its candidates.
void search(benchmark::State& state) {
  const Particles& bed = bed_of(particles_of(state));
  const ListSkin skin(bed);
  for (auto _ : state) benchmark::DoNotOptimize(close_pairs(bed, skin.now() + skin.reserve()));
  report(state, "particle", bed.count());
}
BENCHMARK(search)->Name("close_pairs")->Apply(bed_sizes);

/// The list made anew of the candidates, where the last one was good for 100 steps.
void rebuild(benchmark::State& state) {
  const Particles& bed = bed_of(particles_of(state));
  const Surfaces surfaces{.width = case_of(bed.count()).container.width, .bar = {}};
  PaperContacts<ContactSpring> contacts(MemoryOwner::pair, ListSkin(bed));
  long steps = 0;
  for (auto _ : state) contacts.rebuild(bed, surfaces, steps += 100);
  report(state, "particle", bed.count());
}
BENCHMARK(rebuild)->Name("Contacts::rebuild")->Apply(bed_sizes);

}  // namespace
}  // namespace crossdem::benchmarks
