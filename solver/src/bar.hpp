#pragma once
// The bar: a rigid rectangle that moves straight down; its faces act as walls (section 3.1).

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

/// From a particle towards the nearest point of a wall or of the bar.
struct NearestPoint {
  Vector2 normal = Vector2::Zero();  // unit vector from the particle's centre to the point
  double distance = 0.0;             // [m] from the centre
};

class Bar {
 public:
  Bar(const BarGeometry& geometry, double tip) : geometry_(geometry), start_(tip), tip_(tip) {}

  void start() { moving_ = true; }
  [[nodiscard]] bool moving() const { return moving_; }
  [[nodiscard]] double speed() const { return geometry_.speed; }  // [m/s], downwards, once moving

  /// Moves the bar by one step, once it has been started.
  void advance(double dt) {
    if (!moving_) return;
    ++steps_;
    tip_ = start_ - geometry_.speed * (static_cast<double>(steps_) * dt);
    displacement_.y() = -geometry_.speed * dt;
  }

  [[nodiscard]] double tip() const { return tip_; }  // [m], y of the bottom face
  [[nodiscard]] double left() const { return geometry_.centre_x - geometry_.width / 2; }
  [[nodiscard]] double right() const { return geometry_.centre_x + geometry_.width / 2; }
  [[nodiscard]] const Vector2& displacement() const { return displacement_; }  // [m], of the last step
  [[nodiscard]] double travel() const { return start_ - tip_; }                // [m]

  /// Centre inside the rectangle or on its edge, where no direction leads out: the particle went through a face.
  [[nodiscard]] bool contains(const Vector2& centre) const {
    return centre.x() >= left() && centre.x() <= right() && centre.y() >= tip_ && centre.y() <= tip_ + geometry_.length;
  }

  /// Contacts at the bottom face and the corners belong to the tip, those at the sides to the shaft.
  [[nodiscard]] bool touches_tip(const Vector2& centre) const { return centre.y() < tip_; }

  /// Nearest point of the rectangle to a centre outside of it.
  [[nodiscard]] NearestPoint nearest_point(const Vector2& centre) const {
    const Vector2 low(left(), tip_);
    const Vector2 high(right(), tip_ + geometry_.length);
    const Vector2 reach = centre.cwiseMax(low).cwiseMin(high) - centre;
    const double distance = reach.norm();
    return {reach / distance, distance};
  }

  /// The reading "faces only": a centre that is beside two faces at once, at a corner, meets neither.
  [[nodiscard]] bool faces(const Vector2& centre) const {
    const bool beside = centre.y() >= tip_ && centre.y() <= tip_ + geometry_.length;
    const bool below = centre.x() >= left() && centre.x() <= right();
    return beside || below;
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(start_, tip_, displacement_, steps_, moving_);
  }

 private:
  BarGeometry geometry_;
  double start_;  // [m], tip before the bar moves
  double tip_;    // [m]
  Vector2 displacement_ = Vector2::Zero();
  long steps_ = 0;  // since the bar moves: positions come from the count, so that no rounding adds up
  bool moving_ = false;
};

}  // namespace crossdem
