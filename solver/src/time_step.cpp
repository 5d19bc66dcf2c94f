// What limits the time step: Eq. (32), and the packed bed.

#include <algorithm>
#include <cmath>
#include <limits>

#include "contradictions.hpp"

namespace crossdem {
namespace {

double smallest_mass(const Case& c) {
  return c.disc_mass(*std::min_element(c.particles.diameters.begin(), c.particles.diameters.end()) / 2);
}

}  // namespace

std::vector<std::string> warnings(const Case& resolved) {
  std::vector<std::string> found;
  const auto compare = [&](const std::string& key, double step, double gain, const char* integrator) {
    const double limit = packed_bed_time_step(resolved, gain);
    if (step > limit) {
      found.push_back(key + " = " + short_text(step) + " s is above the packed-bed limit of " + integrator + ", " +
                      short_text(limit) + " s: expect a bed that does not rest");
    }
  };
  // The averaged displacement gains its stability from what the dashpots see.
  const Readings& readings = resolved.scheme.readings;
  const std::string& name = resolved.scheme.name;
  const bool averaged =
      name.ends_with("_averaged") || (name == "paper" && readings.integrator == Integration::averaged_displacement);
  const bool filtered = averaged && readings.dashpot_velocity == DashpotVelocity::averaged_displacement;
  const double gain = filtered ? averaged_displacement_gain : conventional_gain;
  const char* scheme = filtered   ? "the averaged displacement"
                       : averaged ? "the averaged displacement with true velocities"
                                  : "a conventional integrator";
  if (!resolved.placed.empty()) return found;  // no bed
  compare("time.step_s", resolved.time.step, gain, scheme);
  if (resolved.packing.step != resolved.time.step) compare("packing.step_s", resolved.packing.step, gain, scheme);
  for (const auto& [engine, settings] : resolved.engines) {
    const bool is_averaged = engine.ends_with("-averaged");
    if (is_averaged && filtered && settings.step == resolved.time.step) continue;  // said above
    compare("engines." + engine + ".step_s", settings.step,
            is_averaged ? averaged_displacement_gain : conventional_gain,
            is_averaged ? "the averaged displacement" : "a conventional integrator");
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
