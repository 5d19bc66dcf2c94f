#pragma once
// Particles and pairs as the kernels read them: whole cache lines, eight side by side.

#include <array>
#include <cstddef>
#include <cstdint>

namespace crossdem::batch {

/// Pairs in a batch and particles in a group: what the widest vectors hold. Narrower ones take several turns, so that
/// the data and the results are the same on every machine.
inline constexpr std::size_t width = 8;

/// What a pair reads of a particle, in one cache line.
struct alignas(64) Disc {
  double x = 0.0;        // [m]
  double y = 0.0;        // [m]
  double moves_x = 0.0;  // by the paper's scheme its displacement of the last step [m], else its velocity [m/s]
  double moves_y = 0.0;
  double turns = 0.0;   // by the paper's scheme radius x rotation of the last step [m], else its spin [rad/s]
  double radius = 0.0;  // [m]
  // Once more: what a pair reads of both then fits into one line.
  double turns_again = 0.0;
  double radius_again = 0.0;
};

/// What the contacts of one particle add up to.
struct alignas(32) Load {
  double force_x = 0.0;  // [N]
  double force_y = 0.0;  // [N]
  double turning = 0.0;  // by the paper's scheme [N], sum of f_s: the moment of Eq. (12) over -radius; else [N m]
  double work = 0.0;     // [J], of the contacts that list it first, since the start
};

using Column = std::array<double, width>;

/// Pairs of particles, sorted by i, then j, and what their law remembers of each.
template <std::size_t memories>
struct alignas(64) Pairs {
  std::array<std::uint32_t, width> i;
  std::array<std::uint32_t, width> j;
  std::array<Column, memories> memory;
};

/// Remembers e_n, or not_touching, and e_s [N].
using TanakaPairs = Pairs<2>;

/// Remembers e_n, or not_touching, e_s and e_r [N].
using RollingPairs = Pairs<3>;

/// Remembers x and y of the shear spring [m].
using LiggghtsPairs = Pairs<2>;

/// Remembers x and y of the shear force on j [N], and of the normal from i to j: both zero where there is no contact.
using YadePairs = Pairs<4>;

/// What every kind of motion needs beside discs and loads.
struct alignas(64) Group {
  Column spin;      // [rad/s]
  Column angle;     // [rad]
  Column listed_x;  // [m], where the particle was when its neighbours were listed
  Column listed_y;  // [m]
};

/// Averaged displacement, Eqs. (13)-(24).
struct AveragedGroup : Group {
  Column velocity_x;  // [m/s]
  Column velocity_y;  // [m/s]
  Column rotation;    // [rad], of the last step
  Column push;        // [s/kg], dt / mass: velocity per force
  Column turn;        // [s/(kg m)], radius x dt / inertia: spin per force at the rim
};

/// Velocity Verlet as LIGGGHTS has it.
struct VerletGroup : Group {
  Column push;      // [s/kg], half a step over the mass
  Column turn;      // [s/(kg m^2)], half a step over the inertia
  Column weight;    // [N], downwards; zero where it is among the forces already
  Column marked_x;  // [m], where the particle was when LIGGGHTS would have listed its neighbours
  Column marked_y;  // [m]
};

/// YADE's leap-frog; of a particle with the memory force twice the mass and inertia.
struct LeapFrogGroup : Group {
  Column mass;         // [kg]
  Column per_mass;     // [1/kg]
  Column inertia;      // [kg m^2]
  Column per_inertia;  // [1/(kg m^2)]
};

/// What the averaged displacement inside LIGGGHTS and YADE remembers: the velocities by which particles moved in the
/// step before that of the discs' `moves` and `turns`.
struct RateBefore {
  Column rate_before_x;   // [m/s]
  Column rate_before_y;   // [m/s]
  Column turning_before;  // [rad/s]
};

/// Velocity Verlet with velocities that are set between steps.
struct SetVelocitiesGroup : VerletGroup, RateBefore {
  Column mass;     // [kg]
  Column inertia;  // [kg m^2]
};

/// Leap-frog with a memory force.
struct MemoryForceGroup : LeapFrogGroup, RateBefore {};

}  // namespace crossdem::batch
