#pragma once
// The loops in which a step spends its time, for the widest vectors that this machine has. Every operation of a pair
// and of a particle is that of the plain steps, in their order, so that the results are theirs to the last bit.

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "crossdem/case.hpp"
#include "data.hpp"

namespace crossdem::batch {

// Forces of pairs: each brings the memories of `pairs` up to date and adds their forces to `loads`, pair after pair.
// `discs` and `loads` have an entry for every particle named in `pairs`.

/// Eqs. (1)-(12) by the default readings, as step.hpp and laws/tanaka.hpp; with joints where they have a strength, and
/// with springs against rolling where `pairs` remember them.
void add_tanaka_forces(std::span<TanakaPairs> pairs, const Disc* discs, Load* loads,
                       const ContactParameters& parameters, double dt);
void add_tanaka_forces(std::span<RollingPairs> pairs, const Disc* discs, Load* loads,
                       const ContactParameters& parameters, double dt);

/// As schemes/liggghts.hpp and laws/liggghts_hooke.hpp; `limit_force`: no attraction.
void add_liggghts_forces(std::span<LiggghtsPairs> pairs, const Disc* discs, Load* loads,
                         const ContactParameters& parameters, double dt, bool limit_force);

/// As schemes/yade.hpp and laws/yade_viscel.hpp.
void add_yade_forces(std::span<YadePairs> pairs, const Disc* discs, Load* loads, const ContactParameters& parameters,
                     double dt);

/// How far particles went: squares of the largest distances.
struct Moved {
  double farthest_squared = 0.0;  // [m^2], since a particle was listed
  double stride_squared = 0.0;    // [m^2], in this step
  double marked_squared = 0.0;    // [m^2], since it was marked, for the motion that marks particles

  void include(const Moved& other) {
    farthest_squared = std::max(farthest_squared, other.farthest_squared);
    stride_squared = std::max(stride_squared, other.stride_squared);
    marked_squared = std::max(marked_squared, other.marked_squared);
  }
};

// Motion: each moves the particles under their loads, which are zero afterwards. All arrays are filled up to whole
// groups.

/// Eqs. (12)-(24), as integrators.hpp.
Moved move_averaged(std::size_t particles, AveragedGroup* groups, Disc* discs, Load* loads, double gravity, double dt);

/// The second half of a step and the first one of the next, as schemes/liggghts.hpp and liggghts_motion.hpp.
Moved move_verlet(std::size_t particles, VerletGroup* groups, Disc* discs, Load* loads, double dt);
Moved move_verlet(std::size_t particles, SetVelocitiesGroup* groups, Disc* discs, Load* loads, double dt);

/// As schemes/yade_motion.hpp; with a memory force under half of gravity.
Moved move_leap_frog(std::size_t particles, LeapFrogGroup* groups, Disc* discs, Load* loads, double gravity, double dt);
Moved move_leap_frog(std::size_t particles, MemoryForceGroup* groups, Disc* discs, Load* loads, double gravity,
                     double dt);

/// The instructions in use, by Highway's names: AVX3 (which is AVX-512), AVX2, SSE4, SSSE3, SCALAR on x86-64.
std::string_view instruction_set();

/// All that this machine has, the widest first.
std::vector<std::string_view> instruction_sets();

/// Throws std::invalid_argument for what is none of them. Not while another thread steps.
void use_instruction_set(std::string_view name);

}  // namespace crossdem::batch
