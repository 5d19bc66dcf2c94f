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

  static constexpr double share_before = 1.0;
  static constexpr double share_after = 0.0;

  /// The bar as a box that moves by its velocity.
  struct OwnBar {
    Vector2 half = Vector2::Zero();      // [m], half the box's width and length
    Vector2 centre = Vector2::Zero();    // [m], of the box
    Vector2 velocity = Vector2::Zero();  // [m/s]

    OwnBar(const Case& setup, const World& world) {
      if (!world.surfaces.bar) return;
      half = {setup.bar->width / 2, setup.bar->length / 2};
      centre = {setup.bar->centre_x, world.surfaces.bar->tip() + half.y()};
    }
    [[nodiscard]] static bool must_list(double) { return false; }
    void advance(const Surfaces& surfaces, double dt, bool) {
      if (!surfaces.bar) return;
      velocity.y() = surfaces.bar->moving() ? -surfaces.bar->speed() : 0.0;
      centre += velocity * dt;
    }

    template <class Archive>
    void serialize(Archive& archive) {
      archive(centre, velocity);
    }
  };

  YadeScheme(const Case& setup, const World& world)
      : motion_(world.particles),
        pairs_(in_series(setup.particle_particle, setup.particle_particle, false)),
        walls_(in_series(setup.particle_particle, setup.particle_wall, true)) {}

  [[nodiscard]] Motion& motion() { return motion_; }
  [[nodiscard]] const ContactParameters& pairs() const { return pairs_; }

  void move(World& w) {
    for (std::size_t i = 0; i < w.particles.count(); ++i) motion_.move(w.particles, i, w.loads[i], w.gravity, w.dt);
  }

  static void finish(World&) {}
  static void after_pairs(World&) {}

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
    const Vector2 velocity = at_point(disc(p, i), arm_i) - at_point(disc(p, j), arm_j);
    if (!yade_viscel(normal, overlap, velocity, pairs_, w.dt, contact.memory, force)) return;
    w.loads[i].force += -force;
    w.loads[i].moment += -cross(arm_i, force);
    w.loads[j].force += force;
    w.loads[j].moment += cross(arm_j, force);
    w.contact_work[i] += force.dot(velocity) * w.dt;
  }

  [[nodiscard]] DiscInMotion disc(const Particles& p, std::size_t i) const {
    return {p.position[i], p.radius[i], Vector2::Zero(), 0.0, motion_.velocity(p, i), motion_.spin(p, i)};
  }

  void set_motion(Particles& p, std::size_t i, const Vector2& velocity, double spin) {
    motion_.set(p, i, velocity, spin);
  }

  /// The surface is body 1.
  void surface(const World& w, const Surfaces& surfaces, const OwnBar& bar, SurfaceContact<ViscElMemory>& contact,
               const DiscInMotion& disc, SurfaceAction action, bool) const {
    const Meeting at = meet(surfaces, bar, contact.surface, disc.centre, disc.radius);
    if (!contact.memory.real && at.overlap < 0.0) return;
    const Vector2 arm = at.point - disc.centre;
    const Vector2 surface_velocity = contact.surface == Surface::bar ? bar.velocity : Vector2::Zero();
    const Vector2 velocity = surface_velocity - at_point(disc, arm);
    Vector2 force;
    if (!yade_viscel(at.normal, at.overlap, velocity, walls_, w.dt, contact.memory, force)) return;
    action.load.force += force;
    action.load.moment += cross(arm, force);
    action.totals.add(surfaces, contact.surface, disc.centre, force);
    action.work += force.dot(velocity) * w.dt;
  }

  /// [J]
  [[nodiscard]] double spring_energy(const World& w, const PairContact<ViscElMemory>& contact) const {
    const Particles& p = w.particles;
    const double distance = (p.position[contact.j] - p.position[contact.i]).norm();
    return yade_spring_energy(p.radius[contact.i] + p.radius[contact.j] - distance, pairs_, contact.memory);
  }

  [[nodiscard]] double spring_energy(const World& w, const OwnBar& bar,
                                     const SurfaceContact<ViscElMemory>& contact) const {
    const Vector2& centre = w.particles.position[contact.i];
    const double overlap = meet(w.surfaces, bar, contact.surface, centre, w.particles.radius[contact.i]).overlap;
    return yade_spring_energy(overlap, walls_, contact.memory);
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
  [[nodiscard]] static Vector2 at_point(const DiscInMotion& disc, const Vector2& arm) {
    return disc.velocity + Vector2(-(disc.spin * arm.y()), disc.spin * arm.x());
  }

  static Meeting meet(const Surfaces& surfaces, const OwnBar& bar, Surface surface, const Vector2& centre,
                      double radius) {
    return surface == Surface::bar ? meet_box(bar, centre, radius) : meet_wall(surfaces, surface, centre, radius);
  }

  /// Ig2_Wall_Sphere_ScGeom: the contact point is on the wall.
  static Meeting meet_wall(const Surfaces& surfaces, Surface surface, const Vector2& centre, double radius) {
    const bool side = surface != Surface::floor;
    const double at = side ? centre.x() : centre.y();
    const double wall = surface == Surface::right ? surfaces.width : 0.0;
    const double inwards = surface == Surface::right ? -1.0 : 1.0;
    return {{side ? inwards : 0.0, side ? 0.0 : inwards},
            -(std::abs(at - wall) - radius),
            {side ? wall : centre.x(), side ? centre.y() : wall}};
  }

  /// Ig2_Box_Sphere_ScGeom, for a centre outside of the box: the contact point is half-way between both surfaces.
  static Meeting meet_box(const OwnBar& bar, const Vector2& centre, double radius) {
    const Vector2 from_box = centre - bar.centre;
    const Vector2 on_box = from_box.cwiseMax(-bar.half).cwiseMin(bar.half);
    Vector2 towards = on_box - from_box;
    const double distance = towards.norm();
    towards /= distance;
    const Vector2 of_box = on_box + bar.centre;
    const Vector2 of_disc = centre + towards * radius;
    return {-towards, radius - distance, 0.5 * (of_box + of_disc)};
  }

  Motion motion_;
  ContactParameters pairs_;
  ContactParameters walls_;
};

static_assert(ConventionalScheme<YadeScheme<YadeLeapFrog>> && ConventionalScheme<YadeScheme<YadeMemoryForce>>);

}  // namespace crossdem
