#pragma once
// How a particle moves under its load.

#include "crossdem/state.hpp"

namespace crossdem {

/// Resultant of the contact forces on one particle: Eqs. (10)-(12).
struct Load {
  Vector2 force = Vector2::Zero();  // [N]
  double moment = 0.0;              // [N m], counter-clockwise
};

/// Eqs. (13)-(24): the step's displacement is the mean of the last one and of velocity x dt.
struct AveragedDisplacement {
  static void advance(Particles& p, std::size_t i, const Load& load, double gravity, double dt) {
    Vector2 acceleration = load.force / p.mass[i];  // Eqs. (13), (14)
    acceleration.y() -= gravity;
    p.velocity[i] += acceleration * dt;                                  // Eqs. (16), (17)
    p.displacement[i] = 0.5 * (p.displacement[i] + p.velocity[i] * dt);  // Eqs. (19), (20)
    p.position[i] += p.displacement[i];                                  // Eqs. (22), (23)

    p.spin[i] += load.moment / p.inertia[i] * dt;            // Eqs. (15), (18)
    p.rotation[i] = 0.5 * (p.rotation[i] + p.spin[i] * dt);  // Eq. (21)
    p.angle[i] += p.rotation[i];                             // Eq. (24)
  }
};

}  // namespace crossdem
