#pragma once
// What LIGGGHTS and YADE have in common in batches: discs with velocities and spins, evaluated after they have moved.

#include "../batch/kernels.hpp"
#include "conventional.hpp"

namespace crossdem {

template <class Scheme>
class ConventionalBatches {
 public:
  using Plain = ConventionalStepper<Scheme>;
  using OwnBar = typename Scheme::OwnBar;
  static constexpr bool moves_first = true;
  static constexpr double share_before = Scheme::share_before;
  static constexpr double share_after = Scheme::share_after;

  static Plain plain(const Case& setup, World& world) { return {setup, world}; }
  explicit ConventionalBatches(Plain& plain) : scheme_(plain.scheme()) {}
  static OwnBar& bar(Plain& plain) { return plain.bar(); }

  static void take_motion(const World& w, std::size_t i, batch::Disc& disc) {
    const Particles& p = w.particles;
    disc.moves_x = p.velocity[i].x();
    disc.moves_y = p.velocity[i].y();
    disc.turns = disc.turns_again = p.spin[i];
  }

  static void give_back_motion(World& w, std::size_t i, const batch::Disc& disc, const batch::Load& load) {
    w.particles.velocity[i] = {disc.moves_x, disc.moves_y};
    w.loads[i] = {.force = {load.force_x, load.force_y}, .moment = load.turning};
  }

  template <class OnSurface, class Group>
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
