#pragma once
// The step of the established codes: move, then evaluate the forces at the new positions. Theirs is one evaluation more
// than steps, made before the first.

#include <concepts>

#include "../contacts.hpp"
#include "../world.hpp"

namespace crossdem {

/// What a conventional code does with one contact, one particle, one step; `advance` is false where it evaluates forces
/// without carrying its memories on.
template <class Scheme>
concept ConventionalScheme = requires(Scheme scheme, World& world, bool advance,
                                      Contacts<typename Scheme::PairMemory, typename Scheme::SurfaceMemory> contacts) {
  scheme.move(world);
  scheme.pair(world, contacts.pairs().front(), advance);
  scheme.surface(world, contacts.on_surfaces().front(), advance);
  scheme.after_pairs(world);
  scheme.finish(world);
  scheme.begin_evaluation();
  { scheme.spring_energy() } -> std::same_as<double>;
  { Scheme::first_evaluation_advances } -> std::convertible_to<bool>;
};

template <ConventionalScheme Scheme>
class ConventionalStepper final : public Stepper {
 public:
  ConventionalStepper(const Case& setup, World& world)
      : scheme_(setup, world), contacts_(MemoryOwner::pair, ListSkin(world.particles)) {
    contacts_.rebuild(world.particles, world.surfaces);
    evaluate(world, Scheme::first_evaluation_advances);
    world.contact_work.assign(world.particles.count(), 0.0);  // no time has passed
  }

  void advance(World& world, long steps) override {
    for (long n = 0; n < steps; ++n) {
      scheme_.move(world);
      if (contacts_.outdated(world.particles, world.surfaces)) {
        world.check();
        contacts_.rebuild(world.particles, world.surfaces, world.steps);
      }
      evaluate(world, true);
      scheme_.finish(world);
      ++world.steps;
    }
  }

  [[nodiscard]] double spring_energy(const World&) const override { return scheme_.spring_energy(); }

 private:
  void evaluate(World& world, bool advance) {
    world.clear_loads();
    scheme_.begin_evaluation();
    for (auto& contact : contacts_.pairs()) scheme_.pair(world, contact, advance);
    scheme_.after_pairs(world);
    for (auto& contact : contacts_.on_surfaces()) scheme_.surface(world, contact, advance);
  }

  Scheme scheme_;
  Contacts<typename Scheme::PairMemory, typename Scheme::SurfaceMemory> contacts_;
};

}  // namespace crossdem
