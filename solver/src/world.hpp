#pragma once
// All that a step reads and writes.

#include "contacts.hpp"
#include "crossdem/simulation.hpp"
#include "integrators.hpp"
#include "surfaces.hpp"

namespace crossdem {

/// What the particles received from one surface during the latest step.
struct SurfaceTotals {
  std::array<Vector2, all_surfaces.size()> force;  // [N]
  BarForce on_bar;
};

struct World {
  Particles particles;
  Surfaces surfaces;
  Contacts contacts;
  ContactParameters particle_particle;
  ContactParameters particle_wall;
  double gravity = 0.0;  // [m/s^2]
  double dt = 0.0;       // [s]
  long steps = 0;

  std::vector<Load> loads;  // of the current step
  SurfaceTotals totals;     // of the current step
  MomentumLedger momentum_ledger;
  EnergyLedger energy_ledger;

  Vector2 momentum_at_start = Vector2::Zero();  // [N s]
  double kinetic_at_start = 0.0;                // [J]
  double spring_at_start = 0.0;                 // [J]
  double moment_of_mass_at_start = 0.0;         // sum m y [kg m]
  double kinetic_limit = 0.0;                   // [J], beyond it the run has exploded

  void (*advance)(World&, const Readings&, long steps) = nullptr;
  Readings readings;

  void check() const;
  [[nodiscard]] double spring_energy() const;
};

}  // namespace crossdem
