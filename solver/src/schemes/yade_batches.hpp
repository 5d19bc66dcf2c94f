#pragma once
// YADE in batches.

#include <span>
#include <type_traits>

#include "conventional_batches.hpp"
#include "yade.hpp"

namespace crossdem {

template <class Motion>
using YadeGroup = std::conditional_t<Motion::remembers, batch::MemoryForceGroup, batch::LeapFrogGroup>;

template <class Motion>
class YadeBatches : public ConventionalBatches<YadeScheme<Motion>, YadeGroup<Motion>> {
  using Base = ConventionalBatches<YadeScheme<Motion>, YadeGroup<Motion>>;

 public:
  using Base::Base;
  using typename Base::Group;
  using Pairs = batch::YadePairs;
  static constexpr bool marks = false;
  static constexpr bool weight_comes_before_surfaces = false;

  void take(const World& w, std::size_t i, batch::Disc& disc, Group& group, std::size_t k) const {
    Base::take(w, i, disc, group, k);
    group.mass[k] = Motion::inertia_factor * w.particles.mass[i];
    group.per_mass[k] = 1.0 / group.mass[k];
    group.inertia[k] = Motion::inertia_factor * w.particles.inertia[i];
    group.per_inertia[k] = 1.0 / group.inertia[k];
  }

  static std::array<double, 4> numbers(const ViscElMemory& memory) {
    return {memory.shear.x(), memory.shear.y(), memory.normal.x(), memory.normal.y()};
  }
  static ViscElMemory memory(const std::array<double, 4>& numbers) {
    const Vector2 normal(numbers[2], numbers[3]);
    return {{numbers[0], numbers[1]}, normal, normal != Vector2::Zero()};
  }

  void add_pair_forces(const World& w, std::span<Pairs> pairs, const batch::Disc* discs, batch::Load* loads) const {
    batch::add_yade_forces(pairs, discs, loads, Base::scheme().pairs(), w.dt);
  }

  static batch::Moved move(const World& w, std::size_t particles, Group* groups, batch::Disc* discs,
                           batch::Load* loads) {
    return batch::move_leap_frog(particles, groups, discs, loads, w.gravity / Motion::inertia_factor, w.dt);
  }
};

}  // namespace crossdem
