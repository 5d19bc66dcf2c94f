#pragma once
// How far surfaces may be apart and still be in a list of contacts.

#include <algorithm>
#include <cmath>

#include "crossdem/state.hpp"

namespace crossdem {

/// Wide lists last long, narrow ones hold few pairs that are looked at in vain. With a list that lasts `steps`, in
/// proportion to the skin, a step costs a + b x skin + c / steps: least where the two shares are equal.
class ListSkin {
 public:
  /// Follows the motion, starting from what suits a bed that creeps.
  explicit ListSkin(const Particles& particles)
      : diameter_(2 * *std::min_element(particles.radius.begin(), particles.radius.end())),
        now_(least * diameter_),
        reserve_(0.35 * diameter_) {}

  /// Always the same [m].
  static ListSkin fixed(double skin) { return {skin, 6 * skin}; }

  [[nodiscard]] double now() const { return now_; }  // [m]
  /// [m], by how much more candidates for the next lists may be apart: so wide that a search serves some ten lists.
  [[nodiscard]] double reserve() const { return reserve_; }

  /// Takes note that the latest list was good for so many steps.
  void lasted(long steps) {
    if (diameter_ == 0.0) return;
    const double best = std::sqrt(balance * diameter_ * now_ / static_cast<double>(std::max(steps, 1L)));
    now_ = std::clamp(best, least * diameter_, most * diameter_);
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(now_);
  }

 private:
  ListSkin(double skin, double reserve) : now_(skin), reserve_(reserve) {}

  static constexpr double least = 0.05;   // diameters
  static constexpr double most = 0.4;     // diameters
  static constexpr double balance = 8.0;  // diameters x steps: c / b, measured

  double diameter_ = 0.0;  // [m], the smallest; zero: fixed
  double now_;
  double reserve_;
};

}  // namespace crossdem
