#pragma once
// The two loops in which a step of the paper's scheme spends its time, for the widest vectors that this machine has.
// Every operation of a pair and of a particle is that of step.hpp, laws/tanaka.hpp and integrators.hpp, in their order,
// so that the results are theirs to the last bit.

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "crossdem/case.hpp"
#include "data.hpp"

namespace crossdem::batch {

/// Eqs. (1)-(12) by the default readings: brings the springs of `pairs` up to date and adds their forces to `loads`,
/// pair after pair. `discs` and `loads` have an entry for every particle named in `pairs`.
void add_pair_forces(std::span<Pairs> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                     double dt);

/// How far particles went.
struct Moved {
  double farthest_squared = 0.0;  // [m^2], the largest way since a particle was listed
  double stride_squared = 0.0;    // [m^2], the largest of this step

  void include(const Moved& other) {
    farthest_squared = std::max(farthest_squared, other.farthest_squared);
    stride_squared = std::max(stride_squared, other.stride_squared);
  }
};

/// Eqs. (12)-(24): moves the particles under their loads, which are zero afterwards. All arrays are filled up to whole
/// groups.
Moved move(std::size_t particles, Group* groups, Disc* discs, Load* loads, double gravity, double dt);

/// The instructions in use, by Highway's names: AVX3 (which is AVX-512), AVX2, SSE4, SSSE3, SCALAR on x86-64.
std::string_view instruction_set();

/// All that this machine has, the widest first.
std::vector<std::string_view> instruction_sets();

/// Throws std::invalid_argument for what is none of them. Not while another thread steps.
void use_instruction_set(std::string_view name);

}  // namespace crossdem::batch
