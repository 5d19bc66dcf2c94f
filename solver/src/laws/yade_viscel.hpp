#pragma once
// The law of YADE 2023.02, Law2_ScGeom_ViscElPhys_Basic, operation by operation. In the plane, so that its products
// with zero are left out.

#include <cmath>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

/// The z component of a x b.
inline double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

struct ViscElMemory {
  Vector2 shear = Vector2::Zero();   // [N], the elastic shear force on body 2
  Vector2 normal = Vector2::Zero();  // from body 1 to body 2, at the last evaluation
  bool real = false;                 // as YADE calls an interaction that has touched and not yet parted
};

template <class Archive>
void serialize(Archive& archive, ViscElMemory& memory) {
  archive(memory.shear, memory.normal, memory.real);
}

/// `normal` from body 1 to body 2, `velocity` [m/s] of body 1 relative to body 2 at the contact point, `force` [N] on
/// body
/// 2. False where they have parted (`overlap` [m] < 0): the interaction is deleted, with its memory.
inline bool yade_viscel(const Vector2& normal, double overlap, const Vector2& velocity, const ContactParameters& k,
                        double dt, ViscElMemory& memory, Vector2& force) {
  if (overlap < 0.0) {
    memory = {};
    return false;
  }
  Vector2& shear = memory.shear;
  if (memory.real) {  // turned with the contact, to first order
    const double turn = cross(memory.normal, normal);
    shear = {shear.x() - shear.y() * turn, shear.y() + shear.x() * turn};
  }
  memory.normal = normal;
  memory.real = true;

  const double approach = normal.dot(velocity);
  const Vector2 sliding = velocity - approach * normal;
  shear += k.shear_stiffness * dt * sliding;
  const double push = k.normal_stiffness * overlap + k.normal_damping * approach;
  const Vector2 normal_force = push < 0.0 ? Vector2(Vector2::Zero()) : Vector2(push * normal);
  const double cap_squared = normal_force.squaredNorm() * (k.friction * k.friction);
  Vector2 viscous = Vector2::Zero();
  if (shear.squaredNorm() > cap_squared)
    shear *= std::sqrt(cap_squared) / shear.norm();
  else
    viscous = k.shear_damping * sliding;
  force = normal_force + shear + viscous;
  return true;
}

/// [J] in the springs of a contact, if it is one.
inline double yade_spring_energy(double overlap, const ContactParameters& k, const ViscElMemory& memory) {
  if (!memory.real) return 0.0;
  const double shear = k.shear_stiffness > 0.0 ? 0.5 * memory.shear.squaredNorm() / k.shear_stiffness : 0.0;
  return 0.5 * k.normal_stiffness * overlap * overlap + shear;
}

}  // namespace crossdem
