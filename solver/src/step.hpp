#pragma once
// The step, as in the paper's flow chart: contacts, then forces, then moves.

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

template <class Scheme>
class Step {
 public:
  Step(World& world, const Scheme& scheme) : w_(world), p_(world.particles), scheme_(scheme) {}

  /// All forces, then all moves.
  void forces_then_moves() {
    begin();
    for (PairContact& contact : w_.contacts.pairs()) {
      ContactForce f;
      Vector2 normal;
      if (!pair_force(contact, f, normal)) continue;
      add(contact.i, f, normal);
      add(contact.j, f, -normal);
    }
    for (SurfaceContact& contact : w_.contacts.on_surfaces()) surface_load(contact);
    for (std::size_t i = 0; i < p_.count(); ++i) move(i);
    end();
  }

  /// Section 2.6 read literally: each particle in turn takes its forces, with springs of its own, and moves at once.
  void in_turn() {
    begin();
    auto pair = w_.contacts.pairs().begin();
    auto on_surface = w_.contacts.on_surfaces().begin();
    for (std::size_t i = 0; i < p_.count(); ++i) {
      for (; pair != w_.contacts.pairs().end() && pair->i == i; ++pair) {
        ContactForce f;
        Vector2 normal;
        if (pair_force(*pair, f, normal)) add(pair->i, f, normal);
      }
      for (; on_surface != w_.contacts.on_surfaces().end() && on_surface->i == i; ++on_surface)
        surface_load(*on_surface);
      move(i);
    }
    end();
  }

 private:
  void begin() {
    if (w_.surfaces.bar) w_.surfaces.bar->advance(w_.dt);
    if (w_.contacts.outdated(p_, w_.surfaces)) {
      w_.check();
      w_.contacts.rebuild(p_, w_.surfaces);
    }
    w_.loads.assign(p_.count(), {});
    w_.totals.force.fill(Vector2::Zero());
    w_.totals.on_bar = {};
  }

  /// False where the two do not touch. `normal` points from i to j.
  bool pair_force(PairContact& contact, ContactForce& force, Vector2& normal) {
    const std::uint32_t i = contact.i;
    const std::uint32_t j = contact.j;
    const Vector2 between = p_.position[j] - p_.position[i];
    const double reach = p_.radius[i] + p_.radius[j];
    const double distance_squared = between.squaredNorm();
    if (distance_squared >= reach * reach) {
      contact.spring = {};
      return false;
    }
    const double distance = std::sqrt(distance_squared);
    normal = between / distance;
    const RelativeMotion moved(p_.displacement[i] - p_.displacement[j],
                               p_.radius[i] * p_.rotation[i] + p_.radius[j] * p_.rotation[j], normal);
    RelativeDisplacement u{moved.normal, moved.shear, reach - distance, moved.normal, moved.shear};
    if (scheme_.law.readings.dashpot_velocity == DashpotVelocity::true_velocity) {
      const RelativeMotion velocity(p_.velocity[i] - p_.velocity[j],
                                    p_.radius[i] * p_.spin[i] + p_.radius[j] * p_.spin[j], normal);
      u.damped_normal = velocity.normal * w_.dt;
      u.damped_shear = velocity.shear * w_.dt;
    }
    force = scheme_.law.force(u, w_.particle_particle, w_.dt, contact.spring);
    w_.energy_ledger.contact_work += force.normal * u.normal + force.shear * u.shear;
    return true;
  }

  /// A wall or the bar takes the place of j.
  void surface_load(SurfaceContact& contact) {
    const std::uint32_t i = contact.i;
    const Vector2& centre = p_.position[i];
    const NearestPoint nearest = w_.surfaces.nearest_point(contact.surface, centre);
    const bool on_bar = contact.surface == Surface::bar;
    const bool meets =
        nearest.distance < p_.radius[i] &&
        (scheme_.law.readings.bar_corner == BarCorner::nearest_point || !on_bar || w_.surfaces.bar->faces(centre));
    if (!meets) {
      contact.spring = {};
      return;
    }
    const RelativeMotion moved(p_.displacement[i] - w_.surfaces.displacement(contact.surface),
                               p_.radius[i] * p_.rotation[i], nearest.normal);
    RelativeDisplacement u{moved.normal, moved.shear, p_.radius[i] - nearest.distance, moved.normal, moved.shear};
    if (scheme_.law.readings.dashpot_velocity == DashpotVelocity::true_velocity) {
      const RelativeMotion velocity(p_.velocity[i] * w_.dt - w_.surfaces.displacement(contact.surface),
                                    p_.radius[i] * p_.spin[i] * w_.dt, nearest.normal);
      u.damped_normal = velocity.normal;
      u.damped_shear = velocity.shear;
    }
    const ContactForce force = scheme_.law.force(u, w_.particle_wall, w_.dt, contact.spring);
    w_.energy_ledger.contact_work += force.normal * u.normal + force.shear * u.shear;

    const Vector2 received = add(i, force, nearest.normal);
    w_.totals.force[static_cast<std::size_t>(contact.surface)] += received;
    if (on_bar) (w_.surfaces.bar->touches_tip(centre) ? w_.totals.on_bar.tip : w_.totals.on_bar.shaft) -= received;
  }

  /// Eqs. (10)-(12): the load of one contact on particle i, whose partner lies in direction `normal`. Returns the
  /// force.
  Vector2 add(std::uint32_t i, const ContactForce& force, const Vector2& normal) {
    Vector2 received(-force.normal * normal.x() + force.shear * normal.y(),
                     -force.normal * normal.y() - force.shear * normal.x());
    w_.loads[i].force += received;
    w_.loads[i].moment -= p_.radius[i] * force.shear;
    return received;
  }

  void move(std::size_t i) { Scheme::Integrator::advance(p_, i, w_.loads[i], w_.gravity, w_.dt); }

  void end() {
    MomentumLedger& ledger = w_.momentum_ledger;
    const auto impulse = [&](Surface surface) -> Vector2 {
      return w_.totals.force[static_cast<std::size_t>(surface)] * w_.dt;
    };
    ledger.left_wall += impulse(Surface::left);
    ledger.right_wall += impulse(Surface::right);
    ledger.floor += impulse(Surface::floor);
    ledger.bar += impulse(Surface::bar);
    if (w_.surfaces.bar)
      w_.energy_ledger.bar_work +=
          w_.totals.force[static_cast<std::size_t>(Surface::bar)].dot(w_.surfaces.bar->displacement());
    ++w_.steps;
  }

  World& w_;
  Particles& p_;
  const Scheme& scheme_;
};

}  // namespace crossdem
