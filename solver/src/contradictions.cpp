#include "contradictions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>

#include "case_schema.hpp"
#include "crossdem/packing.hpp"

namespace crossdem {
namespace {

constexpr double most_steps = 1e9;               // in an interval: far above any use, far below what a long counts
constexpr double densest_disc_packing = 0.9069;  // pi / sqrt(12)

bool is_multiple(double interval, double step) {
  const double ratio = interval / step;
  return ratio >= 0.5 && ratio <= most_steps && std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio;
}

using Fault = std::function<void(const std::string& key, const std::string& message)>;

void bar_faults(const Case& c, const BarGeometry& bar, const Fault& fault) {
  const double left = bar.centre_x - bar.width / 2;
  const double right = bar.centre_x + bar.width / 2;
  if (bar.width >= c.container.width) {
    fault("bar.width_m", "a bar of " + short_text(bar.width) + " m does not go into a container of " +
                             short_text(c.container.width) + " m");
  } else if (left < 0.0 || right > c.container.width) {
    fault("bar.centre_x_m", "the bar reaches from " + short_text(left) + " to " + short_text(right) +
                                " m, out of the container of " + short_text(c.container.width) + " m");
  }
  const double way = bar.speed * c.time.penetration;
  if (way >= c.container.height) {
    fault("time.penetration_s",
          "the bar would go " + short_text(way) + " m deep in a container of " + short_text(c.container.height) + " m");
  } else if (bar.length < way) {
    fault("bar.length_m",
          "the bar is shorter than its way of " + short_text(way) + " m: particles would close over it");
  }
}

void bed_faults(const Case& c, const Fault& fault) {
  const ParticleMix& mix = c.particles;
  if (mix.diameters.size() != mix.number_shares.size()) {
    fault("particles.number_shares", "must have as many entries as particles.diameters_m");
  } else {
    if (std::abs(std::accumulate(mix.number_shares.begin(), mix.number_shares.end(), 0.0) - 1.0) > 1e-9)
      fault("particles.number_shares", "must add up to 1");
    double area = 0.0;
    for (std::size_t k = 0; k < mix.diameters.size(); ++k)
      area += mix.count * mix.number_shares[k] * std::numbers::pi / 4 * mix.diameters[k] * mix.diameters[k];
    const double least_height = area / (densest_disc_packing * c.container.width);
    if (least_height > c.container.height) {
      fault("particles.count", "the bed does not fit: it would be at least " + short_text(least_height) +
                                   " m high in a container of " + short_text(c.container.height) + " m");
    }
  }

  const double largest = *std::max_element(mix.diameters.begin(), mix.diameters.end());
  const double gap = c.packing.lattice_spacing - largest;
  if (gap < 0.0)
    fault("packing.lattice_spacing_m", "is below the largest diameter: particles would overlap");
  else if (c.packing.jitter > gap / 2 * (1 + 1e-9))
    fault("packing.jitter_m", "is more than half the gap of the lattice: particles would overlap");
  if (largest + 2 * c.packing.jitter > c.container.width)
    fault("particles.diameters_m", "the largest particle does not go into the container");
  if (c.packing.settling > c.packing.longest_settling)
    fault("packing.settling_s", "is longer than packing.longest_settling_s");
}

void placed_faults(const Case& c, const Fault& fault) {
  const ParticleMix mix = schema::mix_of(c.placed);
  if (c.particles.count != mix.count || c.particles.diameters != mix.diameters ||
      c.particles.number_shares != mix.number_shares)
    fault("particles", "count, diameters_m and number_shares follow from the [[particle]] tables: leave them out");
  std::vector<Vector2> places;
  std::vector<double> radii;
  std::map<std::pair<double, double>, std::size_t> first_at;
  for (std::size_t k = 0; k < c.placed.size(); ++k) {
    const PlacedParticle& particle = c.placed[k];
    places.emplace_back(particle.x, particle.y);
    radii.push_back(particle.radius);
    const std::string key = "particle[" + std::to_string(k) + "]";
    if (particle.x <= 0.0 || particle.x >= c.container.width || particle.y <= 0.0)
      fault(key, "its centre is not inside the container");
    const auto [same, is_new] = first_at.try_emplace({particle.x, particle.y}, k);
    if (!is_new) fault(key, "its centre is that of particle[" + std::to_string(same->second) + "]");
  }
  if (!c.bar) return;
  const double tip = c.bar->tip > 0.0 ? c.bar->tip : touching_height(*c.bar, radii, places);
  if (tip == 0.0) return fault("bar.tip_m", "no particle is under the bar for it to touch: say where it starts");
  try {
    check_bar_is_clear(c, tip, places);
    check_bar_stays_above_floor(c, tip);
  } catch (const CaseError& error) {
    const std::string& said = error.faults().front();
    const std::size_t colon = said.find(": ");
    fault(said.substr(0, colon), said.substr(colon + 2));
  }
}

void time_faults(const Case& c, const Fault& fault) {
  const auto check_interval = [&](const char* key, double interval, double step, const std::string& step_key) {
    if (!is_multiple(interval, step))
      fault(key, short_text(interval) + " s is not a whole number, up to 1e9, of " + step_key + " = " +
                     short_text(step) + " s");
  };
  const auto check_limit = [&](const std::string& key, double step) {
    const double limit = eq32_time_step(c);
    if (step > limit && !c.time.allow_above_eq32) {
      fault(key, short_text(step) + " s is above the limit of Eq. (32), 0.75 sqrt(m/k) = " + short_text(limit) +
                     " s; if that is on purpose set time.allow_above_eq32 = true");
    }
  };
  const auto check_step = [&](const std::string& key, double step) {
    check_limit(key, step);
    check_interval("time.sample_interval_s", c.time.sample_interval, step, key);
    check_interval("time.frame_interval_s", c.time.frame_interval, step, key);
    if (c.time.rest > 0.0) check_interval("time.rest_s", c.time.rest, step, key);
  };
  check_step("time.step_s", c.time.step);
  for (const auto& [name, engine] : c.engines)
    if (engine.step != c.time.step) check_step("engines." + name + ".step_s", engine.step);
  check_interval("time.penetration_s", c.time.penetration, c.time.sample_interval, "time.sample_interval_s");
  check_interval("time.penetration_s", c.time.penetration, c.time.frame_interval, "time.frame_interval_s");
  if (c.placed.empty() && c.packing.step != c.time.step) check_limit("packing.step_s", c.packing.step);
}

/// YADE puts particle and wall in series, in which 0 stands for a rigid partner.
void series_faults(const Case& c, const Fault& fault) {
  const ContactParameters& pair = c.particle_particle;
  const ContactParameters& wall = c.particle_wall;
  const auto check = [&](const char* key, double of_pair, double of_wall) {
    if (of_wall == 0.0 && of_pair != 0.0)
      fault(std::string("contact.particle_wall.") + key,
            "the scheme \"" + c.scheme.name + "\" has no 0 here beside " + short_text(of_pair) + " of the particles");
  };
  check("shear_stiffness_N_m", pair.shear_stiffness, wall.shear_stiffness);
  check("normal_damping_N_s_m", pair.normal_damping, wall.normal_damping);
  check("shear_damping_N_s_m", pair.shear_damping, wall.shear_damping);
}

void option_faults(const Case& c, const Fault& fault) {
  const auto refuse = [&](const char* key, double value, const std::string& what) {
    if (value > 0.0)
      fault(key,
            "the scheme \"" + c.scheme.name + "\" has no " + what + ": leave it at 0, or take the scheme \"paper\"");
  };
  const double strength = c.particle_particle.tensile_strength;
  if (c.scheme.name != "paper")
    refuse("contact.particle_particle.tensile_strength_N", strength, "joints that carry tension");
  if (c.scheme.name.starts_with("yade")) {
    refuse("contact.particle_particle.rolling_friction", c.particle_particle.rolling_friction, "rolling springs");
    refuse("contact.particle_wall.rolling_friction", c.particle_wall.rolling_friction, "rolling springs");
  }
  if (strength > 0.0 && c.scheme.readings.lost_contact != LostContact::forget)
    fault("scheme.lost_contact",
          "a joint that is broken is forgotten: with contact.particle_particle.tensile_strength_N "
          "take \"forget\"");
}

void scheme_faults(const SchemeChoice& scheme, const Fault& fault) {
  Readings others = scheme.readings;
  if (scheme.name.starts_with("liggghts")) others.attraction = {};  // LIGGGHTS knows both
  if (scheme.name != "paper" && others != Readings{})
    fault("scheme.name",
          "the scheme \"" + scheme.name + "\" has readings of its own: leave those here at their defaults");
  if (scheme.readings.update_order == UpdateOrder::in_turn &&
      scheme.readings.integrator == Integration::velocity_verlet)
    fault("scheme.integrator", "velocity_verlet moves all particles before all forces: it cannot go in_turn");
}

}  // namespace

std::string short_text(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

std::vector<std::string> contradictions(const Case& c) {
  std::vector<std::string> faults;
  const Fault fault = [&](const std::string& key, const std::string& message) {
    faults.push_back(key + ": " + message);
  };
  if (c.bar) bar_faults(c, *c.bar, fault);
  if (c.placed.empty())
    bed_faults(c, fault);
  else
    placed_faults(c, fault);
  time_faults(c, fault);
  scheme_faults(c.scheme, fault);
  option_faults(c, fault);
  if (c.scheme.name.starts_with("yade")) series_faults(c, fault);
  return faults;
}

}  // namespace crossdem
