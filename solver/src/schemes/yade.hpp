#pragma once
// What YADE 2023.02 does with discs, step by step and to the last bit: spheres bound to a plane, walls and a box; how
// many particles that holds for stands in NOTATION.md.

#include <cmath>

#include "../laws/yade_viscel.hpp"
#include "conventional.hpp"
#include "yade_motion.hpp"

namespace crossdem {

template <class Motion>
class YadeScheme {
 public:
  using PairMemory = ViscElMemory;
  using SurfaceMemory = ViscElMemory;
  static constexpr bool first_evaluation_advances = true;

  YadeScheme(const Case& setup, const World& world)
      : motion_(world.particles),
        pairs_(in_series(setup.particle_particle, setup.particle_particle, false)),
        walls_(in_series(setup.particle_particle, setup.particle_wall, true)) {
    if (!world.surfaces.bar) return;
    half_ = {setup.bar->width / 2, setup.bar->length / 2};
    centre_ = {setup.bar->centre_x, world.surfaces.bar->tip() + half_.y()};
  }

  void move(World& w) {
    w.enter_impulses(1.0);
    for (std::size_t i = 0; i < w.particles.count(); ++i) motion_.move(w.particles, i, w.loads[i], w.gravity, w.dt);
    if (!w.surfaces.bar) return;
    w.surfaces.bar->advance(w.dt);
    bar_velocity_.y() = w.surfaces.bar->moving() ? -w.surfaces.bar->speed() : 0.0;
    centre_ += bar_velocity_ * w.dt;
  }

  static void finish(World&) {}
  static void after_pairs(World&) {}
  void begin_evaluation() { spring_energy_ = 0.0; }
  [[nodiscard]] double spring_energy() const { return spring_energy_; }

  /// Ig2_Sphere_Sphere_ScGeom; body 1 is the one with the lower number.
  void pair(World& w, PairContact<ViscElMemory>& contact, bool) {
    Particles& p = w.particles;
    const std::uint32_t i = contact.i;
    const std::uint32_t j = contact.j;
    Vector2 normal = p.position[j] - p.position[i];
    const double reach = p.radius[i] + p.radius[j];
    if (!contact.memory.real && reach * reach - normal.squaredNorm() < 0.0) return;
    const double distance = normal.norm();
    normal /= distance;
    const double overlap = reach - distance;
    const Vector2 point = p.position[i] + (p.radius[i] - 0.5 * overlap) * normal;
    const Vector2 arm_i = point - p.position[i];
    const Vector2 arm_j = point - p.position[j];
    Vector2 force;
    const Vector2 velocity = at_point(p, i, arm_i) - at_point(p, j, arm_j);
    if (!react(contact.memory, pairs_, normal, overlap, velocity, w.dt, force)) return;
    w.loads[i].force += -force;
    w.loads[i].moment += -cross(arm_i, force);
    w.loads[j].force += force;
    w.loads[j].moment += cross(arm_j, force);
    w.contact_work[i] += force.dot(velocity) * w.dt;
  }

  /// The surface is body 1.
  void surface(World& w, SurfaceContact<ViscElMemory>& contact, bool) {
    Particles& p = w.particles;
    const std::uint32_t i = contact.i;
    const Meeting at = contact.surface == Surface::bar ? meet_box(p.position[i], p.radius[i])
                                                       : meet_wall(w, contact.surface, p.position[i], p.radius[i]);
    if (!contact.memory.real && at.overlap < 0.0) return;
    const Vector2 arm = at.point - p.position[i];
    const Vector2 surface_velocity = contact.surface == Surface::bar ? bar_velocity_ : Vector2::Zero();
    const Vector2 velocity = surface_velocity - at_point(p, i, arm);
    Vector2 force;
    if (!react(contact.memory, walls_, at.normal, at.overlap, velocity, w.dt, force)) return;
    w.loads[i].force += force;
    w.loads[i].moment += cross(arm, force);
    w.totals.add(w.surfaces, contact.surface, p.position[i], force);
    w.contact_work[i] += force.dot(velocity) * w.dt;
  }

