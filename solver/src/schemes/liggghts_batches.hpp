#pragma once
// LIGGGHTS in batches.

#include <span>
#include <type_traits>

#include "conventional_batches.hpp"
#include "liggghts.hpp"

namespace crossdem {

template <class Motion>
using LiggghtsGroup = std::conditional_t<Motion::remembers, batch::SetVelocitiesGroup, batch::VerletGroup>;

template <class Motion>
class LiggghtsBatches : public ConventionalBatches<LiggghtsScheme<Motion>, LiggghtsGroup<Motion>> {
  using Base = ConventionalBatches<LiggghtsScheme<Motion>, LiggghtsGroup<Motion>>;

 public:
  using Base::Base;
  using typename Base::Group;
  using Pairs = batch::LiggghtsPairs;
  using Memory = typename LiggghtsScheme<Motion>::PairMemory;
  static constexpr bool marks = true;
  static constexpr bool weight_comes_before_surfaces = true;

  void take(const World& w, std::size_t i, batch::Disc& disc, Group& group, std::size_t k) const {
    Base::take(w, i, disc, group, k);
    const auto kick = LiggghtsScheme<Motion>::half_kick_of(w.particles, i, w.dt);
    group.push[k] = kick.per_force;
    group.turn[k] = kick.per_moment;
    if constexpr (Motion::remembers) {
      const Particles& p = w.particles;
      group.mass[k] = p.mass[i];
      group.inertia[k] = 0.5 * (p.radius[i] * p.radius[i] * p.mass[i]);
    }
  }

  void give_back(World& w, std::size_t i, const batch::Disc& disc, const batch::Load& load, const Group& group,
                 std::size_t k) const {
    Base::give_back(w, i, disc, load, group, k);
    w.loads[i].force.y() -= group.weight[k];
    w.particles.displacement[i] = w.dt * w.particles.velocity[i];
  }

  static std::array<double, 2> numbers(const Memory& memory) { return {memory.shear.x(), memory.shear.y()}; }
  static Memory memory(const std::array<double, 2>& numbers) { return {.shear = {numbers[0], numbers[1]}}; }

  void add_pair_forces(const World& w, std::span<Pairs> pairs, const batch::Disc* discs, batch::Load* loads) const {
    batch::add_liggghts_forces(pairs, discs, loads, w.particle_particle, w.dt, Base::scheme().limit_force());
  }

  static batch::Moved move(const World& w, std::size_t particles, Group* groups, batch::Disc* discs,
                           batch::Load* loads) {
    return batch::move_verlet(particles, groups, discs, loads, w.dt);
  }
};

}  // namespace crossdem
