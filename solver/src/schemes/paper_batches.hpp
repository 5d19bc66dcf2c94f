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
    double farthest_squared = 0.0;
    for (const Block& block : blocks_) {
      batch::add_pair_forces({&pairs_[block.pairs.begin], block.pairs.count()}, discs_.data(), loads_.data(),
                             w.particle_particle, w.dt);
      for (std::size_t k = block.on_surfaces.begin; k < block.on_surfaces.end; ++k)
        surface_load(w, contacts().on_surfaces()[k]);
      const std::size_t begin = block.particles.begin;
      farthest_squared = std::max(
          farthest_squared, batch::move(block.particles.count(), &groups_[begin / batch::width], &discs_[begin],
                                        &loads_[begin], w.gravity, w.dt));
    }
    moved_ = std::sqrt(farthest_squared);
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
    load.rim += f.lever * f.force.shear;
    load.work += f.work;
    w.totals.add(w.surfaces, contact.surface, motion.centre, on_disc);
  }

  struct Range {
    std::size_t begin;
    std::size_t end;
    [[nodiscard]] std::size_t count() const { return end - begin; }
  };

  /// Particles that move as soon as the forces of the pairs are there that list one of them first, and their contacts
  /// with surfaces: pairs of later particles need them no more, and all is still near the processor.
  struct Block {
    Range particles;
    Range pairs;  // batches
    Range on_surfaces;
  };

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
  std::vector<Block> blocks_;
  double moved_ = 0.0;  // [m], farthest of any particle since the list was made
};

}  // namespace crossdem
