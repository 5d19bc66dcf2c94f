#pragma once
// The contact law of Tanaka et al. (2000), Eqs. (3)-(9), and what the paper names as missing: a joint that carries
// tension up to a strength T, and a resistance to rolling. Both are absent where their parameters are 0.

#include <algorithm>
#include <cmath>

#include "../contact_law.hpp"

namespace crossdem {

/// The default readings, known to the compiler: the law and the step they enter hold no branch for the others.
struct DefaultReadings {
  static constexpr Readings of_default{};
  static constexpr auto first_contact_normal = of_default.first_contact_normal;
  static constexpr auto first_contact_shear = of_default.first_contact_shear;
  static constexpr auto lost_contact = of_default.lost_contact;
  static constexpr auto attraction = of_default.attraction;
  static constexpr auto normal_spring = of_default.normal_spring;
  static constexpr auto dashpot_velocity = of_default.dashpot_velocity;
  static constexpr auto bar_corner = of_default.bar_corner;
  static constexpr auto slip_cap = of_default.slip_cap;
  static constexpr auto torque_arm = of_default.torque_arm;
  static constexpr auto integrator = of_default.integrator;
};

/// `Choice` is DefaultReadings, or Readings for any others.
template <class Choice>
struct TanakaLaw {
  Choice readings;

  /// The force of a contact that overlaps, or of a joint; `spring` is its memory and is brought up to date. Where it
  /// has none against rolling, nothing resists that.
  template <class Spring>
  ContactForce force(RelativeDisplacement u, const ContactParameters& p, double dt, Spring& spring) const {
    if (!spring.touching()) {
      u = share_in_contact(u);
      unload(spring);
    }
    if (readings.normal_spring == NormalSpring::incremental) {
      spring.normal += p.normal_stiffness * u.normal;  // Eq. (5)
    } else {
      spring.normal = p.normal_stiffness * u.overlap;
    }
    if (spring.normal < -p.tensile_strength) return lose(spring);  // Eq. (8), where T = 0

    ContactForce f;
    f.normal = spring.normal + p.normal_damping / dt * u.damped_normal;  // Eq. (6)
    if (readings.attraction == Attraction::clipped) f.normal = std::max(f.normal, -p.tensile_strength);

    const double pressed = readings.slip_cap == SlipCap::spring ? spring.normal + p.tensile_strength
                                                                : std::abs(f.normal + p.tensile_strength);
    f.shear =
        capped(spring.shear, p.shear_stiffness * u.shear, p.friction * pressed, p.shear_damping / dt * u.damped_shear);
    if constexpr (requires { spring.rolling; })
      if (p.rolling_friction > 0.0)
        f.rolling = capped(spring.rolling, p.shear_stiffness * u.rolling, p.rolling_friction * pressed, 0.0);
    return f;
  }

 private:
  /// Touching, without any force.
  template <class Spring>
  static void unload(Spring& spring) {
    spring = {};
    spring.normal = 0.0;
  }

  /// Eqs. (7), (9): a spring that grows by `more` up to the `cap`, where it slips and its `dashpot` is off.
  static double capped(double& spring, double more, double cap, double dashpot) {
    spring += more;
    if (std::abs(spring) > cap) return spring = std::copysign(cap, spring);
    return spring + dashpot;
  }

  /// Eqs. (3), (4): at first contact only the share of the step spent in contact counts.
  [[nodiscard]] RelativeDisplacement share_in_contact(RelativeDisplacement u) const {
    double share = 1.0;
    if (readings.first_contact_shear == FirstContactShear::clamped_share) {
      share = u.normal > 0.0 ? std::min(u.overlap / u.normal, 1.0) : 0.0;
    } else if (readings.first_contact_shear == FirstContactShear::raw_share) {
      share = u.normal != 0.0 ? u.overlap / u.normal : 0.0;
    }
    u.shear *= share;
    u.normal = u.overlap;
    if (readings.dashpot_velocity == DashpotVelocity::averaged_displacement) {
      u.damped_shear *= share;
      if (readings.first_contact_normal == FirstContactNormal::spring_and_dashpot) u.damped_normal = u.overlap;
    }
    return u;
  }

  /// Eq. (8): no tension in the spring, or none beyond its joint's strength; what is left of the contact's memory is a
  /// reading.
  template <class Spring>
  ContactForce lose(Spring& spring) const {
    if (readings.lost_contact == LostContact::forget) {
      spring = {};
    } else if (readings.lost_contact == LostContact::keep_zero) {
      unload(spring);
    } else {
      const double kept = spring.normal;
      unload(spring);
      spring.normal = kept;
    }
    return {};
  }
};

static_assert(ContactLaw<TanakaLaw<DefaultReadings>> && ContactLaw<TanakaLaw<Readings>>);

}  // namespace crossdem
