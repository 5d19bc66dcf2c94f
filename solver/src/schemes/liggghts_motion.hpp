#pragma once
// How LIGGGHTS moves discs: as it does by itself, and with velocities that an input script sets between steps.

#include <vector>

#include "../world.hpp"

namespace crossdem {

/// Velocity Verlet as it stands.
class LiggghtsVerlet {
 public:
  static constexpr double first_share = 0.5;  // of a step, in which the loads before it act
  static constexpr bool remembers = false;    // the velocity by which the step before has moved
  explicit LiggghtsVerlet(const Particles&) {}
  static void begin(Particles&) {}
  static void end(World&) {}

  template <class Archive>
  void serialize(Archive&) {}
};

/// The paper's averaged displacement inside LIGGGHTS, by velocities that are set between steps: with w the velocity by
/// which a step has moved, taken back from that of its end, v = (3 w_t - w_(t-1)) / 2 makes the next half kick give
/// Eqs. (16)-(21). The paper's velocity is 2 w_t - w_(t-1).
class LiggghtsSetVelocities {
 public:
  static constexpr double first_share = 1.0;
  static constexpr bool remembers = true;
  explicit LiggghtsSetVelocities(const Particles& p)
      : set_(p.velocity), set_spin_(p.spin), rate_before_(p.velocity), turning_before_(p.spin) {}

  void begin(Particles& p) const {
    p.velocity = set_;
    p.spin = set_spin_;
  }

  void end(World& w) {
    Particles& p = w.particles;
    for (std::size_t i = 0; i < p.count(); ++i) {
      const Vector2 rate = p.velocity[i] - 0.5 * w.dt * w.loads[i].force / p.mass[i];
      const double turning = p.spin[i] - w.dt * w.loads[i].moment / (p.radius[i] * p.radius[i] * p.mass[i]);
      set_[i] = 1.5 * rate - 0.5 * rate_before_[i];
      set_spin_[i] = 1.5 * turning - 0.5 * turning_before_[i];
      p.velocity[i] = 2 * rate - rate_before_[i];
      p.spin[i] = 2 * turning - turning_before_[i];
      rate_before_[i] = rate;
      turning_before_[i] = turning;
    }
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(set_, set_spin_, rate_before_, turning_before_);
  }

  /// w_(t-1) of particle i [m/s], [rad/s].
  [[nodiscard]] Vector2& rate_before(std::size_t i) { return rate_before_[i]; }
  [[nodiscard]] double& turning_before(std::size_t i) { return turning_before_[i]; }

 private:
  std::vector<Vector2> set_;            // [m/s], between this step and the next
  std::vector<double> set_spin_;        // [rad/s]
  std::vector<Vector2> rate_before_;    // [m/s], w_(t-1)
  std::vector<double> turning_before_;  // [rad/s]
};

}  // namespace crossdem
