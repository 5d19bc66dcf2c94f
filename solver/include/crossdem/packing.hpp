#pragma once
// The settled bed that every engine starts from: all particles at rest, angles zero, no shear springs.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "crossdem/case.hpp"
#include "crossdem/state.hpp"

namespace crossdem {

struct Packing {
  std::uint64_t seed = 0;
  std::vector<double> radius;     // [m]
  std::vector<Vector2> position;  // [m]
  double bar_tip = 0.0;           // [m], y of the bar's bottom face when it just touches the bed
  std::size_t contacts = 0;       // pairs of particles
  double kinetic_energy = 0.0;    // [J], when the bed counted as settled
  double bed_height = 0.0;        // [m], top of the highest particle
  double settling = 0.0;          // [s], simulated
};

/// Lattice, jitter, small random velocities, then settling by the scheme of the case under its own container walls.
/// Equal cases and seeds give equal bits. Throws SimulationError when the bed does not come to rest, CaseError when it
/// is higher than the container or so low that the bar would reach the floor.
Packing make_packing(const Case& setup, std::uint64_t seed);

/// Height at which a bar of this geometry touches the topmost particle under it, corners included [m].
double touching_height(const BarGeometry& bar, const std::vector<double>& radius, const std::vector<Vector2>& position);

/// Throws CaseError where a bar that starts at `bar_tip` [m] would reach the floor within the penetration.
void check_bar_stays_above_floor(const Case& setup, double bar_tip);

/// Writes packing.csv (id, x_m, y_m, radius_m) and packing.json into an existing folder.
void write_packing(const Packing& packing, const std::filesystem::path& folder);

/// Reads what write_packing wrote; `csv` names packing.csv, packing.json is beside it. Checks it against the case:
/// number of particles, positions inside the container, a bar that stays above the floor. Throws CaseError.
Packing read_packing(const std::filesystem::path& csv, const Case& setup);

/// The particles of a packing, at rest.
Particles at_rest(const Packing& packing, const Case& setup);

}  // namespace crossdem
