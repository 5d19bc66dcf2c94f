#pragma once
// The particles and what they do: positions, velocities, and the displacements of one step that Eqs. (1), (2) use.

#include <Eigen/Core>
#include <vector>

namespace crossdem {

using Vector2 = Eigen::Vector2d;

/// Discs in the x-y plane; entry i of each array belongs to particle i. Angles count counter-clockwise.
struct Particles {
  std::vector<double> radius;         // [m]
  std::vector<double> mass;           // [kg], rho pi r^2 h
  std::vector<double> inertia;        // [kg m^2], m r^2 / 2
  std::vector<Vector2> position;      // [m]
  std::vector<Vector2> velocity;      // [m/s]
  std::vector<Vector2> displacement;  // [m], of the last step
  std::vector<double> angle;          // [rad]
  std::vector<double> spin;           // [rad/s]
  std::vector<double> rotation;       // [rad], of the last step

  [[nodiscard]] std::size_t count() const { return radius.size(); }
  void reserve(std::size_t count);
  void add(double disc_radius, double disc_mass, const Vector2& at, const Vector2& moving);
};

/// Sum of m v^2 / 2 + I w^2 / 2 [J].
double kinetic_energy(const Particles& particles);

/// Sum of m v [N s].
Vector2 momentum(const Particles& particles);

}  // namespace crossdem
