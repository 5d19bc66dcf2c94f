#pragma once
// The paper's scheme, and its mixtures with what established codes do: one step, its ingredients chosen by readings.

#include "../laws/tanaka.hpp"
#include "../step.hpp"

namespace crossdem {

/// The default readings: known to the compiler, so that the step holds no branch for the others.
struct PaperScheme {
  using Spring = ContactSpring;
  TanakaLaw<DefaultReadings> law;
  AveragedDisplacement integrator;
};

/// The same with rolling resistance.
struct RollingScheme {
  using Spring = RollingContactSpring;
  TanakaLaw<DefaultReadings> law;
  AveragedDisplacement integrator;
};

/// Any readings, and rolling resistance.
struct MixedScheme {
  using Spring = RollingContactSpring;
  TanakaLaw<Readings> law;
  ChosenIntegrator integrator;
};

template <class Scheme>
class PaperStepper final : public Stepper {
 public:
  using Spring = typename Scheme::Spring;
  using OwnContacts = PaperContacts<Spring>;

  PaperStepper(const Scheme& scheme, const Readings& readings, World& world)
      : scheme_(scheme),
        in_turn_(readings.update_order == UpdateOrder::in_turn),
        contacts_(in_turn_ ? MemoryOwner::particle : MemoryOwner::pair, ListSkin(world.particles),
                  world.particle_particle.joint_stretch()) {
    Particles& p = world.particles;
    if (readings.inertia == Inertia::sphere)
      for (std::size_t i = 0; i < p.count(); ++i) p.inertia[i] = 0.4 * p.mass[i] * p.radius[i] * p.radius[i];
    if (readings.initial_displacement == InitialDisplacement::velocity) {
      for (std::size_t i = 0; i < p.count(); ++i) {
        p.displacement[i] = p.velocity[i] * world.dt;
        p.rotation[i] = p.spin[i] * world.dt;
      }
    }
    contacts_.rebuild(p, world.surfaces);
    world.clear_loads();
    take_overlaps_as_old_contacts(world, readings.bar_corner);
  }

  void advance(World& world, long steps) override {
    Step<Scheme> step(world, contacts_, scheme_);
    if (in_turn_)
      for (long n = 0; n < steps; ++n) step.in_turn();
    else
      for (long n = 0; n < steps; ++n) step.forces_then_moves();
  }

  [[nodiscard]] OwnContacts& contacts() { return contacts_; }

  /// e_n^2 / 2 k_n + (e_s^2 + e_r^2) / 2 k_s.
  [[nodiscard]] double spring_energy(const World& world) const override {
    double energy = 0.0;
    const auto add = [&](const Spring& spring, const ContactParameters& parameters) {
      if (!spring.touching()) return;
      energy += spring.normal * spring.normal / (2 * parameters.normal_stiffness);
      double shear_squared = spring.shear * spring.shear;
      if constexpr (requires { spring.rolling; }) shear_squared += spring.rolling * spring.rolling;
      if (parameters.shear_stiffness > 0.0) energy += shear_squared / (2 * parameters.shear_stiffness);
    };
    for (const auto& contact : contacts_.pairs()) add(contact.memory, world.particle_particle);
    for (const auto& contact : contacts_.on_surfaces()) add(contact.memory, world.particle_wall);
    return energy;
  }

  void save(OutArchive& archive) override { archive(contacts_); }
  void load(InArchive& archive) override { archive(contacts_); }

 private:
  /// Their normal springs are the forces until the first evaluation: an integrator may begin with a kick.
  void take_overlaps_as_old_contacts(World& world, BarCorner corner) {
    const Particles& p = world.particles;
    for (auto& contact : contacts_.pairs()) {
      const Vector2 between = p.position[contact.j] - p.position[contact.i];
      const double overlap = p.radius[contact.i] + p.radius[contact.j] - between.norm();
      if (overlap <= 0.0) continue;
      contact.memory.normal = world.particle_particle.normal_stiffness * overlap;
      const Vector2 push = contact.memory.normal * between.normalized();
      world.loads[contact.i].force -= push;
      if (!in_turn_) world.loads[contact.j].force += push;  // else the other has a contact of its own
    }
    for (auto& contact : contacts_.on_surfaces()) {
      const Vector2& centre = p.position[contact.i];
      const NearestPoint nearest = world.surfaces.nearest_point(contact.surface, centre);
      if (!world.surfaces.touch(contact.surface, nearest, centre, p.radius[contact.i], corner)) continue;
      const double overlap = p.radius[contact.i] - nearest.distance;
      contact.memory.normal = world.particle_wall.normal_stiffness * overlap;
      const Vector2 received = -contact.memory.normal * nearest.normal;
      world.loads[contact.i].force += received;
      world.totals.add(world.surfaces, contact.surface, centre, received);
    }
  }

  Scheme scheme_;
  bool in_turn_;
  OwnContacts contacts_;
};

}  // namespace crossdem
