#pragma once
// The law of LIGGGHTS-PUBLIC 3.8, "hooke/stiffness tangential history absolute_damping on tangential_damping on",
// operation by operation: src/surface_model_default.h, normal_model_hooke_stiffness.h, tangential_model_history.h; and
// its option "rolling_friction epsd2", src/rolling_model_epsd2.h. In the plane, so that products with zero are left
// out.

#include <cmath>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

/// Two discs, or a disc and a wall, that touch.
struct HookeApproach {
  Vector2 delta = Vector2::Zero();     // [m], from the partner's centre or the wall's closest point to the centre of i
  double inverse = 0.0;                // 1 / distance [1/m]
  double overlap = 0.0;                // [m]
  Vector2 velocity = Vector2::Zero();  // [m/s], of i relative to its partner
  double turning = 0.0;                // [rad/s], sum of arm x spin over the distance
};

struct HookeReaction {
  Vector2 force = Vector2::Zero();  // [N], on i; its partner receives the opposite
  double couple = 0.0;              // [N]: the moment is -arm x couple, for both
  double push = 0.0;                // [N], normal to the contact
};

/// The memory of one contact.
struct HookeSprings {
  Vector2 shear = Vector2::Zero();  // [m], displacement of the shear spring
  double rolling = 0.0;             // [N m], moment of the rolling spring
};

template <class Archive>
void serialize(Archive& archive, HookeSprings& springs) {
  archive(springs.shear, springs.rolling);
}

/// `shear` [m] is the contact's memory, which is carried on only where `advance` says so; `limit_force`: no attraction.
inline HookeReaction liggghts_hooke(const HookeApproach& a, const ContactParameters& k, double dt, bool limit_force,
                                    bool advance, Vector2& shear) {
  const Vector2 normal = a.delta * a.inverse;
  const double approach = a.velocity.x() * normal.x() + a.velocity.y() * normal.y();  // < 0: approaching
  const Vector2 sliding =
      a.velocity - approach * normal - Vector2(0.0 - a.delta.y() * a.turning, a.delta.x() * a.turning - 0.0);
  double push = -k.normal_damping * approach + k.normal_stiffness * a.overlap;
  if (limit_force && push < 0.0) push = 0.0;

  if (advance) {
    shear += sliding * dt;
    const double off_plane = shear.x() * normal.x() + shear.y() * normal.y();
    shear -= off_plane * normal;
  }
  const double stretch = std::sqrt(shear.x() * shear.x() + shear.y() * shear.y());
  Vector2 drag = -(k.shear_stiffness * shear);
  const double spring = k.shear_stiffness * stretch;
  const double cap = k.friction * std::abs(push);
  if (spring > cap) {
    drag *= cap / spring;
    if (advance) shear = -drag / k.shear_stiffness;
  } else {
    drag -= k.shear_damping * sliding;
  }
  return {push * normal + drag, normal.x() * drag.y() - normal.y() * drag.x(), push};
}

/// What two discs resist rolling by, or a disc and a wall: a spring of the stiffness k_s R^2, capped, without dashpot.
struct RollingSpring {
  double radius = 0.0;   // R [m]: r_i r_j / (r_i + r_j), at a wall r_i
  double turning = 0.0;  // [rad/s], spin of i relative to its partner's

  [[nodiscard]] double stiffness(const ContactParameters& k) const { return k.shear_stiffness * radius * radius; }

  /// [N m], taken from i and given to its partner; `push` [N] is the contact's. `memory` [N m] as for the shear.
  double moment(const ContactParameters& k, double dt, double push, bool advance, double& memory) const {
    if (k.rolling_friction == 0.0) return 0.0;
    double moment = memory + turning * (dt * stiffness(k));
    const double cap = std::abs(push) * radius * k.rolling_friction;
    if (std::abs(moment) > cap) moment *= cap / std::abs(moment);
    if (advance) memory = moment;
    return moment;
  }
};

/// [J] in the springs of two that overlap by so much [m], if they do.
inline double hooke_spring_energy(const ContactParameters& k, double overlap, double rolling_radius,
                                  const HookeSprings& springs) {
  if (overlap <= 0.0) return 0.0;
  const double rolling = RollingSpring{.radius = rolling_radius}.stiffness(k);
  return 0.5 * k.normal_stiffness * overlap * overlap + 0.5 * k.shear_stiffness * springs.shear.squaredNorm() +
         (rolling > 0.0 ? 0.5 * springs.rolling * springs.rolling / rolling : 0.0);
}

}  // namespace crossdem
