#pragma once
// What LIGGGHTS-PUBLIC 3.8 does with discs, step by step and to the last bit: velocity Verlet (src/fix_nve_sphere.cpp)
// and the law "hooke/stiffness tangential history absolute_damping on tangential_damping on"
// (src/surface_model_default.h, normal_model_hooke_stiffness.h, tangential_model_history.h). In the plane, so that its
// products with zero are left out.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "conventional.hpp"
#include "liggghts_mesh.hpp"

namespace crossdem {

/// Velocity Verlet as it stands.
class LiggghtsVerlet {
 public:
  static constexpr double first_share = 0.5;  // of a step, in which the loads before it act
  explicit LiggghtsVerlet(const Particles&) {}
  static void begin(Particles&) {}
  static void end(World&) {}
};

/// The paper's averaged displacement inside LIGGGHTS, by velocities that are set between steps: with w the velocity by
/// which a step has moved, taken back from that of its end, v = (3 w_t - w_(t-1)) / 2 makes the next half kick give
/// Eqs. (16)-(21). The paper's velocity is 2 w_t - w_(t-1).
class LiggghtsSetVelocities {
 public:
  static constexpr double first_share = 1.0;
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

 private:
  std::vector<Vector2> set_;            // [m/s], between this step and the next
  std::vector<double> set_spin_;        // [rad/s]
  std::vector<Vector2> rate_before_;    // [m/s], w_(t-1)
  std::vector<double> turning_before_;  // [rad/s]
};

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
    const Reaction f = react({.delta = delta,
                              .inverse = inverse,
                              .overlap = overlap,
                              .velocity = p.velocity[i] - p.velocity[j],
                              .turning = turning},
                             w.particle_particle, w.dt, contact.memory.shear, advance);
    w.loads[i].force += f.force;
    w.loads[i].moment += -arm_i * f.couple;
    w.loads[j].force += -f.force;
    w.loads[j].moment += -arm_j * f.couple;
    w.energy_ledger.contact_work -=
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
  struct Approach {
    Vector2 delta = Vector2::Zero();  // [m], from the partner's centre or the wall's closest point to the centre of i
    double inverse = 0.0;             // 1 / distance [1/m]
    double overlap = 0.0;             // [m]
    Vector2 velocity = Vector2::Zero();  // [m/s], of i relative to its partner
    double turning = 0.0;                // [rad/s], of the surfaces, over the distance
  };
  struct Reaction {
    Vector2 force = Vector2::Zero();  // [N], on i
    double couple = 0.0;              // [N]: the moment is -arm x couple
  };

  /// The law. `shear` is the contact's memory.
  Reaction react(const Approach& a, const ContactParameters& k, double dt, Vector2& shear, bool advance) {
    const Vector2 normal = a.delta * a.inverse;
    const double approach = a.velocity.x() * normal.x() + a.velocity.y() * normal.y();  // < 0: approaching
    const Vector2 sliding =
        a.velocity - approach * normal - Vector2(0.0 - a.delta.y() * a.turning, a.delta.x() * a.turning - 0.0);
    double push = -k.normal_damping * approach + k.normal_stiffness * a.overlap;
    if (limit_force_ && push < 0.0) push = 0.0;

    if (advance) {
      shear += sliding * dt;
      const double off_plane = shear.x() * normal.x() + shear.y() * normal.y();
      shear -= off_plane * normal;
    }
    const double stretch = std::sqrt(shear.x() * shear.x() + shear.y() * shear.y());
    Vector2 drag = -(k.shear_stiffness * shear);
    const double spring = k.shear_stiffness * stretch;
    const double cap = k.friction * std::abs(push);
    if (spring > cap) {
      drag *= cap / spring;
      if (advance) shear = -drag / k.shear_stiffness;
    } else {
      drag -= k.shear_damping * sliding;
    }
    spring_energy_ += 0.5 * k.normal_stiffness * a.overlap * a.overlap + 0.5 * k.shear_stiffness * shear.squaredNorm();
    return {push * normal + drag, normal.x() * drag.y() - normal.y() * drag.x()};
  }

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

  void touch(World& w, const SurfaceContact<SurfaceMemory>& contact, const Vector2& delta, double overlap,
             const Vector2& wall_velocity, Vector2& shear, bool advance) {
    Particles& p = w.particles;
    const std::uint32_t i = contact.i;
    const double distance = p.radius[i] - overlap;
    const double inverse = 1.0 / distance;
    const double arm = p.radius[i] - 0.5 * overlap;
    const Reaction f = react({.delta = delta,
                              .inverse = inverse,
                              .overlap = p.radius[i] - distance,
                              .velocity = p.velocity[i] - wall_velocity,
                              .turning = arm * p.spin[i] * inverse},
                             w.particle_wall, w.dt, shear, advance);
    w.loads[i].force += f.force;
    w.loads[i].moment += -arm * f.couple;
    w.totals.add(w.surfaces, contact.surface, p.position[i], f.force);
    w.energy_ledger.contact_work -= w.dt * (f.force.dot(p.velocity[i] - wall_velocity) - f.couple * arm * p.spin[i]);
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
