#pragma once
// The paper's scheme by the default readings, eight pairs and particles at a time: the same bits as PaperStepper, which
// stays as what this is held against.

#include <vector>

#include "../batch/kernels.hpp"
#include "paper.hpp"

namespace crossdem {

class BatchedPaperStepper final : public Stepper {
 public:
  BatchedPaperStepper(const Readings& readings, World& world) : plain_(PaperScheme{}, readings, world) {}

  void advance(World& world, long steps) override {
    take(world);
    for (long n = 0; n < steps; ++n) step(world);
    give_back(world);
  }

  [[nodiscard]] double spring_energy(const World& world) const override { return plain_.spring_energy(world); }

 private:
  void step(World& w) {
    if (w.surfaces.bar) w.surfaces.bar->advance(w.dt);
    if (contacts().outdated(moved_, w.surfaces)) {
      give_back(w);
      w.check();
      contacts().rebuild(w.particles, w.surfaces);
      take(w);
    }
    w.totals.clear();
    batch::add_pair_forces(pairs_, discs_.data(), loads_.data(), w.particle_particle, w.dt);
    for (PaperContacts::OnSurface& contact : contacts().on_surfaces()) surface_load(w, contact);
    moved_ = std::sqrt(batch::move(w.particles.count(), groups_.data(), discs_.data(), loads_.data(), w.gravity, w.dt));
    w.enter_impulses(1.0);
    ++w.steps;
  }

  void surface_load(World& w, PaperContacts::OnSurface& contact) {
    const batch::Disc& disc = discs_[contact.i];
    batch::Load& load = loads_[contact.i];
    const batch::Group& group = groups_[contact.i / batch::width];
    const std::size_t k = contact.i % batch::width;
    const DiscInMotion motion{{disc.x, disc.y},
                              disc.radius,
                              {disc.displacement_x, disc.displacement_y},
                              group.rotation[k],
                              {group.velocity_x[k], group.velocity_y[k]},
                              group.spin[k]};
    SurfaceForce f;
    if (!surface_force(PaperScheme{}.law, w, contact.surface, motion, contact.memory, f)) return;
    const Vector2 on_disc = received(f.force, f.normal);
    load.force_x += on_disc.x();
    load.force_y += on_disc.y();
    load.moment -= f.arm * f.force.shear;
    load.work += f.work;
    w.totals.add(w.surfaces, contact.surface, motion.centre, on_disc);
  }

  /// From the world and the list into batches.
  void take(const World& w);
  /// And back.
  void give_back(World& w);

  PaperContacts& contacts() { return plain_.contacts(); }

  PaperStepper<PaperScheme> plain_;
  std::vector<batch::Disc> discs_;  // of whole groups, and two that no other is near
  std::vector<batch::Load> loads_;
  std::vector<batch::Group> groups_;
  std::vector<batch::Pairs> pairs_;
  double moved_ = 0.0;  // [m], farthest of any particle since the list was made
};

}  // namespace crossdem
