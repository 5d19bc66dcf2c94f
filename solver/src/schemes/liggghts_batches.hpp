#pragma once
// LIGGGHTS in batches.

#include <span>

#include "conventional_batches.hpp"
#include "liggghts.hpp"

namespace crossdem {

class LiggghtsBatches : public ConventionalBatches<LiggghtsScheme<LiggghtsVerlet>> {
 public:
  using Group = batch::VerletGroup;
  using Pairs = batch::LiggghtsPairs;
  using Memory = LiggghtsScheme<LiggghtsVerlet>::PairMemory;
  using ConventionalBatches::ConventionalBatches;
  static constexpr bool marks = true;
  static constexpr bool weight_comes_before_surfaces = true;

  static void take(const World& w, std::size_t i, batch::Disc& disc, Group& group, std::size_t k) {
    take_motion(w, i, disc);
    const auto kick = LiggghtsScheme<LiggghtsVerlet>::half_kick_of(w.particles, i, w.dt);
    group.push[k] = kick.per_force;
    group.turn[k] = kick.per_moment;
  }

  static void give_back(World& w, std::size_t i, const batch::Disc& disc, const batch::Load& load, const Group& group,
                        std::size_t k) {
    give_back_motion(w, i, disc, load);
    w.loads[i].force.y() -= group.weight[k];
    w.particles.displacement[i] = w.dt * w.particles.velocity[i];
  }

  static std::array<double, 2> numbers(const Memory& memory) { return {memory.shear.x(), memory.shear.y()}; }
  static Memory memory(const std::array<double, 2>& numbers) { return {.shear = {numbers[0], numbers[1]}}; }

  void add_pair_forces(const World& w, std::span<Pairs> pairs, const batch::Disc* discs, batch::Load* loads) const {
    batch::add_liggghts_forces(pairs, discs, loads, w.particle_particle, w.dt, scheme().limit_force());
  }

  static batch::Moved move(const World& w, std::size_t particles, Group* groups, batch::Disc* discs,
                           batch::Load* loads) {
    return batch::move_verlet(particles, groups, discs, loads, w.dt);
  }
};

}  // namespace crossdem
