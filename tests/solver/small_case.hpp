#pragma once
// Cases small enough for a test: small_bed.json (200 particles, the paper's Table 2) with what a test changes.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "crossdem/packing.hpp"
#include "crossdem/simulation.hpp"

namespace crossdem::test {

inline constexpr double small_radius = 0.002;              // [m]
inline constexpr double large_radius = 0.0025;             // [m]
inline constexpr double small_mass = 1.9226547039969e-4;   // [kg], 1530 pi 0.002^2 0.01
inline constexpr double large_mass = 3.00414797499524e-4;  // [kg], 1530 pi 0.0025^2 0.01

/// `changes` is a JSON merge patch: objects are merged, null removes a key.
inline nlohmann::json small_json(const nlohmann::json& changes = nlohmann::json::object()) {
  nlohmann::json root = nlohmann::json::parse(std::ifstream(CROSSDEM_SMALL_BED));
  root.merge_patch(changes);
  return root;
}

inline Case small_case(const nlohmann::json& changes = nlohmann::json::object()) {
  return read_case(small_json(changes).dump());
}

/// One reading changed, as {"lost_contact", "keep_zero"}.
inline Case case_reading(const char* key, const char* value) { return small_case({{"scheme", {{key, value}}}}); }

/// Neither weight nor friction nor dashpots: what is left is Eq. (5) and the integrator.
inline Case springs_only() {
  Case c = small_case();
  c.gravity = 0.0;
  for (ContactParameters* p : {&c.particle_particle, &c.particle_wall})
    *p = {.normal_stiffness = 1000.0, .shear_stiffness = 250.0};
  return c;
}

inline Case weightless() {
  Case c = small_case();
  c.gravity = 0.0;
  return c;
}

inline Particles small_disc(const Vector2& at, const Vector2& velocity, double spin = 0.0) {
  Particles particles;
  particles.add(small_radius, small_mass, at, velocity);
  particles.spin.back() = spin;
  return particles;
}

/// A folder that is gone after the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "crossdem-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(text).str();
}

inline std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// What() of the exception of type `Error` that `act` throws; none when it throws nothing.
template <class Error, class Act>
std::optional<std::string> message_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return std::nullopt;
}

}  // namespace crossdem::test
