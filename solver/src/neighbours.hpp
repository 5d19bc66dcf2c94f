#pragma once
// Which particles are close to one another.

#include <cstdint>
#include <vector>

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
std::vector<ParticlePair> close_pairs(const Particles& particles, double gap);

}  // namespace crossdem
