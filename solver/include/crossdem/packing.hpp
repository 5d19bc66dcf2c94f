#pragma once
// What every engine starts from: a settled bed at rest, or particles placed by hand; angles zero, no shear springs.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

struct Packing {
  std::uint64_t seed = 0;
  std::vector<double> radius;     // [m]
  std::vector<Vector2> position;  // [m]
  std::vector<Vector2> velocity;  // [m/s]
  std::vector<double> spin;       // [rad/s], counter-clockwise
  std::optional<double> bar_tip;  // [m], y of the bar's bottom face at the start; none without a bar
  std::size_t contacts = 0;       // pairs of particles
  double kinetic_energy = 0.0;    // [J], when the bed counted as settled
  double bed_height = 0.0;        // [m], top of the highest particle
  double settling = 0.0;          // [s], simulated
};

/// The particles that the case places by hand, as they stand; or a bed: lattice, jitter, small random velocities, then
/// settling by the scheme of the case under its own container walls.
/// Equal cases and seeds give equal bits. Throws SimulationError when the bed does not come to rest, CaseError when it
/// is higher than the container or so low that the bar would reach the floor.
Packing make_packing(const Case& setup, std::uint64_t seed, std::size_t threads = 1);

/// The scheme by which a bed settles: the paper's with the readings of the case. With a conventional integrator it
/// would not come to rest at the paper's time step, and the other schemes are best compared on the paper's beds.
SchemeChoice settling_scheme(const SchemeChoice& choice);

/// Height at which a bar of this geometry touches the topmost particle under it, corners included [m].
double touching_height(const BarGeometry& bar, const std::vector<double>& radius, const std::vector<Vector2>& position);

/// Throws CaseError where a bar that starts at `bar_tip` [m] would reach the floor within the penetration.
void check_bar_stays_above_floor(const Case& setup, double bar_tip);

/// Throws CaseError where a particle's centre lies inside a bar whose bottom face is at `bar_tip` [m].
void check_bar_is_clear(const Case& setup, double bar_tip, const std::vector<Vector2>& position);

/// Writes packing.csv (id, x_m, y_m, radius_m, velocity_x_m_s, velocity_y_m_s, angular_velocity_rad_s) and packing.json
/// into an existing folder.
void write_packing(const Packing& packing, const std::filesystem::path& folder);

/// Reads what write_packing wrote; `csv` names packing.csv, packing.json is beside it. Checks it against the case:
/// number of particles, positions inside the container, a bar that stays above the floor. Throws CaseError.
Packing read_packing(const std::filesystem::path& csv, const Case& setup);

/// The particles of a packing.
Particles particles_of(const Packing& packing, const Case& setup);

}  // namespace crossdem
