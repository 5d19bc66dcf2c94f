#pragma once
// The step, as in the paper's flow chart: contacts, then forces, then moves.

#include "contact_law.hpp"
#include "contacts.hpp"
#include "world.hpp"

namespace crossdem {

/// Eqs. (1), (2) for displacements (or velocities) `relative` = i minus j, with `turning` = r_i phi_i + r_j phi_j.
struct RelativeMotion {
  double normal;
  double shear;
  RelativeMotion(const Vector2& relative, double turning, const Vector2& normal_direction)
      : normal(relative.dot(normal_direction)),
        shear(relative.y() * normal_direction.x() - relative.x() * normal_direction.y() + turning) {}
};

template <class Spring>
using PaperContacts = Contacts<Spring, Spring>;

/// What a disc has of its contact with a surface.
struct SurfaceForce {
  ContactForce force;
  Vector2 normal = Vector2::Zero();  // from the disc to the surface
  double lever = 0.0;                // of the moment: arm / radius
  double work = 0.0;                 // [J], f_n du_n + f_s du_s + f_r R dphi
};

/// Eqs. (2), (12): the moment's arm over the radius; as printed the whole radius.
inline double moment_lever(TorqueArm reading, double radius, double overlap) {
  return reading == TorqueArm::radius ? 1.0 : 1.0 - 0.5 * overlap / radius;
}

/// Of a surface, whose R is the disc's radius.
inline constexpr double surface_rolling_lever = 1.0;

/// [N], what shear and rolling turn a disc by at its rim: the moment is -radius times that.
inline double rim_force(const ContactForce& f, double lever, double rolling_lever) {
  return lever * f.shear + rolling_lever * f.rolling;
}

/// [J], by the displacements of the step.
inline double work_of(const ContactForce& f, const RelativeDisplacement& u) {
  return f.normal * u.normal + f.shear * u.shear + f.rolling * u.rolling;
}

/// The law of a pair, a wall or the bar in the place of j. False where they do not touch. Inlined by force: a disc that
/// is handed over in memory, number by number, would be waited for when it is read as vectors.
template <class Law, class Spring>
[[gnu::always_inline]] inline bool surface_force(const Law& law, const Surfaces& surfaces,
                                                 const ContactParameters& parameters, double dt,
                                                 SurfaceContact<Spring>& contact, const DiscInMotion& disc,
                                                 SurfaceForce& f) {
  const NearestPoint nearest = surfaces.nearest_point(contact.surface, disc.centre);
  if (!surfaces.touch(contact.surface, nearest, disc.centre, disc.radius, law.readings.bar_corner)) {
    contact.memory = {};
    return false;
  }
  const double overlap = disc.radius - nearest.distance;
  f.normal = nearest.normal;
  f.lever = moment_lever(law.readings.torque_arm, disc.radius, overlap);
  const double arm = f.lever * disc.radius;
  const RelativeMotion moved(disc.displacement - surfaces.displacement(contact.surface), arm * disc.rotation, f.normal);
  RelativeDisplacement u{moved.normal, moved.shear, overlap, moved.normal, moved.shear};
  if (law.readings.dashpot_velocity == DashpotVelocity::true_velocity) {
    const RelativeMotion velocity(disc.velocity * dt - surfaces.displacement(contact.surface), arm * disc.spin * dt,
                                  f.normal);
    u.damped_normal = velocity.normal;
    u.damped_shear = velocity.shear;
  }
  u.rolling = disc.radius * disc.rotation;
  f.force = law.force(u, parameters, dt, contact.memory);
  f.work = work_of(f.force, u);
  return true;
}

/// Eqs. (10), (11): the force [N] that a particle receives of a contact whose partner lies in direction `normal`.
inline Vector2 received(const ContactForce& force, const Vector2& normal) {
  return {-force.normal * normal.x() + force.shear * normal.y(), -force.normal * normal.y() - force.shear * normal.x()};
}

template <class Scheme>
class Step {
  using OwnContacts = PaperContacts<typename Scheme::Spring>;
  using Pair = typename OwnContacts::Pair;
  using OnSurface = typename OwnContacts::OnSurface;

 public:
  Step(World& world, OwnContacts& contacts, const Scheme& scheme)
      : w_(world),
        p_(world.particles),
        contacts_(contacts),
        scheme_(scheme),
        joint_stretch_(world.particle_particle.joint_stretch()) {}

  /// All forces, then all moves.
  void forces_then_moves() {
    begin();
    for (Pair& contact : contacts_.pairs()) {
      PairForce f;
      if (!pair_force(contact, f)) continue;
      add(contact.i, f.force, f.normal, f.lever_i, f.rolling_lever_i);
      add(contact.j, f.force, -f.normal, f.lever_j, -f.rolling_lever_j);
    }
    add_in_sums(w_, contacts_.on_surfaces(),
                [this](OnSurface& contact, SurfaceTotals& totals) { surface_load(contact, totals); });
    for (std::size_t i = 0; i < p_.count(); ++i) scheme_.integrator.advance(p_, i, w_.loads[i], w_.gravity, w_.dt);
    end();
  }

