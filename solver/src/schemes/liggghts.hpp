#pragma once
// What LIGGGHTS-PUBLIC 3.8 does with discs, step by step and to the last bit: velocity Verlet (src/fix_nve_sphere.cpp)
// and its Hooke law, walls and bar; how many particles that holds for stands in NOTATION.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "../laws/liggghts_hooke.hpp"
#include "conventional.hpp"
#include "liggghts_mesh.hpp"
#include "liggghts_motion.hpp"

namespace crossdem {

template <class Motion>
class LiggghtsScheme {
 public:
  using PairMemory = HookeSprings;
  struct SurfaceMemory {
    std::array<HookeSprings, MeshBar::size> springs;  // by triangle
    std::array<bool, MeshBar::size> held{};           // whether the triangle has a contact, touching or close

    template <class Archive>
    void serialize(Archive& archive) {
      archive(springs, held);
    }
  };
  static constexpr bool first_evaluation_advances = false;
  static constexpr double share_before = Motion::first_share;
  static constexpr double share_after = 1.0 - Motion::first_share;

  /// The bar as a mesh. When LIGGGHTS makes its neighbour lists anew, it takes the edges of a mesh that moves from its
  /// nodes again; their last bits weigh the velocity of the wall. It does so when a disc has moved by half the skin,
  /// and one step after the mesh has.
  class OwnBar {
   public:
    OwnBar(const Case& setup, const World& world) {
      if (!world.surfaces.bar) return;
      const auto& radius = world.particles.radius;
      const auto [smallest, largest] = std::minmax_element(radius.begin(), radius.end());
      mesh_.emplace(*setup.bar, world.surfaces.bar->tip(), *largest);
      const double skin = 0.5 * *smallest;  // of the adapter
      limit_squared_ = 0.25 * skin * skin;
    }

    [[nodiscard]] bool must_list(double moved_squared) const {
      return mesh_ && (has_moved_far_ || moved_squared > limit_squared_);
    }

    void advance(const Surfaces& surfaces, double dt, bool lists) {
      if (!mesh_) return;
      const Bar& bar = *surfaces.bar;
      if (bar.moving()) mesh_->translate(-bar.speed() * dt);
      velocity_ = bar.moving() ? -bar.speed() : 0.0;
      if (lists) mesh_->measure();
      has_moved_far_ = mesh_->has_moved(limit_squared_);
    }

    template <class Archive>
    void serialize(Archive& archive) {
      if (mesh_) archive(*mesh_, velocity_, has_moved_far_);
    }

    [[nodiscard]] const MeshBar& mesh() const { return *mesh_; }
    [[nodiscard]] double velocity() const { return velocity_; }  // [m/s], as the wall's contacts see it

   private:
    std::optional<MeshBar> mesh_;
    double velocity_ = 0.0;
    double limit_squared_ = 0.0;  // [m^2]
    bool has_moved_far_ = false;
  };

  LiggghtsScheme(const Case& setup, World& world)
      : motion_(world.particles), limit_force_(setup.scheme.readings.attraction == Attraction::clipped) {
    Particles& p = world.particles;
    const double density = setup.particles.density * setup.container.thickness;  // [kg/m^2], src/atom_vec_sphere.cpp
    for (std::size_t i = 0; i < p.count(); ++i) {
      p.mass[i] = std::numbers::pi * p.radius[i] * p.radius[i] * density;
      p.inertia[i] = 0.5 * p.mass[i] * p.radius[i] * p.radius[i];
    }
  }

  [[nodiscard]] Motion& motion() { return motion_; }
  [[nodiscard]] bool limit_force() const { return limit_force_; }

  struct HalfKick {
    double per_force;   // [s/kg]
    double per_moment;  // [s/(kg m^2)]
  };
  static HalfKick half_kick_of(const Particles& p, std::size_t i, double dt) {
    const double half = 0.5 * dt;
    const double half_for_discs = half / 0.5;
    return {half / p.mass[i], half_for_discs / (p.radius[i] * p.radius[i] * p.mass[i])};
  }

  /// Half a kick and the drift.
  void move(World& w) {
    motion_.begin(w.particles);
    half_kick(w);
    Particles& p = w.particles;
    for (std::size_t i = 0; i < p.count(); ++i) {
      p.displacement[i] = w.dt * p.velocity[i];
      p.position[i] += p.displacement[i];
      p.angle[i] += w.dt * p.spin[i];
    }
  }

  void finish(World& w) {
    half_kick(w);
    motion_.end(w);
  }

