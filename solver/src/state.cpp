#include "crossdem/state.hpp"

namespace crossdem {

void Particles::reserve(std::size_t count) {
  for (auto* of_each : {&radius, &mass, &inertia, &angle, &spin, &rotation}) of_each->reserve(count);
  for (auto* of_each : {&position, &velocity, &displacement}) of_each->reserve(count);
}

void Particles::add(double disc_radius, double disc_mass, const Vector2& at, const Vector2& moving) {
  radius.push_back(disc_radius);
  mass.push_back(disc_mass);
  inertia.push_back(0.5 * disc_mass * disc_radius * disc_radius);
  position.push_back(at);
  velocity.push_back(moving);
  displacement.emplace_back(Vector2::Zero());
  angle.push_back(0.0);
  spin.push_back(0.0);
  rotation.push_back(0.0);
}

double kinetic_energy(const Particles& particles) {
  double energy = 0.0;
  for (std::size_t i = 0; i < particles.count(); ++i)
    energy += 0.5 * (particles.mass[i] * particles.velocity[i].squaredNorm() +
                     particles.inertia[i] * particles.spin[i] * particles.spin[i]);
  return energy;
}

Vector2 momentum(const Particles& particles) {
  Vector2 sum = Vector2::Zero();
  for (std::size_t i = 0; i < particles.count(); ++i) sum += particles.mass[i] * particles.velocity[i];
  return sum;
}

}  // namespace crossdem
