#pragma once
// How YADE moves discs: by its NewtonIntegrator without damping, and with the paper's averaged displacement inside it.

#include <vector>

#include "../integrators.hpp"

namespace crossdem {

/// NewtonIntegrator: v += (F/m + g) dt, x += v dt. The law sees the velocities of half a step before its positions.
class YadeLeapFrog {
 public:
  static constexpr double inertia_factor = 1.0;  // mass and inertia times that, gravity over that
  static constexpr bool remembers = false;       // the velocity by which the step before has moved
  explicit YadeLeapFrog(const Particles&) {}
  [[nodiscard]] static const Vector2& velocity(const Particles& p, std::size_t i) { return p.velocity[i]; }
  [[nodiscard]] static double spin(const Particles& p, std::size_t i) { return p.spin[i]; }

  static void set(Particles& p, std::size_t i, const Vector2& velocity, double spin) {
    p.velocity[i] = velocity;
    p.spin[i] = spin;
  }

  static void move(Particles& p, std::size_t i, const Load& load, double gravity, double dt) {
    p.velocity[i] += dt * (load.force / p.mass[i] + Vector2(0.0, -gravity));
    p.spin[i] += dt * (load.moment / p.inertia[i]);
    p.position[i] += p.velocity[i] * dt;
    p.angle[i] += p.spin[i] * dt;
  }

  template <class Archive>
  void serialize(Archive&) {}
};

/// The paper's averaged displacement inside YADE: with w = displacement / dt, Eqs. (16)-(21) read
/// w_t = w_(t-1) + (w_(t-1) - w_(t-2)) / 2 + a dt / 2, a leap-frog step of twice the mass and inertia under half of
/// gravity and a further load m (w_(t-1) - w_(t-2)) / dt. YADE moves by w; the paper's velocity is 2 w_t - w_(t-1).
class YadeMemoryForce {
 public:
  static constexpr double inertia_factor = 2.0;
  static constexpr bool remembers = true;
  explicit YadeMemoryForce(const Particles& p)
      : rate_(p.velocity), rate_before_(p.velocity), turning_(p.spin), turning_before_(p.spin) {}
  [[nodiscard]] const Vector2& velocity(const Particles&, std::size_t i) const { return rate_[i]; }
  [[nodiscard]] double spin(const Particles&, std::size_t i) const { return turning_[i]; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(rate_, rate_before_, turning_, turning_before_);
  }

  /// w_(t-2) of particle i [m/s], [rad/s].
  [[nodiscard]] Vector2& rate_before(std::size_t i) { return rate_before_[i]; }
  [[nodiscard]] double& turning_before(std::size_t i) { return turning_before_[i]; }

  /// w_(t-1), once rate_before() is w_(t-2).
  void set(Particles& p, std::size_t i, const Vector2& rate, double turning) {
    rate_[i] = rate;
    turning_[i] = turning;
    p.velocity[i] = 2 * rate - rate_before_[i];
    p.spin[i] = 2 * turning - turning_before_[i];
  }

  void move(Particles& p, std::size_t i, const Load& load, double gravity, double dt) {
    const Vector2 force = load.force + p.mass[i] * (rate_[i] - rate_before_[i]) / dt;
    const double moment = load.moment + p.inertia[i] * (turning_[i] - turning_before_[i]) / dt;
    rate_before_[i] = rate_[i];
    turning_before_[i] = turning_[i];
    set(p, i, rate_[i] + dt * (force / (inertia_factor * p.mass[i]) + Vector2(0.0, -gravity / inertia_factor)),
        turning_[i] + dt * (moment / (inertia_factor * p.inertia[i])));
    p.position[i] += rate_[i] * dt;
    p.angle[i] += turning_[i] * dt;
  }

 private:
  std::vector<Vector2> rate_;           // [m/s], w_(t-1)
  std::vector<Vector2> rate_before_;    // [m/s], w_(t-2)
  std::vector<double> turning_;         // [rad/s]
  std::vector<double> turning_before_;  // [rad/s]
};

}  // namespace crossdem
