#pragma once
// Settled beds as high as the paper's, of as many particles as asked for.

#include <benchmark/benchmark.h>

#include <map>

#include "small_case.hpp"

namespace crossdem::benchmarks {

/// Fit for the processor's second cache, and too many for it.
inline void bed_sizes(benchmark::internal::Benchmark* of) { of->ArgName("particles")->Arg(1000)->Arg(10000); }

inline Case case_of(std::size_t particles, const char* scheme = "paper", double step = 1e-4) {
  const double width = 0.15 / 944 * static_cast<double>(particles);  // [m], the paper's bed: 944 in 0.15 m
  return test::small_case({{"container", {{"width_m", width}}},
                           {"particles", {{"count", particles}}},
                           {"bar", nullptr},
                           {"time", {{"step_s", step}}},
                           {"packing", {{"step_s", 1e-4}}},
                           {"scheme", {{"name", scheme}}}});
}

inline const Particles& bed_of(std::size_t particles) {
  static std::map<std::size_t, Particles> beds;  // each takes up to seconds to settle
  if (!beds.contains(particles)) {
    const Case setup = case_of(particles);
    beds[particles] = particles_of(make_packing(setup, 1), setup);
  }
  return beds[particles];
}

/// The time per `item`, of which every iteration had so many.
inline void report(benchmark::State& state, const char* item, std::size_t in_iteration) {
  state.counters[std::string("per_") + item] = benchmark::Counter(
      static_cast<double>(in_iteration), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace crossdem::benchmarks
