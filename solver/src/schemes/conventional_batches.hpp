#pragma once
// What LIGGGHTS and YADE have in common in batches: discs with velocities and spins, evaluated after they have moved.

#include <concepts>

#include "../batch/kernels.hpp"
#include "conventional.hpp"

namespace crossdem {

template <class Scheme, class OwnGroup>
class ConventionalBatches {
 public:
  using Group = OwnGroup;
  using Plain = ConventionalStepper<Scheme>;
  using OwnBar = typename Scheme::OwnBar;
  static constexpr bool moves_first = true;
  static constexpr double share_before = Scheme::share_before;
  static constexpr double share_after = Scheme::share_after;

  static Plain plain(const Case& setup, World& world) { return {setup, world}; }
  explicit ConventionalBatches(Plain& plain) : scheme_(plain.scheme()) {}
  static OwnBar& bar(Plain& plain) { return plain.bar(); }

  void take(const World& w, std::size_t i, batch::Disc& disc, Group& group, std::size_t k) const {
    const DiscInMotion motion = scheme_.disc(w.particles, i);
    disc.moves_x = motion.velocity.x();
    disc.moves_y = motion.velocity.y();
    disc.turns = disc.turns_again = group.spin[k] = motion.spin;
    if constexpr (std::derived_from<Group, batch::RateBefore>) {
      group.rate_before_x[k] = scheme_.motion().rate_before(i).x();
      group.rate_before_y[k] = scheme_.motion().rate_before(i).y();
      group.turning_before[k] = scheme_.motion().turning_before(i);
    }
  }

  void give_back(World& w, std::size_t i, const batch::Disc& disc, const batch::Load& load, const Group& group,
                 std::size_t k) const {
    if constexpr (std::derived_from<Group, batch::RateBefore>) {
      scheme_.motion().rate_before(i) = {group.rate_before_x[k], group.rate_before_y[k]};
      scheme_.motion().turning_before(i) = group.turning_before[k];
    }
    scheme_.set_motion(w.particles, i, {disc.moves_x, disc.moves_y}, disc.turns);
    w.loads[i] = {.force = {load.force_x, load.force_y}, .moment = load.turning};
  }

  template <class OnSurface>
  void surface(const World& w, const Surfaces& surfaces, const OwnBar& bar, OnSurface& contact, const batch::Disc& disc,
               const Group&, batch::Load& load, SurfaceTotals& totals) const {
    Load received{.force = {load.force_x, load.force_y}, .moment = load.turning};
    const DiscInMotion motion{{disc.x, disc.y}, disc.radius, Vector2::Zero(), 0.0, {disc.moves_x, disc.moves_y},
                              disc.turns};
    scheme_.surface(w, surfaces, bar, contact, motion, {received, load.work, totals}, true);
    load.force_x = received.force.x();
    load.force_y = received.force.y();
    load.turning = received.moment;
  }

 protected:
  [[nodiscard]] const Scheme& scheme() const { return scheme_; }

 private:
  Scheme& scheme_;
};

}  // namespace crossdem