  void pair(World& w, PairContact<PairMemory>& contact, bool advance) {
    Particles& p = w.particles;
    const std::uint32_t i = contact.i;
    const std::uint32_t j = contact.j;
    const Vector2 delta = p.position[i] - p.position[j];
    const double distance_squared = delta.x() * delta.x() + delta.y() * delta.y();
    const double reach = p.radius[i] + p.radius[j];
    if (!(distance_squared < reach * reach)) {
      contact.memory = {};
      return;
    }
    const double distance = std::sqrt(distance_squared);
    const double inverse = 1.0 / distance;
    const double overlap = reach - distance;
    const double arm_i = p.radius[i] - 0.5 * overlap;
    const double arm_j = p.radius[j] - 0.5 * overlap;
    const double turning = (arm_i * p.spin[i] + arm_j * p.spin[j]) * inverse;
    const HookeReaction f = liggghts_hooke({.delta = delta,
                                            .inverse = inverse,
                                            .overlap = overlap,
                                            .velocity = p.velocity[i] - p.velocity[j],
                                            .turning = turning},
                                           w.particle_particle, w.dt, limit_force_, advance, contact.memory.shear);
    const RollingSpring rolling{rolling_radius(p, i, j), p.spin[i] - p.spin[j]};
    const double resistance = rolling.moment(w.particle_particle, w.dt, f.push, advance, contact.memory.rolling);
    w.loads[i].force += f.force;
    w.loads[i].moment += -arm_i * f.couple - resistance;
    w.loads[j].force += -f.force;
    w.loads[j].moment += -arm_j * f.couple + resistance;
    w.contact_work[i] -= w.dt * (f.force.dot(p.velocity[i] - p.velocity[j]) -
                                 f.couple * (arm_i * p.spin[i] + arm_j * p.spin[j]) - resistance * rolling.turning);
  }

  /// Gravity is the first of the fixes.
  static void after_pairs(World& w) {
    for (std::size_t i = 0; i < w.particles.count(); ++i)
      w.loads[i].force.y() += w.particles.mass[i] * (w.gravity * -1.0);
  }

  [[nodiscard]] static DiscInMotion disc(const Particles& p, std::size_t i) {
    return {p.position[i], p.radius[i], Vector2::Zero(), 0.0, p.velocity[i], p.spin[i]};
  }

  static void set_motion(Particles& p, std::size_t i, const Vector2& velocity, double spin) {
    p.velocity[i] = velocity;
    p.spin[i] = spin;
  }

  void surface(const World& w, const Surfaces& surfaces, const OwnBar& bar, SurfaceContact<SurfaceMemory>& contact,
               const DiscInMotion& disc, SurfaceAction action, bool advance) const {
    const auto touch = [&](const Vector2& delta, double overlap, double wall_velocity, HookeSprings& springs) {
      touch_surface(w, surfaces, contact.surface, disc, delta, overlap, {0.0, wall_velocity}, springs, advance, action);
    };
    if (contact.surface == Surface::bar) return bar_contacts(bar, contact.memory, disc, touch);
    const auto [delta, gap] = at_wall(surfaces, contact.surface, disc.centre, disc.radius);
    if (gap > 0.0)
      contact.memory = {};
    else
      touch(delta, -gap, 0.0, contact.memory.springs[0]);
  }

  /// [J]
  [[nodiscard]] static double spring_energy(const World& w, const PairContact<PairMemory>& contact) {
    const Particles& p = w.particles;
    const double distance = (p.position[contact.i] - p.position[contact.j]).norm();
    const double overlap = p.radius[contact.i] + p.radius[contact.j] - distance;
    return hooke_spring_energy(w.particle_particle, overlap, rolling_radius(p, contact.i, contact.j), contact.memory);
  }

  [[nodiscard]] static double spring_energy(const World& w, const OwnBar& bar,
                                            const SurfaceContact<SurfaceMemory>& contact) {
    const Vector2& centre = w.particles.position[contact.i];
    const double radius = w.particles.radius[contact.i];
    if (contact.surface != Surface::bar) {
      const double overlap = -at_wall(w.surfaces, contact.surface, centre, radius).gap;
      return hooke_spring_energy(w.particle_wall, overlap, radius, contact.memory.springs[0]);
    }
    double energy = 0.0;
    for (std::size_t k = 0; k < MeshBar::size; ++k) {
      if (!contact.memory.held[k]) continue;
      const std::optional<MeshContact> at = bar.mesh().triangles()[k].contact(centre);
      if (at) energy += hooke_spring_energy(w.particle_wall, radius - at->distance, radius, contact.memory.springs[k]);
    }
    return energy;
  }