  /// Section 2.6 read literally: each particle in turn takes its forces, with springs of its own, and moves at once.
  void in_turn() {
    begin();
    auto pair = contacts_.pairs().begin();
    auto on_surface = contacts_.on_surfaces().begin();
    for (std::size_t i = 0; i < p_.count(); ++i) {
      for (; pair != contacts_.pairs().end() && pair->i == i; ++pair) {
        PairForce f;
        if (pair_force(*pair, f)) add(pair->i, f.force, f.normal, f.lever_i, f.rolling_lever_i);
      }
      for (; on_surface != contacts_.on_surfaces().end() && on_surface->i == i; ++on_surface)
        surface_load(*on_surface, w_.totals);
      scheme_.integrator.advance(p_, i, w_.loads[i], w_.gravity, w_.dt);
    }
    end();
  }

 private:
  struct PairForce {
    ContactForce force;
    Vector2 normal = Vector2::Zero();  // from i to j
    double lever_i = 0.0;              // of the moment: arm / radius
    double lever_j = 0.0;
    double rolling_lever_i = 0.0;  // r_j / (r_i + r_j): of R = r_i r_j / (r_i + r_j) in radii r_i
    double rolling_lever_j = 0.0;
  };

  void begin() {
    if (scheme_.integrator.kicks_twice()) w_.enter_impulses(0.5);
    scheme_.integrator.begin(p_, w_.loads, w_.gravity, w_.dt);
    if (w_.surfaces.bar) w_.surfaces.bar->advance(w_.dt);
    if (contacts_.outdated(p_, w_.surfaces)) {
      w_.check();
      contacts_.rebuild(p_, w_.surfaces, w_.steps);
    }
    w_.clear_loads();
  }

  [[nodiscard]] double lever(std::uint32_t i, double overlap) const {
    return moment_lever(scheme_.law.readings.torque_arm, p_.radius[i], overlap);
  }

  /// False where the two neither touch nor hold together: a joint is over where its spring would hold its strength,
  /// whatever Eq. (5) has left in it.
  bool pair_force(Pair& contact, PairForce& f) {
    const std::uint32_t i = contact.i;
    const std::uint32_t j = contact.j;
    const Vector2 between = p_.position[j] - p_.position[i];
    const double reach = p_.radius[i] + p_.radius[j];
    const double distance_squared = between.squaredNorm();
    const double farthest = reach + (contact.memory.touching() ? joint_stretch_ : 0.0);
    if (distance_squared >= farthest * farthest) {
      contact.memory = {};
      return false;
    }
    const double distance = std::sqrt(distance_squared);
    const double overlap = reach - distance;
    f.normal = between * (1.0 / distance);
    f.lever_i = lever(i, overlap);
    f.lever_j = lever(j, overlap);
    const double arm_i = f.lever_i * p_.radius[i];
    const double arm_j = f.lever_j * p_.radius[j];
    const RelativeMotion moved(p_.displacement[i] - p_.displacement[j], arm_i * p_.rotation[i] + arm_j * p_.rotation[j],
                               f.normal);
    RelativeDisplacement u{moved.normal, moved.shear, overlap, moved.normal, moved.shear};
    if (scheme_.law.readings.dashpot_velocity == DashpotVelocity::true_velocity) {
      const RelativeMotion velocity(p_.velocity[i] - p_.velocity[j], arm_i * p_.spin[i] + arm_j * p_.spin[j], f.normal);
      u.damped_normal = velocity.normal * w_.dt;
      u.damped_shear = velocity.shear * w_.dt;
    }
    f.rolling_lever_i = p_.radius[j] / reach;
    f.rolling_lever_j = p_.radius[i] / reach;
    u.rolling =
        f.rolling_lever_i * (p_.radius[i] * p_.rotation[i]) - f.rolling_lever_j * (p_.radius[j] * p_.rotation[j]);
    f.force = scheme_.law.force(u, w_.particle_particle, w_.dt, contact.memory);
    w_.contact_work[i] += work_of(f.force, u);
    return true;
  }

  void surface_load(OnSurface& contact, SurfaceTotals& totals) {
    const std::uint32_t i = contact.i;
    const DiscInMotion disc{p_.position[i], p_.radius[i],   p_.displacement[i],
                            p_.rotation[i], p_.velocity[i], p_.spin[i]};
    SurfaceForce f;
    if (!surface_force(scheme_.law, w_.surfaces, w_.particle_wall, w_.dt, contact, disc, f)) return;
    w_.contact_work[i] += f.work;
    totals.add(w_.surfaces, contact.surface, disc.centre, add(i, f.force, f.normal, f.lever, surface_rolling_lever));
  }

  /// Eqs. (10)-(12): the load of one contact on particle i, whose partner lies in direction `normal`. Returns the
  /// force.
  Vector2 add(std::uint32_t i, const ContactForce& force, const Vector2& normal, double lever_i,
              double rolling_lever_i) {
    Vector2 on_i = received(force, normal);
    w_.loads[i].force += on_i;
    w_.loads[i].rim += rim_force(force, lever_i, rolling_lever_i);
    return on_i;
  }

  void end() {
    w_.enter_impulses(scheme_.integrator.kicks_twice() ? 0.5 : 1.0);
    ++w_.steps;
  }

  World& w_;
  Particles& p_;
  OwnContacts& contacts_;
  const Scheme& scheme_;
  double joint_stretch_;  // [m]
};

}  // namespace crossdem
