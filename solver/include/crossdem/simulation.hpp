#pragma once
// One simulation: particles in a container, with or without the bar, moved step by step by the scheme of the case.

#include <iosfwd>
#include <memory>
#include <optional>
#include <stdexcept>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

/// A run that went wrong while running: what happened, to which particle, when.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Force of the particles on the bar [N], +y up, as evaluated in the latest step.
struct BarForce {
  Vector2 tip = Vector2::Zero();    // contacts at the bottom face and its corners
  Vector2 shaft = Vector2::Zero();  // contacts at the sides
};

/// Impulses that the particles have received since the start [N s]. Their sum is the change of momentum.
struct MomentumLedger {
  Vector2 left_wall = Vector2::Zero();
  Vector2 right_wall = Vector2::Zero();
  Vector2 floor = Vector2::Zero();
  Vector2 bar = Vector2::Zero();
  Vector2 weight = Vector2::Zero();
  Vector2 change = Vector2::Zero();  // of sum m v

  /// Zero but for rounding, whatever the time step; not with the reading "in turn", whose contacts push their two
  /// partners unequally.
  [[nodiscard]] Vector2 residual() const { return change - (left_wall + right_wall + floor + bar + weight); }
};

/// Where energy is and went since the start [J]. With the reading "in turn" each contact counts twice.
struct EnergyLedger {
  double kinetic = 0.0;           // now
  double spring = 0.0;            // now, e_n^2 / 2 k_n + (e_s^2 + e_r^2) / 2 k_s
  double potential_change = 0.0;  // of sum m g y
  double kinetic_change = 0.0;
  double spring_change = 0.0;
  double bar_work = 0.0;      // done by the bar on the particles
  double contact_work = 0.0;  // sum of f_n du_n + f_s du_s + f_r R dphi: what contacts took up

  /// Lost in dashpots, sliding and emptied springs.
  [[nodiscard]] double dissipated() const { return contact_work - spring_change; }
  /// What the integrator itself adds (> 0) or takes; vanishes with the time step.
  [[nodiscard]] double integration() const { return kinetic_change + potential_change + contact_work - bar_work; }
};

class Simulation {
 public:
  /// `particles` with their positions and velocities; `bar_tip`: y of the bar's bottom face [m], none without a bar.
  /// Particles that overlap at the start are old contacts: normal spring k_n x overlap, shear spring zero. The scheme
  /// "liggghts" sets the masses anew, by that code's own formula (the last bit may differ). At most so many `threads`
  /// move the particles, with the same results; for now only by the scheme "paper" with its default readings, and only
  /// where each has thousands of them to move.
  Simulation(const Case& setup, Particles particles, std::optional<double> bar_tip, std::size_t threads = 1);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Makes `steps` steps. Throws SimulationError; the state is then the one that went wrong.
  void advance(long steps);

  /// From the next step on the bar moves.
  void start_bar();

  /// Throws SimulationError on positions that are not finite, on a particle that went through a wall, and on a kinetic
  /// energy beyond anything that weight and bar could have given. Also called whenever neighbours are searched.
  void check() const;

  /// All of its state, for load() of a simulation of the same case, particles and bar, which then goes on as this one
  /// would, to the last bit. In the way of this machine and of this build.
  void save(std::ostream& to) const;
  void load(std::istream& from);

  [[nodiscard]] const Particles& particles() const;
  [[nodiscard]] std::optional<double> bar_tip() const;  // [m], none without a bar
  [[nodiscard]] BarForce bar_force() const;
  [[nodiscard]] Vector2 floor_force()
      const;  // [N] of the particles on the floor, +y up, as evaluated in the latest step
  [[nodiscard]] MomentumLedger momentum_ledger() const;
  [[nodiscard]] EnergyLedger energy_ledger() const;
  [[nodiscard]] long steps() const;

  /// Pairs of particles whose centre distance is below the sum of their radii; walls do not count.
  [[nodiscard]] std::size_t contacts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace crossdem
