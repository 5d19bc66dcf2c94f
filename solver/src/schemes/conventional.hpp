#pragma once
// The step of the established codes: move, then evaluate the forces at the new positions. Theirs is one evaluation more
// than steps, made before the first.

#include <concepts>

#include "../contacts.hpp"
#include "../world.hpp"

namespace crossdem {

/// Where a disc's contacts with surfaces are entered.
struct SurfaceAction {
  Load& load;
  double& work;  // [J], of the contacts
  SurfaceTotals& totals;
};

/// What a conventional code does with one contact, one particle, one step; `advance` is false where it evaluates forces
/// without carrying its memories on. Of a step's impulses, `share_before` is that of the forces at its start,
/// `share_after` that of those at its end.
///
/// disc() is how the laws see a disc; set_motion() takes its velocities back.
///
/// OwnBar is the bar as the code has it, beside the one of the world: must_list(d) says whether the code makes its
/// lists of neighbours anew where they matter to it, with particles up to sqrt(d) [m] from where they were then;
/// advance() follows the bar of the world.
template <class Scheme>
concept ConventionalScheme = std::constructible_from<typename Scheme::OwnBar, const Case&, const World&> &&
    requires(Scheme scheme, World& world, bool advance,
             Contacts<typename Scheme::PairMemory, typename Scheme::SurfaceMemory> contacts,
             typename Scheme::OwnBar bar, const DiscInMotion& disc, SurfaceAction action) {
  { bar.must_list(0.0) } -> std::same_as<bool>;
  bar.advance(world.surfaces, world.dt, advance);
  scheme.move(world);
  scheme.pair(world, contacts.pairs().front(), advance);
  scheme.after_pairs(world);
  { scheme.disc(world.particles, 0) } -> std::same_as<DiscInMotion>;
  scheme.set_motion(world.particles, 0, disc.velocity, disc.spin);
  scheme.surface(world, world.surfaces, bar, contacts.on_surfaces().front(), disc, action, advance);
  scheme.finish(world);
  { scheme.spring_energy(world, contacts.pairs().front()) } -> std::same_as<double>;
  { scheme.spring_energy(world, bar, contacts.on_surfaces().front()) } -> std::same_as<double>;
  { Scheme::first_evaluation_advances } -> std::convertible_to<bool>;
  { Scheme::share_before } -> std::convertible_to<double>;
  { Scheme::share_after } -> std::convertible_to<double>;
};

template <ConventionalScheme Any>
class ConventionalStepper final : public Stepper {
 public:
  using Scheme = Any;
  using OwnContacts = Contacts<typename Scheme::PairMemory, typename Scheme::SurfaceMemory>;
  using OwnBar = typename Scheme::OwnBar;

  ConventionalStepper(const Case& setup, World& world)
      : scheme_(setup, world),
        contacts_(MemoryOwner::pair, ListSkin(world.particles)),
        bar_(setup, world),
        marked_at_(world.particles.position) {
    contacts_.rebuild(world.particles, world.surfaces);
    evaluate(world, Scheme::first_evaluation_advances);
    world.contact_work.assign(world.particles.count(), 0.0);  // no time has passed
  }

  void advance(World& w, long steps) override {
    for (long n = 0; n < steps; ++n) {
      w.enter_impulses(Scheme::share_before);
      scheme_.move(w);
      const bool lists = bar_.must_list(farthest_squared(w.particles, marked_at_));
      if (lists) marked_at_ = w.particles.position;
      if (w.surfaces.bar) w.surfaces.bar->advance(w.dt);
      bar_.advance(w.surfaces, w.dt, lists);
      if (contacts_.outdated(w.particles, w.surfaces)) {
        w.check();
        contacts_.rebuild(w.particles, w.surfaces, w.steps);
      }
      evaluate(w, true);
      scheme_.finish(w);
      w.enter_impulses(Scheme::share_after);
      ++w.steps;
    }
  }

  [[nodiscard]] double spring_energy(const World& world) const override {
    double energy = 0.0;
    for (const auto& contact : contacts_.pairs()) energy += scheme_.spring_energy(world, contact);
    for (const auto& contact : contacts_.on_surfaces()) energy += scheme_.spring_energy(world, bar_, contact);
    return energy;
  }

  void save(OutArchive& archive) override { archive(contacts_, bar_, marked_at_, scheme_.motion()); }
  void load(InArchive& archive) override { archive(contacts_, bar_, marked_at_, scheme_.motion()); }

  [[nodiscard]] Scheme& scheme() { return scheme_; }
  [[nodiscard]] OwnContacts& contacts() { return contacts_; }
  [[nodiscard]] OwnBar& bar() { return bar_; }
  /// Where particles were when the code last made its lists anew.
  [[nodiscard]] std::vector<Vector2>& marked_at() { return marked_at_; }

 private:
  void evaluate(World& w, bool advance) {
    w.clear_loads();
    for (auto& contact : contacts_.pairs()) scheme_.pair(w, contact, advance);
    scheme_.after_pairs(w);
    add_in_sums(w, contacts_.on_surfaces(), [&](auto& contact, SurfaceTotals& totals) {
      const std::uint32_t i = contact.i;
      scheme_.surface(w, w.surfaces, bar_, contact, scheme_.disc(w.particles, i),
                      {w.loads[i], w.contact_work[i], totals}, advance);
    });
  }

  Scheme scheme_;
  OwnContacts contacts_;
  OwnBar bar_;
  std::vector<Vector2> marked_at_;
};

}  // namespace crossdem
