#pragma once
// Which particles are close to one another.

#include <cstdint>
#include <vector>

#include "crew.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

struct ParticlePair {
  std::uint32_t i = 0;
  std::uint32_t j = 0;
  auto operator<=>(const ParticlePair&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 misreads it
};

/// Whether the surfaces of two particles are closer than `gap` [m].
inline bool closer_than(double gap, const Particles& particles, const ParticlePair& pair) {
  const double reach = particles.radius[pair.i] + particles.radius[pair.j] + gap;
  return (particles.position[pair.j] - particles.position[pair.i]).squaredNorm() < reach * reach;
}

/// All pairs i < j whose surfaces are closer than `gap` [m], sorted by i, then j; found with a grid of cells, in a time
/// proportional to the number of particles. Positions must be finite.
std::vector<ParticlePair> close_pairs(const Particles& particles, double gap, Crew& crew);
inline std::vector<ParticlePair> close_pairs(const Particles& particles, double gap) {
  Crew alone;
  return close_pairs(particles, gap, alone);
}

/// found(begin, end) of each run of [0, count), one run for each of the crew, put together in what the first one gives.
template <class Item, class Found>
std::vector<Item> gathered(std::size_t count, Crew& crew, Found found) {
  std::vector<std::vector<Item>> parts(crew.size());
  crew.each([&](std::size_t number) {
    const auto [begin, end] = share(count, number, crew.size());
    parts[number] = found(begin, end);
  });
  for (std::size_t number = 1; number < parts.size(); ++number) {
    parts[0].insert(parts[0].end(), parts[number].begin(), parts[number].end());
    parts[number] = {};
  }
  return std::move(parts[0]);
}

}  // namespace crossdem
