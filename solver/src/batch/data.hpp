#pragma once
// Particles and pairs as the kernels of the paper's scheme read them: whole cache lines, eight side by side.

#include <array>
#include <cstddef>
#include <cstdint>

namespace crossdem::batch {

/// Pairs in a batch and particles in a group: what the widest vectors hold. Narrower ones take several turns, so that
/// the data and the results are the same on every machine.
inline constexpr std::size_t width = 8;

/// What a pair reads of a particle, in one cache line.
struct alignas(64) Disc {
  double x = 0.0;               // [m]
  double y = 0.0;               // [m]
  double displacement_x = 0.0;  // [m], of the last step
  double displacement_y = 0.0;  // [m]
  double roll = 0.0;            // [m], radius x rotation of the last step
  double radius = 0.0;          // [m]
};

/// Eqs. (10)-(12) of one particle, and the work of the contacts that list it first, since the start.
struct alignas(32) Load {
  double force_x = 0.0;  // [N]
  double force_y = 0.0;  // [N]
  double rim = 0.0;      // [N], sum of f_s: the moment of Eq. (12) is -radius x rim
  double work = 0.0;     // [J], f_n du_n + f_s du_s
};

using Column = std::array<double, width>;

inline constexpr double not_touching = -1.0;  // in place of e_n, which Eq. (8) leaves not below zero

/// Pairs of particles, sorted by i, then j.
struct alignas(64) Pairs {
  std::array<std::uint32_t, width> i;
  std::array<std::uint32_t, width> j;
  Column normal_spring;  // e_n [N]
  Column shear_spring;   // e_s [N]
};

/// What the motion of particles needs beside their discs and loads.
struct alignas(64) Group {
  Column velocity_x;  // [m/s]
  Column velocity_y;  // [m/s]
  Column spin;        // [rad/s]
  Column rotation;    // [rad], of the last step
  Column angle;       // [rad]
  Column push;        // [s/kg], dt / mass: velocity per force
  Column turn;        // [s/(kg m)], radius x dt / inertia: spin per force at the rim
  Column listed_x;    // [m], where the particle was when its neighbours were listed
  Column listed_y;    // [m]
};

}  // namespace crossdem::batch
