#pragma once
// The paper's scheme by the default readings, in batches.

#include <span>
#include <type_traits>

#include "../batch/kernels.hpp"
#include "paper.hpp"

namespace crossdem {

/// What BatchedStepper asks of a scheme. `moves_first`: whether a step of the plain scheme begins with the motion, so
/// that one of the batches, which ends with it, holds the forces of one step and the motion of the next. Of a step's
/// impulses, `share_before` is that of the forces at its start, `share_after` that of those at its end. `marks`:
/// whether its groups remember where particles were when the code made lists of its own.
template <class PlainScheme>
class PaperBatches {
  using Spring = typename PlainScheme::Spring;
  static constexpr bool rolls = requires(Spring spring) { spring.rolling; };

 public:
  using Plain = PaperStepper<PlainScheme>;
  using Group = batch::AveragedGroup;
  using Pairs = std::conditional_t<rolls, batch::RollingPairs, batch::TanakaPairs>;
  /// The world's bar is all it takes; see ConventionalScheme.
  struct OwnBar {
    [[nodiscard]] static bool must_list(double) { return false; }
    static void advance(const Surfaces&, double, bool) {}
  };
  static constexpr bool moves_first = false;
  static constexpr bool marks = false;
  static constexpr bool weight_comes_before_surfaces = false;
  static constexpr double share_before = 0.0;
  static constexpr double share_after = 1.0;

  static Plain plain(const Case& setup, World& world) { return {PlainScheme{}, setup.scheme.readings, world}; }
  explicit PaperBatches(Plain&) {}
  static OwnBar& bar(Plain&) {
    static OwnBar none;
    return none;
  }

  static void take(const World& w, std::size_t i, batch::Disc& disc, Group& group, std::size_t k) {
    const Particles& p = w.particles;
    disc.moves_x = p.displacement[i].x();
    disc.moves_y = p.displacement[i].y();
    disc.turns = disc.turns_again = p.radius[i] * p.rotation[i];
    group.velocity_x[k] = p.velocity[i].x();
    group.velocity_y[k] = p.velocity[i].y();
    group.spin[k] = p.spin[i];
    group.rotation[k] = p.rotation[i];
    group.push[k] = w.dt / p.mass[i];
    group.turn[k] = p.radius[i] * (w.dt / p.inertia[i]);
  }

  static void give_back(World& w, std::size_t i, const batch::Disc& disc, const batch::Load&, const Group& group,
                        std::size_t k) {
    Particles& p = w.particles;
    p.displacement[i] = {disc.moves_x, disc.moves_y};
    p.velocity[i] = {group.velocity_x[k], group.velocity_y[k]};
    p.spin[i] = group.spin[k];
    p.rotation[i] = group.rotation[k];
  }

  static auto numbers(const Spring& spring) {
    if constexpr (rolls)
      return std::array{spring.normal, spring.shear, spring.rolling};
    else
      return std::array{spring.normal, spring.shear};
  }
  static Spring memory(const auto& numbers) {
    if constexpr (rolls)
      return {{numbers[0], numbers[1]}, numbers[2]};
    else
      return {numbers[0], numbers[1]};
  }

  static void add_pair_forces(const World& w, std::span<Pairs> pairs, const batch::Disc* discs, batch::Load* loads) {
    batch::add_tanaka_forces(pairs, discs, loads, w.particle_particle, w.dt);
  }

  static void surface(const World& w, const Surfaces& surfaces, const OwnBar&, SurfaceContact<Spring>& contact,
                      const batch::Disc& disc, const Group& group, batch::Load& load, SurfaceTotals& totals) {
    const std::size_t k = contact.i % batch::width;
    const DiscInMotion motion{{disc.x, disc.y},
                              disc.radius,
                              {disc.moves_x, disc.moves_y},
                              group.rotation[k],
                              {group.velocity_x[k], group.velocity_y[k]},
                              group.spin[k]};
    SurfaceForce f;
    if (!surface_force(TanakaLaw<DefaultReadings>{}, surfaces, w.particle_wall, w.dt, contact, motion, f)) return;
    const Vector2 on_disc = received(f.force, f.normal);
    load.force_x += on_disc.x();
    load.force_y += on_disc.y();
    load.turning += rim_force(f.force, f.lever, surface_rolling_lever);
    load.work += f.work;
    totals.add(surfaces, contact.surface, motion.centre, on_disc);
  }

  static batch::Moved move(const World& w, std::size_t particles, Group* groups, batch::Disc* discs,
                           batch::Load* loads) {
    return batch::move_averaged(particles, groups, discs, loads, w.gravity, w.dt);
  }
};

}  // namespace crossdem
