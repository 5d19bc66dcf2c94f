#pragma once
// The bar as LIGGGHTS has it: a surface mesh of six triangles that stand upright on the plane of the discs, operation
// by operation as src/tri_mesh_I.h, src/surface_mesh_I.h and src/math_extra_liggghts.h of LIGGGHTS-PUBLIC 3.8.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

using Vector3 = Eigen::Vector3d;

/// Summed from the left, as LIGGGHTS does.
inline double dot_in_order(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// What a triangle says of a disc in reach.
struct MeshContact {
  Vector2 delta = Vector2::Zero();      // [m], from the disc's centre to the closest point
  double distance = 0.0;                // [m]
  std::array<double, 3> barycentric{};  // of the closest point
  bool on_face = false;                 // else on an edge
};

class MeshTriangle {
 public:
  /// `owned`: the one edge that acts, of those that discs can reach. An edge acts in one of the two
  /// triangles that share it, that which comes later in the file; between triangles of one plane it acts in neither.
  // NOLINTNEXTLINE(modernize-pass-by-value): an array of doubles gains nothing by a move
  MeshTriangle(const std::array<Vector3, 3>& nodes, std::optional<std::size_t> owned) : node_(nodes), owned_(owned) {
    measure();
    const Vector3 centre = (node_[0] + node_[1] + node_[2]) / 3.0;
    double reach = 0.0;
    for (const Vector3& corner : node_) reach = std::max(reach, (corner - centre).norm());
    slack_ = -1e-8 / (2.0 * reach);
  }

  /// Edges and normal from the nodes as they are: after a translation they may differ in the last bit.
  void measure() {
    for (std::size_t k = 0; k < 3; ++k) {
      edge_[k] = node_[(k + 1) % 3] - node_[k];
      length_[k] = scale_to_one(edge_[k]);
    }
    normal_ = edge_[0].cross(edge_[1]);
    scale_to_one(normal_);
    measured_at_ = node_;
  }

  /// Whether a node has moved by more than the root of `limit_squared` [m^2] since then. Each node is asked, as
  /// LIGGGHTS does: a bar whose steps divide the limit crosses it at one node a step before it does at another.
  [[nodiscard]] bool has_moved(double limit_squared) const {
    for (std::size_t k = 0; k < node_.size(); ++k)
      if (const Vector3 moved = node_[k] - measured_at_[k]; dot_in_order(moved, moved) > limit_squared) return true;
    return false;
  }

  void translate(double dy) {
    for (Vector3& corner : node_) corner.y() += dy;
  }

  /// Whether a disc within `reach` [m] of its centre might meet the triangle: cheap, and never wrongly false.
  [[nodiscard]] bool may_meet(const Vector2& centre, double reach) const {
    const Vector2 low = node_[0].head<2>().cwiseMin(node_[1].head<2>()).cwiseMin(node_[2].head<2>());
    const Vector2 high = node_[0].head<2>().cwiseMax(node_[1].head<2>()).cwiseMax(node_[2].head<2>());
    return centre.x() > low.x() - reach && centre.x() < high.x() + reach && centre.y() > low.y() - reach &&
           centre.y() < high.y() + reach;
  }

  /// None where the closest point is on an edge that does not act, or at a node: these are out of the discs' reach.
  [[nodiscard]] std::optional<MeshContact> contact(const Vector2& disc_centre) const {
    const Vector3 centre(disc_centre.x(), disc_centre.y(), 0.0);
    const Vector3 from_node = centre - node_[0];
    const double a = dot_in_order(from_node, edge_[0]);
    const double b = dot_in_order(from_node, edge_[2]);
    const double c = dot_in_order(edge_[0], edge_[2]);
    const double one_less_square = 1 - c * c;
    MeshContact found;
    auto& bary = found.barycentric;
    bary[1] = (a - b * c) / (length_[0] * one_less_square);
    bary[2] = (a * c - b) / (length_[2] * one_less_square);
    bary[0] = 1. - bary[1] - bary[2];
    const std::array<bool, 3> inside{bary[0] > slack_, bary[1] > slack_, bary[2] > slack_};
    if (inside[0] && inside[1] && inside[2]) {
      const double height = dot_in_order(normal_, from_node);
      found.on_face = true;
      return to_point(found, centre, centre - normal_ * height);
    }
    // Outside of edge k, opposite to node k + 2, are the points that only that node's coordinate excludes.
    for (std::size_t k = 0; k < 3; ++k)
      if (inside[k] && inside[(k + 1) % 3]) return edge_contact(found, centre, k);
    return std::nullopt;
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(node_, measured_at_, edge_, length_, normal_);
  }

 private:
  [[nodiscard]] std::optional<MeshContact> edge_contact(MeshContact found, const Vector3& centre, std::size_t k) const {
    const double along = dot_in_order(centre - node_[k], edge_[k]);
    if (k != owned_ || along < -1e-10 || along > length_[k] + 1e-10) return std::nullopt;
    found.barycentric[(k + 2) % 3] = 0.;
    found.barycentric[k] = 1. - along / length_[k];
    found.barycentric[(k + 1) % 3] = 1. - found.barycentric[k];
    return to_point(found, centre, node_[k] + edge_[k] * along);
  }

  /// Returns the length it had. By its reciprocal, so that what should be 1 may miss it by the last bit.
  static double scale_to_one(Vector3& vector) {
    const double length = std::sqrt(dot_in_order(vector, vector));
    vector = (1.0 / length) * vector;
    return length;
  }

  static MeshContact to_point(MeshContact found, const Vector3& centre, const Vector3& closest) {
    const Vector3 delta = closest - centre;
    const Vector3 back = centre - closest;
    found.delta = delta.head<2>();
    found.distance = std::sqrt(dot_in_order(back, back));
    return found;
  }

  std::array<Vector3, 3> node_;
  std::array<Vector3, 3> measured_at_;
  std::array<Vector3, 3> edge_;  // unit vectors, from node k to node k + 1
  std::array<double, 3> length_{};
  Vector3 normal_ = Vector3::Zero();
  double slack_ = 0.0;  // how far outside counts as on the face, in barycentric coordinates
  std::optional<std::size_t> owned_;
};

/// Left, right and bottom face in this order, two triangles each.
class MeshBar {
 public:
  static constexpr std::size_t size = 6;

  /// `largest_radius` [m]: the triangles reach 1.6 of it to either side of the plane, as in the STL file of the
  /// adapter.
  MeshBar(const BarGeometry& bar, double tip, double largest_radius) {
    const double left = bar.centre_x - bar.width / 2;
    const double right = bar.centre_x + bar.width / 2;
    const double top = tip + bar.length;
    const double half = 1.6 * largest_radius;
    add_face({left, tip}, {left, top}, half, false, true);
    add_face({right, top}, {right, tip}, half, true, false);
    add_face({right, tip}, {left, tip}, half, true, true);
  }

  void translate(double dy) {
    for (MeshTriangle& triangle : triangles_) triangle.translate(dy);
  }

  [[nodiscard]] bool has_moved(double limit_squared) const {
    return std::any_of(triangles_.begin(), triangles_.end(),
                       [&](const MeshTriangle& triangle) { return triangle.has_moved(limit_squared); });
  }

  void measure() {
    for (MeshTriangle& triangle : triangles_) triangle.measure();
  }

  [[nodiscard]] const std::vector<MeshTriangle>& triangles() const { return triangles_; }

  template <class Archive>
  void serialize(Archive& archive) {
    for (MeshTriangle& triangle : triangles_) archive(triangle);
  }

  /// The other triangle of the same face.
  static std::size_t other(std::size_t triangle) { return triangle ^ 1U; }

 private:
  void add_face(const Vector2& start, const Vector2& end, double half, bool owns_start, bool owns_end) {
    const Vector3 start_back(start.x(), start.y(), -half);
    const Vector3 end_back(end.x(), end.y(), -half);
    const Vector3 end_front(end.x(), end.y(), half);
    const Vector3 start_front(start.x(), start.y(), half);
    triangles_.emplace_back(std::array{start_back, end_back, end_front},
                            owns_end ? std::optional<std::size_t>(1) : std::nullopt);
    triangles_.emplace_back(std::array{start_back, end_front, start_front},
                            owns_start ? std::optional<std::size_t>(2) : std::nullopt);
  }

  std::vector<MeshTriangle> triangles_;
};

}  // namespace crossdem