 private:
  struct Meeting {
    Vector2 normal = Vector2::Zero();  // from the surface to the disc
    double overlap = 0.0;              // [m]
    Vector2 point = Vector2::Zero();   // [m], where the law takes the velocities
  };

  /// Two materials, particles with twice the values of a pair and walls such that both in series give the case's, as in
  /// the adapter. YADE combines them by 1 / (1/a + 1/b), in which 0 stands for a rigid one; the friction coefficient
  /// goes through its angle.
  static ContactParameters in_series(const ContactParameters& particle, const ContactParameters& wanted,
                                     bool of_walls) {
    const auto combined = [of_walls](double of_particle, double target) {
      const double a = 2 * of_particle;
      double b = a;
      if (of_walls) b = a == 0.0 ? target : target == a ? 0.0 : 1 / (1 / target - 1 / a);
      const double both = (a != 0.0 ? 1 / a : 0.0) + (b != 0.0 ? 1 / b : 0.0);
      return both != 0.0 ? 1 / both : 0.0;
    };
    return {.normal_stiffness = combined(particle.normal_stiffness, wanted.normal_stiffness),
            .shear_stiffness = combined(particle.shear_stiffness, wanted.shear_stiffness),
            .normal_damping = combined(particle.normal_damping, wanted.normal_damping),
            .shear_damping = combined(particle.shear_damping, wanted.shear_damping),
            .friction = std::tan(std::atan(wanted.friction))};
  }

  /// Velocity of the disc's material at `arm` from its centre [m/s].
  [[nodiscard]] Vector2 at_point(const Particles& p, std::size_t i, const Vector2& arm) const {
    const double spin = motion_.spin(p, i);
    return motion_.velocity(p, i) + Vector2(-(spin * arm.y()), spin * arm.x());
  }

  /// Ig2_Wall_Sphere_ScGeom: the contact point is on the wall.
  static Meeting meet_wall(const World& w, Surface surface, const Vector2& centre, double radius) {
    switch (surface) {
      case Surface::left:
        return {{1.0, 0.0}, -(std::abs(centre.x()) - radius), {0.0, centre.y()}};
      case Surface::right:
        return {{-1.0, 0.0}, -(std::abs(centre.x() - w.surfaces.width) - radius), {w.surfaces.width, centre.y()}};
      default:
        return {{0.0, 1.0}, -(std::abs(centre.y()) - radius), {centre.x(), 0.0}};
    }
  }

  /// Ig2_Box_Sphere_ScGeom, for a centre outside of the box: the contact point is half-way between both surfaces.
  [[nodiscard]] Meeting meet_box(const Vector2& centre, double radius) const {
    const Vector2 from_box = centre - centre_;
    const Vector2 on_box = from_box.cwiseMax(-half_).cwiseMin(half_);
    Vector2 towards = on_box - from_box;
    const double distance = towards.norm();
    towards /= distance;
    const Vector2 of_box = on_box + centre_;
    const Vector2 of_disc = centre + towards * radius;
    return {-towards, radius - distance, 0.5 * (of_box + of_disc)};
  }

  bool react(ViscElMemory& memory, const ContactParameters& k, const Vector2& normal, double overlap,
             const Vector2& velocity, double dt, Vector2& force) {
    const bool together = yade_viscel(normal, overlap, velocity, k, dt, memory, force);
    if (together) spring_energy_ += yade_spring_energy(overlap, k, memory);
    return together;
  }

  Motion motion_;
  ContactParameters pairs_;
  ContactParameters walls_;
  Vector2 half_ = Vector2::Zero();    // [m], half the box's width and length
  Vector2 centre_ = Vector2::Zero();  // [m], of the box
  Vector2 bar_velocity_ = Vector2::Zero();
  double spring_energy_ = 0.0;
};

static_assert(ConventionalScheme<YadeScheme<YadeLeapFrog>> && ConventionalScheme<YadeScheme<YadeMemoryForce>>);

}  // namespace crossdem
