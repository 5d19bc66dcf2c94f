#pragma once
// All that a step reads and writes, but for the memory of contacts, and what moves it.

#include "archive.hpp"
#include "crossdem/simulation.hpp"
#include "integrators.hpp"
#include "surfaces.hpp"

namespace crossdem {

/// What surfaces receive is summed up for so many particles at a time, and then over these sums: the result does not
/// depend on how many threads move the particles.
inline constexpr std::size_t particles_in_sum = 1024;

/// What the particles received from the surfaces at the latest evaluation of forces.
struct SurfaceTotals {
  std::array<Vector2, all_surfaces.size()> force{Vector2::Zero(), Vector2::Zero(), Vector2::Zero(),
                                                 Vector2::Zero()};  // [N]
  BarForce on_bar;

  void add(const Surfaces& surfaces, Surface surface, const Vector2& centre, const Vector2& received) {
    force[static_cast<std::size_t>(surface)] += received;
    if (surface == Surface::bar) (surfaces.bar->touches_tip(centre) ? on_bar.tip : on_bar.shaft) -= received;
  }
  void clear() { *this = {}; }
  SurfaceTotals& operator+=(const SurfaceTotals& other) {
    for (std::size_t k = 0; k < force.size(); ++k) force[k] += other.force[k];
    on_bar.tip += other.on_bar.tip;
    on_bar.shaft += other.on_bar.shaft;
    return *this;
  }
};

template <class Archive>
void serialize(Archive& archive, SurfaceTotals& totals) {
  archive(totals.force, totals.on_bar);
}

struct World {
  Particles particles;
  Surfaces surfaces;
  ContactParameters particle_particle;
  ContactParameters particle_wall;
  double gravity = 0.0;  // [m/s^2]
  double dt = 0.0;       // [s]
  long steps = 0;

  std::vector<Load> loads;  // by contacts, at the latest evaluation
  SurfaceTotals totals;     // at the latest evaluation
  // [J], since the start, the work of the contacts that list a particle first: summed particle by particle, so that the
  // sum does not depend on how many of them are evaluated at a time.
  std::vector<double> contact_work;
  MomentumLedger momentum_ledger;
  EnergyLedger energy_ledger;
  std::size_t threads = 1;  // that may move the particles, at most

  Vector2 momentum_at_start = Vector2::Zero();  // [N s]
  double kinetic_at_start = 0.0;                // [J]
  double spring_at_start = 0.0;                 // [J]
  double moment_of_mass_at_start = 0.0;         // sum m y [kg m]
  double kinetic_limit = 0.0;                   // [J], beyond it the run has exploded

  /// Forgets the loads and totals of the last evaluation.
  void clear_loads() {
    loads.assign(particles.count(), {});
    totals.clear();
  }

  /// Enters into the ledgers that the latest totals act for this `share` of a step and of the bar's last displacement.
  void enter_impulses(double share);

  /// Throws SimulationError, see Simulation::check.
  void check() const;
};

/// What changes in steps, and what was at the start.
template <class Archive>
void serialize(Archive& archive, World& w) {
  archive(w.particles, w.steps, w.loads, w.totals, w.contact_work, w.momentum_ledger, w.energy_ledger,
          w.momentum_at_start, w.kinetic_at_start, w.spring_at_start, w.moment_of_mass_at_start, w.kinetic_limit);
  if (w.surfaces.bar) archive(*w.surfaces.bar);
}

/// load(contact, totals) for every contact with a surface, in order, each run of particles_in_sum with totals of its
/// own.
template <class OnSurfaces, class LoadOf>
void add_in_sums(World& world, OnSurfaces& on_surfaces, LoadOf load) {
  for (auto contact = on_surfaces.begin(); contact != on_surfaces.end();) {
    SurfaceTotals of_run;
    const std::size_t run = contact->i / particles_in_sum;
    for (; contact != on_surfaces.end() && contact->i / particles_in_sum == run; ++contact) load(*contact, of_run);
    world.totals += of_run;
  }
}

/// The world of a case before its first step; as for Simulation. Throws SimulationError.
World make_world(const Case& setup, Particles particles, std::optional<double> bar_tip);

/// Moves a world by its scheme, with the scheme's memory of contacts.
class Stepper {
 public:
  Stepper() = default;
  virtual ~Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  virtual void advance(World& world, long steps) = 0;
  /// [J] in the springs of all contacts.
  [[nodiscard]] virtual double spring_energy(const World& world) const = 0;

  /// All that it remembers, and back.
  virtual void save(OutArchive& archive) = 0;
  virtual void load(InArchive& archive) = 0;
};

}  // namespace crossdem
