// What limits the time step: Eq. (32), and the packed bed.

#include <algorithm>
#include <cmath>
#include <limits>

#include "contradictions.hpp"
#include "crossdem/packing.hpp"

namespace crossdem {
namespace {

double smallest_mass(const Case& c) {
  return c.disc_mass(*std::min_element(c.particles.diameters.begin(), c.particles.diameters.end()) / 2);
}

struct Bound {
  double gain;  // of a pure dashpot, beyond which it grows
  const char* integrator;
};
constexpr Bound averaged{averaged_displacement_gain, "the averaged displacement"};
constexpr Bound conventional{conventional_gain, "a conventional integrator"};

/// The averaged displacement gains its stability from what the dashpots see.
Bound bound_of(const SchemeChoice& scheme) {
  if (scheme.name != "paper") return scheme.name.ends_with("_averaged") ? averaged : conventional;
  if (scheme.readings.integrator != Integration::averaged_displacement) return conventional;
  if (scheme.readings.dashpot_velocity == DashpotVelocity::averaged_displacement) return averaged;
  return {conventional_gain, "the averaged displacement with true velocities"};
}

}  // namespace

std::vector<std::string> warnings(const Case& resolved) {
  std::vector<std::string> found;
  if (!resolved.placed.empty()) return found;  // no bed
  const auto compare = [&](const std::string& key, double step, const Bound& bound) {
    const double limit = packed_bed_time_step(resolved, bound.gain);
    if (step > limit) {
      found.push_back(key + " = " + short_text(step) + " s is above the packed-bed limit of " + bound.integrator +
                      ", " + short_text(limit) + " s: expect a bed that does not rest");
    }
  };
  const Bound own = bound_of(resolved.scheme);
  compare("time.step_s", resolved.time.step, own);
  const Bound settling = bound_of(settling_scheme(resolved.scheme));
  if (resolved.packing.step != resolved.time.step || settling.gain != own.gain)
    compare("packing.step_s", resolved.packing.step, settling);
  for (const auto& [engine, settings] : resolved.engines) {
    const Bound bound = engine.ends_with("-averaged") ? averaged : conventional;
    const bool said = settings.step == resolved.time.step && bound.gain == own.gain;
    if (!said) compare("engines." + engine + ".step_s", settings.step, bound);
  }
  return found;
}

double eq32_time_step(const Case& resolved) {
  const double stiffness =
      std::max(resolved.particle_particle.normal_stiffness, resolved.particle_wall.normal_stiffness);
  return 0.75 * std::sqrt(smallest_mass(resolved) / stiffness);
}

double packed_bed_time_step(const Case& resolved, double gain) {
  const double damping = std::max(resolved.particle_particle.shear_damping, resolved.particle_wall.shear_damping);
  return damping > 0.0 ? gain * smallest_mass(resolved) / (16 * damping) : std::numeric_limits<double>::infinity();
}

}  // namespace crossdem
