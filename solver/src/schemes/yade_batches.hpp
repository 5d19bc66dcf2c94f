#pragma once
// YADE in batches.

#include <span>

#include "conventional_batches.hpp"
#include "yade.hpp"

namespace crossdem {

class YadeBatches : public ConventionalBatches<YadeScheme<YadeLeapFrog>> {
 public:
  using Group = batch::LeapFrogGroup;
  using Pairs = batch::YadePairs;
  using ConventionalBatches::ConventionalBatches;
  static constexpr bool marks = false;
  static constexpr bool weight_comes_before_surfaces = false;

  static void take(const World& w, std::size_t i, batch::Disc& disc, Group& group, std::size_t k) {
    take_motion(w, i, disc);
    group.mass[k] = w.particles.mass[i];
    group.per_mass[k] = 1.0 / w.particles.mass[i];
    group.inertia[k] = w.particles.inertia[i];
    group.per_inertia[k] = 1.0 / w.particles.inertia[i];
  }

  static void give_back(World& w, std::size_t i, const batch::Disc& disc, const batch::Load& load, const Group&,
                        std::size_t) {
    give_back_motion(w, i, disc, load);
  }

  static std::array<double, 4> numbers(const ViscElMemory& memory) {
    return {memory.shear.x(), memory.shear.y(), memory.normal.x(), memory.normal.y()};
  }
  static ViscElMemory memory(const std::array<double, 4>& numbers) {
    const Vector2 normal(numbers[2], numbers[3]);
    return {{numbers[0], numbers[1]}, normal, normal != Vector2::Zero()};
  }

  void add_pair_forces(const World& w, std::span<Pairs> pairs, const batch::Disc* discs, batch::Load* loads) const {
    batch::add_yade_forces(pairs, discs, loads, scheme().pairs(), w.dt);
  }

  static batch::Moved move(const World& w, std::size_t particles, Group* groups, batch::Disc* discs,
                           batch::Load* loads) {
    return batch::move_leap_frog(particles, groups, discs, loads, w.gravity, w.dt);
  }
};

}  // namespace crossdem
