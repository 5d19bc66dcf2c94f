#include <array>
#include <cmath>
#include <limits>

#include "recorder.hpp"

namespace crossdem {
namespace {

constexpr std::size_t clock = 3;  // step, time, tip of the bar or NaN, before the particles of a frame

std::streamsize bytes_of(std::size_t doubles) { return static_cast<std::streamsize>(doubles * sizeof(double)); }

/// `function(first double, doubles)` for each array of a frame.
template <class AnyParticles, class Function>
void for_arrays(AnyParticles& particles, Function function) {
  static_assert(sizeof(Vector2) == 2 * sizeof(double), "positions are written as pairs of doubles");
  const std::size_t count = particles.position.size();
  function(particles.position.data()->data(), 2 * count);
  function(particles.velocity.data()->data(), 2 * count);
  function(particles.angle.data(), count);
  function(particles.spin.data(), count);
}

}  // namespace

FrameSpool::FrameSpool(const std::filesystem::path& path, std::size_t particles, long frames, const Beginning& kept)
    : path_(path), particles_(particles), frames_(frames), written_(kept) {
  cut_behind(kept, path);
  const auto in_and_out = std::ios::binary | std::ios::in | std::ios::out;
  file_.open(path, in_and_out | (frames > 0 ? std::ios::ate : std::ios::trunc));
  if (!file_) throw FileError(path_, "cannot be written");
}

void FrameSpool::frame(long step, double time, std::optional<double> bar_tip, const Particles& particles) {
  const double tip = bar_tip.value_or(std::numeric_limits<double>::quiet_NaN());
  const std::array<double, clock> now{static_cast<double>(step), time, tip};
  const auto put = [&](const double* values, std::size_t count) {
    const std::string_view bytes(reinterpret_cast<const char*>(values),  // NOLINT(*-reinterpret-cast)
                                 count * sizeof(double));
    file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    written_.add(bytes);
  };
  put(now.data(), now.size());
  for_arrays(particles, put);
  file_.flush();
  if (!file_) throw WriteError(path_, "cannot be written any further; is the disk full?");
  ++frames_;
}

void FrameSpool::copy_to(MotionFile& motion) {
  Particles then;
  then.position.resize(particles_);
  then.velocity.resize(particles_);
  then.angle.resize(particles_);
  then.spin.resize(particles_);
  const auto get = [&](double* values, std::size_t count) {
    file_.read(reinterpret_cast<char*>(values), bytes_of(count));  // NOLINT(*-reinterpret-cast)
  };
  file_.seekg(0);
  for (long frame = 0; frame < frames_; ++frame) {
    std::array<double, clock> at{};
    get(at.data(), at.size());
    for_arrays(then, get);
    if (!file_) throw FileError(path_, "cannot be read");
    const auto [step, time, tip] = at;
    motion.frame(static_cast<long>(step), time, std::isnan(tip) ? std::nullopt : std::optional(tip), then);
  }
}

}  // namespace crossdem
