#pragma once
// The rigid surfaces that particles can touch: three walls of the container, and the bar.

#include <array>
#include <optional>

#include "bar.hpp"

namespace crossdem {

enum class Surface : unsigned char { left, right, floor, bar };
inline constexpr std::array all_surfaces{Surface::left, Surface::right, Surface::floor, Surface::bar};

/// A disc as a surface sees it.
struct DiscInMotion {
  Vector2 centre;        // [m]
  double radius;         // [m]
  Vector2 displacement;  // [m], of the last step; only the paper's scheme asks for it
  double rotation;       // [rad], of the last step
  Vector2 velocity;      // [m/s]
  double spin;           // [rad/s]
};

/// The surfaces as one thing that can be asked for the nearest point of each.
struct Surfaces {
  double width = 0.0;      // [m], of the container
  std::optional<Bar> bar;  // none while a bed settles

  [[nodiscard]] bool present(Surface surface) const { return surface != Surface::bar || bar.has_value(); }

  [[nodiscard]] NearestPoint nearest_point(Surface surface, const Vector2& centre) const {
    switch (surface) {
      case Surface::left:
        return {{-1.0, 0.0}, centre.x()};
      case Surface::right:
        return {{1.0, 0.0}, width - centre.x()};
      case Surface::floor:
        return {{0.0, -1.0}, centre.y()};
      case Surface::bar:
        break;
    }
    return bar->nearest_point(centre);
  }

  /// Whether a disc touches the surface whose `nearest` point it is; by the reading "faces only" not at the bar's
  /// corner.
  [[nodiscard]] bool touch(Surface surface, const NearestPoint& nearest, const Vector2& centre, double radius,
                           BarCorner corner) const {
    return nearest.distance < radius &&
           (corner == BarCorner::nearest_point || surface != Surface::bar || bar->faces(centre));
  }

  /// [m], of the last step.
  [[nodiscard]] Vector2 displacement(Surface surface) const {
    return surface == Surface::bar ? bar->displacement() : Vector2::Zero();
  }

  /// Centre beyond a wall or inside the bar: no contact law brings it back.
  [[nodiscard]] bool lost(const Vector2& centre) const {
    return centre.x() < 0.0 || centre.x() > width || centre.y() < 0.0 || (bar && bar->contains(centre));
  }
};

}  // namespace crossdem
