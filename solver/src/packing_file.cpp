#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "crossdem/packing.hpp"
#include "text_file.hpp"

namespace crossdem {
namespace {

constexpr std::string_view header = "id,x_m,y_m,radius_m,velocity_x_m_s,velocity_y_m_s,angular_velocity_rad_s";
constexpr std::uintmax_t most_bytes = 2'000'000'000;

/// "3,0.1,0.2,0.002,0,0,0" as numbers; false where a field is not a whole finite number of its kind.
bool read_row(std::string_view row, std::size_t& id, std::array<double, 6>& values) {
  const char* at = row.data();
  const char* end = at + row.size();
  auto parsed = std::from_chars(at, end, id);
  for (double& value : values) {
    if (parsed.ec != std::errc{} || parsed.ptr == end || *parsed.ptr != ',') return false;
    parsed = std::from_chars(parsed.ptr + 1, end, value);
    if (!std::isfinite(value)) return false;
  }
  return parsed.ec == std::errc{} && parsed.ptr == end;
}

}  // namespace

void write_packing(const Packing& packing, const std::filesystem::path& folder) {
  LineFile csv(folder / "packing.csv");
  csv.line(std::string(header));
  for (std::size_t i = 0; i < packing.radius.size(); ++i) {
    std::string row = std::to_string(i);
    for (const double value : {packing.position[i].x(), packing.position[i].y(), packing.radius[i],
                               packing.velocity[i].x(), packing.velocity[i].y(), packing.spin[i]})
      row += "," + exact(value);
    csv.line(row);
  }
  const nlohmann::json facts = {{"seed", packing.seed},
                                {"particles", packing.radius.size()},
                                {"bar_tip_m", packing.bar_tip ? nlohmann::json(*packing.bar_tip) : nullptr},
                                {"contacts", packing.contacts},
                                {"kinetic_energy_J", packing.kinetic_energy},
                                {"bed_height_m", packing.bed_height},
                                {"settling_s", packing.settling}};
  LineFile(folder / "packing.json").line(facts.dump(2));
}

Packing read_packing(const std::filesystem::path& csv, const Case& setup) {
  const std::string name = csv.string();
  const auto refuse = [&](const std::string& what) -> CaseError { return CaseError({name + ": " + what}); };

  Packing packing;
  std::istringstream lines(read_text(csv, most_bytes));
  std::string row;
  if (!std::getline(lines, row) || row != header) throw refuse("the first line must be " + std::string(header));
  const std::set<double> diameters(setup.particles.diameters.begin(), setup.particles.diameters.end());
  while (std::getline(lines, row)) {
    const std::size_t expected = packing.radius.size();
    std::size_t id = 0;
    std::array<double, 6> values{};
    const std::string line = "line " + std::to_string(expected + 2) + ": ";
    if (!read_row(row, id, values) || id != expected)
      throw refuse(line + "must be particle " + std::to_string(expected) + " as seven finite numbers");
    const auto [x, y, radius, velocity_x, velocity_y, spin] = values;
    if (!diameters.contains(2 * radius)) throw refuse(line + "no particle of the case has the radius " + exact(radius));
    if (x < 0.0 || x > setup.container.width || y < 0.0) throw refuse(line + "the particle is outside the container");
    packing.position.emplace_back(x, y);
    packing.radius.push_back(radius);
    packing.velocity.emplace_back(velocity_x, velocity_y);
    packing.spin.push_back(spin);
  }
  if (packing.radius.size() != static_cast<std::size_t>(setup.particles.count)) {
    throw refuse("holds " + std::to_string(packing.radius.size()) + " particles, the case " +
                 std::to_string(setup.particles.count));
  }

  const std::filesystem::path beside = std::filesystem::path(csv).replace_filename("packing.json");
  try {
    const nlohmann::json facts = nlohmann::json::parse(read_text(beside, most_bytes));
    for (const char* key : {"seed", "contacts"})
      if (!facts.at(key).is_number_unsigned())
        throw CaseError({beside.string() + ": " + key + " must be a whole number that is not negative"});
    packing.seed = facts.at("seed").get<std::uint64_t>();
    if (setup.bar) packing.bar_tip = facts.at("bar_tip_m").get<double>();
    packing.contacts = facts.at("contacts").get<std::size_t>();
    packing.kinetic_energy = facts.at("kinetic_energy_J").get<double>();
    packing.bed_height = facts.at("bed_height_m").get<double>();
    packing.settling = facts.at("settling_s").get<double>();
  } catch (const nlohmann::json::exception& error) {
    throw CaseError({beside.string() + ": " + error.what()});
  }
  if (packing.bar_tip) {
    check_bar_is_clear(setup, *packing.bar_tip, packing.position);
    check_bar_stays_above_floor(setup, *packing.bar_tip);
  }
  return packing;
}

}  // namespace crossdem
