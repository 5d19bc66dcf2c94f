#pragma once
// What every contact law speaks of.

#include <concepts>
#include <limits>

#include "crossdem/case.hpp"

namespace crossdem {

/// Motion of i relative to j (a particle, a wall or the bar) during one step.
struct RelativeDisplacement {
  double normal = 0.0;   // [m], Eq. (1), > 0: approaching
  double shear = 0.0;    // [m], Eq. (2), > 0: the surface of i moves along t = (-sin a, cos a)
  double overlap = 0.0;  // [m], < 0 in a joint that is stretched
  // What the dashpots see [m]: as above, or relative velocity times dt where the case reads it so.
  double damped_normal = 0.0;
  double damped_shear = 0.0;
  double rolling = 0.0;  // [m], R (phi_i - phi_j), with R = r_i r_j / (r_i + r_j), at a surface r_i
};

/// The force on i is -normal n - shear t, its moment -r_i shear (Eqs. (10)-(12)); j receives the opposite force and,
/// in its own frame, the moment -r_j shear. Rolling adds the moment -R rolling on i, and the opposite on j.
struct ContactForce {
  double normal = 0.0;   // f_n [N], > 0: repulsion
  double shear = 0.0;    // f_s [N]
  double rolling = 0.0;  // f_r [N]
};

/// In place of e_n where there is no contact: the next overlap is a first one, Eqs. (3), (4).
inline constexpr double not_touching = -std::numeric_limits<double>::infinity();

/// The memory of one contact: the spring forces of Eqs. (5), (7).
struct ContactSpring {
  double normal = not_touching;  // e_n [N]
  double shear = 0.0;            // e_s [N]
  [[nodiscard]] bool touching() const { return normal != not_touching; }
};

/// With one against rolling.
struct RollingContactSpring : ContactSpring {
  double rolling = 0.0;  // e_r [N]
};

template <class Archive>
void serialize(Archive& archive, ContactSpring& spring) {
  archive(spring.normal, spring.shear);
}

template <class Archive>
void serialize(Archive& archive, RollingContactSpring& spring) {
  archive(spring.normal, spring.shear, spring.rolling);
}

template <class Law>
concept ContactLaw = requires(const Law& law, RelativeDisplacement u, const ContactParameters& parameters, double dt,
                              RollingContactSpring& spring) {
  { law.force(u, parameters, dt, spring) } -> std::same_as<ContactForce>;
};

}  // namespace crossdem
