#include "crossdem/case.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>

#include "case_reader.hpp"
#include "case_writer.hpp"

namespace crossdem {
namespace {

constexpr double most_steps = 1e9;               // in an interval: far above any use, far below what a long counts
constexpr double densest_disc_packing = 0.9069;  // pi / sqrt(12)

std::string joined(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += (text.empty() ? "" : "\n") + fault;
  return text;
}

std::string text(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

bool is_multiple(double interval, double step) {
  const double ratio = interval / step;
  return ratio >= 0.5 && ratio <= most_steps && std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio;
}

/// nlohmann::json silently keeps the last of two equal keys; a case must not depend on that.
class DuplicateKeys {
 public:
  bool operator()(int /*depth*/, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::key) {
      open_.back().current = parsed.get<std::string>();
      if (!open_.back().keys.insert(open_.back().current).second) found.push_back(path() + ": the key stands twice");
    }
    if (event == Event::object_end) open_.pop_back();
    return true;
  }
  std::vector<std::string> found;

 private:
  struct Object {
    std::set<std::string> keys;
    std::string current;
  };

  [[nodiscard]] std::string path() const {
    std::string text;
    for (const Object& object : open_) text += (text.empty() ? "" : ".") + object.current;
    return text;
  }

  std::vector<Object> open_;
};

/// What no single key can say: contradictions between keys that were each read without fault.
void check_consistency(const Case& c, schema::Reader& reader) {
  const auto fault = [&](const char* key, const std::string& message) { reader.fault(key, message); };

  const double left = c.bar.centre_x - c.bar.width / 2;
  const double right = c.bar.centre_x + c.bar.width / 2;
  if (c.bar.width >= c.container.width) {
    fault("bar.width_m",
          "a bar of " + text(c.bar.width) + " m does not go into a container of " + text(c.container.width) + " m");
  } else if (left < 0.0 || right > c.container.width) {
    fault("bar.centre_x_m", "the bar reaches from " + text(left) + " to " + text(right) +
                                " m, out of the container of " + text(c.container.width) + " m");
  }

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
      fault("particles.count", "the bed does not fit: it would be at least " + text(least_height) +
                                   " m high in a container of " + text(c.container.height) + " m");
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

  const auto check_interval = [&](const char* key, double interval, double step, const std::string& step_key) {
    if (!is_multiple(interval, step))
      fault(key, text(interval) + " s is not a whole number, up to 1e9, of " + step_key + " = " + text(step) + " s");
  };
  const auto check_limit = [&](const std::string& key, double step) {
    const double limit = eq32_time_step(c);
    if (step > limit && !c.time.allow_above_eq32) {
      reader.fault(key, text(step) + " s is above the limit of Eq. (32), 0.75 sqrt(m/k) = " + text(limit) +
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
  for (const auto& [name, engine] : c.engines) check_step("engines." + name + ".step_s", engine.step);
  check_interval("time.penetration_s", c.time.penetration, c.time.sample_interval, "time.sample_interval_s");
  check_interval("time.penetration_s", c.time.penetration, c.time.frame_interval, "time.frame_interval_s");
  if (c.packing.step != c.time.step) check_limit("packing.step_s", c.packing.step);
  if (c.packing.settling > c.packing.longest_settling)
    fault("packing.settling_s", "is longer than packing.longest_settling_s");
  const double way = c.bar.speed * c.time.penetration;
  if (way >= c.container.height) {
    fault("time.penetration_s",
          "the bar would go " + text(way) + " m deep in a container of " + text(c.container.height) + " m");
  } else if (c.bar.length < way) {
    fault("bar.length_m", "the bar is shorter than its way of " + text(way) + " m: particles would close over it");
  }
}

double smallest_mass(const Case& c) {
  return c.disc_mass(*std::min_element(c.particles.diameters.begin(), c.particles.diameters.end()) / 2);
}

}  // namespace

CaseError::CaseError(std::vector<std::string> faults)
    : std::runtime_error(joined(faults)), faults_(std::move(faults)) {}

double Case::disc_mass(double radius) const {
  return particles.density * std::numbers::pi * radius * radius * container.thickness;
}

Case read_case(std::string_view json) {
  DuplicateKeys duplicates;
  nlohmann::json root;
  try {
    root = nlohmann::json::parse(json, std::ref(duplicates));
  } catch (const nlohmann::json::exception& error) {
    throw CaseError({"not valid JSON: " + std::string(error.what())});
  }
  Case c;
  schema::Reader reader(root);
  reader.whole([&] { schema::root(reader, c); });
  for (const char* engine : {"liggghts", "yade"}) c.engines.try_emplace(engine, EngineSettings{c.time.step / 2});
  if (reader.complete()) check_consistency(c, reader);
  std::vector<std::string> faults = std::move(duplicates.found);
  faults.insert(faults.end(), reader.faults().begin(), reader.faults().end());
  if (!faults.empty()) throw CaseError(std::move(faults));
  return c;
}

std::string canonical_json(const Case& resolved) {
  Case copy = resolved;  // the schema describes members by reference, for readers and writers alike
  nlohmann::json root;
  schema::Writer writer(root);
  schema::root(writer, copy);
  return root.dump();
}

std::vector<std::string> warnings(const Case& resolved) {
  std::vector<std::string> found;
  const auto compare = [&](const std::string& key, double step, double gain, const char* integrator) {
    const double limit = packed_bed_time_step(resolved, gain);
    if (step > limit) {
      found.push_back(key + " = " + text(step) + " s is above the packed-bed limit of " + integrator + ", " +
                      text(limit) + " s: expect a bed that does not rest");
    }
  };
  // The averaged displacement gains its stability from what the dashpots see.
  const bool filtered = resolved.scheme.readings.dashpot_velocity == DashpotVelocity::averaged_displacement;
  const double gain = filtered ? averaged_displacement_gain : conventional_gain;
  const char* scheme = filtered ? "the paper's averaged displacement" : "the paper's scheme with true velocities";
  compare("time.step_s", resolved.time.step, gain, scheme);
  if (resolved.packing.step != resolved.time.step) compare("packing.step_s", resolved.packing.step, gain, scheme);
  for (const auto& [name, engine] : resolved.engines)
    compare("engines." + name + ".step_s", engine.step, conventional_gain, "a conventional integrator");
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
