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

/// All pairs i < j whose surfaces are closer than `gap` [m], sorted by i, then j; found with a grid of cells, in a time
/// proportional to the number of particles. Positions must be finite.
std::vector<ParticlePair> close_pairs(const Particles& particles, double gap);

}  // namespace crossdem