 private:
  struct AtWall {
    Vector2 delta = Vector2::Zero();  // [m], from the wall's closest point to the centre
    double gap = 0.0;                 // [m]
  };

  static AtWall at_wall(const Surfaces& surfaces, Surface surface, const Vector2& centre, double radius) {
    const bool side = surface != Surface::floor;
    const double at = side ? centre.x() : centre.y();
    const double wall = surface == Surface::right ? surfaces.width : 0.0;
    const double gap = at > wall ? at - wall - radius : wall - at - radius;
    const double towards = wall - at;
    return {{side ? -towards : 0.0, side ? 0.0 : -towards}, gap};
  }

  static double rolling_radius(const Particles& p, std::uint32_t i, std::uint32_t j) {
    return p.radius[i] * p.radius[j] / (p.radius[i] + p.radius[j]);
  }

  /// Each triangle has its contact with its own springs. A disc that comes to lie over the other triangle of a
  /// face takes it along, src/fix_contact_history_mesh_I.h; the first triangle of a face may then act beside the second
  /// for a step, where the disc is so near to the line between them that it counts to both.
  template <class Touch>
  static void bar_contacts(const OwnBar& bar, SurfaceMemory& memory, const DiscInMotion& disc, Touch touch) {
    std::array<bool, MeshBar::size> kept{};
    for (std::size_t k = 0; k < MeshBar::size; ++k) {
      if (!bar.mesh().triangles()[k].may_meet(disc.centre, (1.0 + 2 * close_share) * disc.radius)) continue;
      const std::optional<MeshContact> at = bar.mesh().triangles()[k].contact(disc.centre);
      const double gap = at ? at->distance - disc.radius : disc.radius;
      if (!at || (gap > 0.0 && gap >= close_share * disc.radius)) continue;
      const std::size_t other = MeshBar::other(k);
      if (!memory.held[k]) {
        if (at->on_face && kept[other]) continue;
        memory.springs[k] = at->on_face && memory.held[other] ? memory.springs[other] : HookeSprings{};
      }
      kept[k] = true;
      if (gap > 0.0) {
        memory.springs[k] = {};
        continue;
      }
      double velocity = 0.0;  // of the wall, weighed as LIGGGHTS does: the weights need not sum to one
      if (bar.velocity() != 0.0)
        velocity = at->barycentric[0] * bar.velocity() + at->barycentric[1] * bar.velocity() +
                   at->barycentric[2] * bar.velocity();
      touch(-at->delta, -gap, velocity, memory.springs[k]);
    }
    memory.held = kept;
  }

  void touch_surface(const World& w, const Surfaces& surfaces, Surface surface, const DiscInMotion& disc,
                     const Vector2& delta, double overlap, const Vector2& wall_velocity, HookeSprings& springs,
                     bool advance, SurfaceAction action) const {
    const double distance = disc.radius - overlap;
    const double inverse = 1.0 / distance;
    const double arm = disc.radius - 0.5 * overlap;
    const Vector2 velocity = disc.velocity - wall_velocity;
    const HookeReaction f = liggghts_hooke({.delta = delta,
                                            .inverse = inverse,
                                            .overlap = disc.radius - distance,
                                            .velocity = velocity,
                                            .turning = arm * disc.spin * inverse},
                                           w.particle_wall, w.dt, limit_force_, advance, springs.shear);
    const RollingSpring rolling{disc.radius, arm * disc.spin * inverse};  // at a wall LIGGGHTS rolls by this rate
    const double resistance = rolling.moment(w.particle_wall, w.dt, f.push, advance, springs.rolling);
    action.load.force += f.force;
    action.load.moment += -arm * f.couple - resistance;
    action.totals.add(surfaces, surface, disc.centre, f.force);
    action.work -= w.dt * (f.force.dot(velocity) - f.couple * arm * disc.spin - resistance * disc.spin);
  }

  static void half_kick(World& w) {
    Particles& p = w.particles;
    for (std::size_t i = 0; i < p.count(); ++i) {
      const HalfKick kick = half_kick_of(p, i, w.dt);
      p.velocity[i] += kick.per_force * w.loads[i].force;
      p.spin[i] += kick.per_moment * w.loads[i].moment;
    }
  }

  static constexpr double close_share = 1.1 - 1.0;  // of the radius: contact_distance_factor of the adapter's deck

  Motion motion_;
  bool limit_force_;
};

static_assert(ConventionalScheme<LiggghtsScheme<LiggghtsVerlet>> &&
              ConventionalScheme<LiggghtsScheme<LiggghtsSetVelocities>>);

}  // namespace crossdem
