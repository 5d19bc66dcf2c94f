#pragma once
// What every contact law speaks of.

#include <concepts>

#include "crossdem/case.hpp"

namespace crossdem {

/// Motion of i relative to j (a particle, a wall or the bar) during one step.
struct RelativeDisplacement {
  double normal = 0.0;   // [m], Eq. (1), > 0: approaching
  double shear = 0.0;    // [m], Eq. (2), > 0: the surface of i moves along t = (-sin a, cos a)
  double overlap = 0.0;  // [m], >= 0
  // What the dashpots see [m]: as above, or relative velocity times dt where the case reads it so.
  double damped_normal = 0.0;
  double damped_shear = 0.0;
};

/// The force on i is -normal n - shear t, its moment -r_i shear (Eqs. (10)-(12)); j receives the opposite force and,
/// in its own frame, the moment -r_j shear.
struct ContactForce {
  double normal = 0.0;  // f_n [N], > 0: repulsion
  double shear = 0.0;   // f_s [N]
};

/// The memory of one contact: the spring forces of Eqs. (5), (7).
struct ContactSpring {
  double normal = 0.0;    // e_n [N]
  double shear = 0.0;     // e_s [N]
  bool touching = false;  // false: the next overlap is a first contact, Eqs. (3), (4)
};

template <class Law>
concept ContactLaw = requires(const Law& law, RelativeDisplacement u, const ContactParameters& parameters, double dt,
                              ContactSpring& spring) {
  { law.force(u, parameters, dt, spring) } -> std::same_as<ContactForce>;
};

}  // namespace crossdem
