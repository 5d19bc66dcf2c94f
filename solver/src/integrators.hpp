#pragma once
// How particles move under their loads.

#include <vector>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

/// Resultant of the contact forces on one particle: Eqs. (10)-(12).
struct Load {
  Vector2 force = Vector2::Zero();  // [N]
  // One of the two, as the scheme has it:
  double rim = 0.0;     // [N], sum of rim_force: the moment of Eq. (12), and that against rolling, is -radius x rim
  double moment = 0.0;  // [N m], counter-clockwise
};

template <class Archive>
void serialize(Archive& archive, Load& load) {
  archive(load.force, load.rim, load.moment);
}

/// Eqs. (12)-(18): what a load does to the velocities within `dt`.
inline void accelerate(Particles& p, std::size_t i, const Load& load, double gravity, double dt) {
  p.velocity[i] += load.force * (dt / p.mass[i]) - Vector2(0.0, gravity * dt);  // Eqs. (13), (14), (16), (17)
  p.spin[i] -= load.rim * (p.radius[i] * (dt / p.inertia[i]));                  // Eqs. (12), (15), (18)
}

/// Eqs. (22)-(24).
inline void displace(Particles& p, std::size_t i) {
  p.position[i] += p.displacement[i];
  p.angle[i] += p.rotation[i];
}

/// Eqs. (13)-(24): the step's displacement is the mean of the last one and of velocity x dt.
struct AveragedDisplacement {
  static constexpr bool kicks_twice() { return false; }
  static void begin(Particles&, const std::vector<Load>&, double, double) {}

  static void advance(Particles& p, std::size_t i, const Load& load, double gravity, double dt) {
    accelerate(p, i, load, gravity, dt);
    p.displacement[i] = 0.5 * (p.displacement[i] + p.velocity[i] * dt);  // Eqs. (19), (20)
    p.rotation[i] = 0.5 * (p.rotation[i] + p.spin[i] * dt);              // Eq. (21)
    displace(p, i);
  }
};

/// The integrators that a case may choose instead, all with the velocities that the contact law sees taken half a step
/// before its positions.
struct ChosenIntegrator {
  Integration choice;

  [[nodiscard]] bool kicks_twice() const { return choice == Integration::velocity_verlet; }

  /// Velocity Verlet: half a kick by the loads of the last step, then the drift.
  void begin(Particles& p, const std::vector<Load>& loads, double gravity, double dt) const {
    if (choice != Integration::velocity_verlet) return;
    for (std::size_t i = 0; i < p.count(); ++i) {
      accelerate(p, i, loads[i], gravity, 0.5 * dt);
      drift(p, i, dt);
    }
  }

  void advance(Particles& p, std::size_t i, const Load& load, double gravity, double dt) const {
    if (choice == Integration::averaged_displacement) return AveragedDisplacement::advance(p, i, load, gravity, dt);
    if (choice == Integration::velocity_verlet) return accelerate(p, i, load, gravity, 0.5 * dt);
    accelerate(p, i, load, gravity, dt);  // leap-frog
    drift(p, i, dt);
  }

 private:
  static void drift(Particles& p, std::size_t i, double dt) {
    p.displacement[i] = p.velocity[i] * dt;
    p.rotation[i] = p.spin[i] * dt;
    displace(p, i);
  }
};

}  // namespace crossdem
