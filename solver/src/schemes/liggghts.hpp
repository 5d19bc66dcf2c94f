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
  struct PairMemory {
    Vector2 shear = Vector2::Zero();  // [m], displacement of the shear spring
  };
  struct SurfaceMemory {
    std::array<Vector2, MeshBar::size> shear{Vector2::Zero(), Vector2::Zero(), Vector2::Zero(),
                                             Vector2::Zero(), Vector2::Zero(), Vector2::Zero()};  // [m], by triangle
    std::array<bool, MeshBar::size> held{};  // whether the triangle has a contact, touching or close
  };
  static constexpr bool first_evaluation_advances = false;

  LiggghtsScheme(const Case& setup, World& world)
      : motion_(world.particles), limit_force_(setup.scheme.readings.attraction == Attraction::clipped) {
    Particles& p = world.particles;
    const double density = setup.particles.density * setup.container.thickness;  // [kg/m^2], src/atom_vec_sphere.cpp
    for (std::size_t i = 0; i < p.count(); ++i) {
      p.mass[i] = std::numbers::pi * p.radius[i] * p.radius[i] * density;
      p.inertia[i] = 0.5 * p.mass[i] * p.radius[i] * p.radius[i];
    }
    if (!world.surfaces.bar) return;
    const auto [smallest, largest] = std::minmax_element(p.radius.begin(), p.radius.end());
    bar_.emplace(*setup.bar, world.surfaces.bar->tip(), *largest);
    listed_at_ = p.position;
    const double skin = 0.5 * *smallest;  // of the adapter
    trigger_squared_ = 0.25 * skin * skin;
  }

  /// Half a kick, the drift, the bar.
  void move(World& w) {
    motion_.begin(w.particles);
    w.enter_impulses(Motion::first_share);
    half_kick(w);
    Particles& p = w.particles;
    for (std::size_t i = 0; i < p.count(); ++i) {
      p.displacement[i] = w.dt * p.velocity[i];
      p.position[i] += p.displacement[i];
      p.angle[i] += w.dt * p.spin[i];
    }
    if (!bar_) return;
    Bar& bar = *w.surfaces.bar;
    bar.advance(w.dt);
    if (bar.moving()) bar_->translate(-bar.speed() * w.dt);
    bar_velocity_ = bar.moving() ? -bar.speed() : 0.0;
    list_as_liggghts(p);
  }

  void finish(World& w) {
    half_kick(w);
    w.enter_impulses(1.0 - Motion::first_share);
    motion_.end(w);
  }

  void begin_evaluation() { spring_energy_ = 0.0; }

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
    const HookeReaction f = react({.delta = delta,
                                   .inverse = inverse,
                                   .overlap = overlap,
                                   .velocity = p.velocity[i] - p.velocity[j],
                                   .turning = turning},
                                  w.particle_particle, w.dt, contact.memory.shear, advance);
    w.loads[i].force += f.force;
    w.loads[i].moment += -arm_i * f.couple;
    w.loads[j].force += -f.force;
    w.loads[j].moment += -arm_j * f.couple;
    w.contact_work[i] -=
        w.dt * (f.force.dot(p.velocity[i] - p.velocity[j]) - f.couple * (arm_i * p.spin[i] + arm_j * p.spin[j]));
  }

  /// Gravity is the first of the fixes.
  static void after_pairs(World& w) {
    for (std::size_t i = 0; i < w.particles.count(); ++i)
      w.loads[i].force.y() += w.particles.mass[i] * (w.gravity * -1.0);
  }

  void surface(World& w, SurfaceContact<SurfaceMemory>& contact, bool advance) {
    const Vector2& centre = w.particles.position[contact.i];
    const double radius = w.particles.radius[contact.i];
    if (contact.surface == Surface::bar) return bar_contacts(w, contact, advance);
    const bool side = contact.surface != Surface::floor;
    const double at = side ? centre.x() : centre.y();
    const double wall = contact.surface == Surface::right ? w.surfaces.width : 0.0;
    const double gap = at > wall ? at - wall - radius : wall - at - radius;
    if (gap > 0.0) {
      contact.memory = {};
      return;
    }
    const double towards = wall - at;
    const Vector2 delta = side ? Vector2(-towards, 0.0) : Vector2(0.0, -towards);
    touch(w, contact, delta, -gap, Vector2::Zero(), contact.memory.shear[0], advance);
  }

  [[nodiscard]] double spring_energy() const { return spring_energy_; }

 private:
  /// Each triangle has its contact with its own shear spring. A disc that comes to lie over the other triangle of a
  /// face takes it along, src/fix_contact_history_mesh_I.h; the first triangle of a face may then act beside the second
  /// for a step, where the disc is so near to the line between them that it counts to both.
  void bar_contacts(World& w, SurfaceContact<SurfaceMemory>& contact, bool advance) {
    const Vector2& centre = w.particles.position[contact.i];
    const double radius = w.particles.radius[contact.i];
    SurfaceMemory& memory = contact.memory;
    std::array<bool, MeshBar::size> kept{};
    for (std::size_t k = 0; k < MeshBar::size; ++k) {
      const std::optional<MeshContact> at = bar_->triangles()[k].contact(centre);
      const double gap = at ? at->distance - radius : radius;
      if (!at || (gap > 0.0 && gap >= close_share * radius)) continue;
      const std::size_t other = MeshBar::other(k);
      if (!memory.held[k]) {
        if (at->on_face && kept[other]) continue;
        memory.shear[k] = at->on_face && memory.held[other] ? memory.shear[other] : Vector2(Vector2::Zero());
      }
      kept[k] = true;
      if (gap > 0.0) {
        memory.shear[k].setZero();
        continue;
      }
      double velocity = 0.0;  // of the wall, weighed as LIGGGHTS does: the weights need not sum to one
      if (bar_velocity_ != 0.0)
        velocity = at->barycentric[0] * bar_velocity_ + at->barycentric[1] * bar_velocity_ +
                   at->barycentric[2] * bar_velocity_;
      touch(w, contact, -at->delta, -gap, {0.0, velocity}, memory.shear[k], advance);
    }
    memory.held = kept;
  }

  HookeReaction react(const HookeApproach& a, const ContactParameters& k, double dt, Vector2& shear, bool advance) {
    HookeReaction reaction = liggghts_hooke(a, k, dt, limit_force_, advance, shear);
    spring_energy_ += reaction.spring_energy;
    return reaction;
  }

  void touch(World& w, const SurfaceContact<SurfaceMemory>& contact, const Vector2& delta, double overlap,
             const Vector2& wall_velocity, Vector2& shear, bool advance) {
    Particles& p = w.particles;
    const std::uint32_t i = contact.i;
    const double distance = p.radius[i] - overlap;
    const double inverse = 1.0 / distance;
    const double arm = p.radius[i] - 0.5 * overlap;
    const HookeReaction f = react({.delta = delta,
                                   .inverse = inverse,
                                   .overlap = p.radius[i] - distance,
                                   .velocity = p.velocity[i] - wall_velocity,
                                   .turning = arm * p.spin[i] * inverse},
                                  w.particle_wall, w.dt, shear, advance);
    w.loads[i].force += f.force;
    w.loads[i].moment += -arm * f.couple;
    w.totals.add(w.surfaces, contact.surface, p.position[i], f.force);
    w.contact_work[i] -= w.dt * (f.force.dot(p.velocity[i] - wall_velocity) - f.couple * arm * p.spin[i]);
  }

  /// When LIGGGHTS makes its neighbour lists anew, it takes the edges of a mesh that moves from its nodes again; their
  /// last bits weigh the velocity of the wall. It does so when a disc has moved by half the skin, and one step after
  /// the mesh has.
  void list_as_liggghts(const Particles& p) {
    bool lists = bar_has_moved_far_;
    for (std::size_t i = 0; i < p.count() && !lists; ++i)
      lists = (p.position[i] - listed_at_[i]).squaredNorm() > trigger_squared_;
    if (lists) {
      listed_at_ = p.position;
      bar_->measure();
    }
    bar_has_moved_far_ = bar_->has_moved(trigger_squared_);
  }

  static void half_kick(World& w) {
    Particles& p = w.particles;
    const double half = 0.5 * w.dt;
    const double half_for_discs = half / 0.5;
    for (std::size_t i = 0; i < p.count(); ++i) {
      p.velocity[i] += half / p.mass[i] * w.loads[i].force;
      p.spin[i] += half_for_discs / (p.radius[i] * p.radius[i] * p.mass[i]) * w.loads[i].moment;
    }
  }

  static constexpr double close_share = 1.1 - 1.0;  // of the radius: contact_distance_factor of the adapter's deck

  Motion motion_;
  bool limit_force_;
  std::optional<MeshBar> bar_;
  double bar_velocity_ = 0.0;  // [m/s], as the wall's contacts see it
  std::vector<Vector2> listed_at_;
  double trigger_squared_ = 0.0;  // [m^2]
  bool bar_has_moved_far_ = false;
  double spring_energy_ = 0.0;
};

static_assert(ConventionalScheme<LiggghtsScheme<LiggghtsVerlet>> &&
              ConventionalScheme<LiggghtsScheme<LiggghtsSetVelocities>>);

}  // namespace crossdem
