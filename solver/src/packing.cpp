#include "crossdem/packing.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "bar.hpp"
#include "crossdem/simulation.hpp"
#include "neighbours.hpp"
#include "text_file.hpp"

namespace crossdem {
namespace {

constexpr long steps_between_looks = 100;

/// The standard's distributions differ between libraries; this one gives the same bits everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double within(double half_width) {
    return half_width * (2.0 * (static_cast<double>(engine_() >> 11U) * 0x1p-53) - 1.0);
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

 private:
  std::mt19937_64 engine_;
};

/// Radii in random order, their numbers as close to the shares as whole numbers can be.
std::vector<double> shuffled_radii(const ParticleMix& mix, Random& random) {
  std::vector<double> radii;
  double wanted = 0.0;
  for (std::size_t k = 0; k < mix.diameters.size(); ++k) {
    wanted += mix.count * mix.number_shares[k];
    const bool last = k + 1 == mix.diameters.size();
    radii.resize(static_cast<std::size_t>(last ? mix.count : std::lround(wanted)), mix.diameters[k] / 2);
  }
  for (std::size_t k = radii.size(); k > 1; --k) std::swap(radii[k - 1], radii[random.below(k)]);
  return radii;
}

Particles jittered_lattice(const Case& setup, std::uint64_t seed) {
  Random random(seed);
  const std::vector<double> radii = shuffled_radii(setup.particles, random);
  const double largest = *std::max_element(radii.begin(), radii.end());
  const PackingRecipe& recipe = setup.packing;
  const double margin = largest + recipe.jitter;  // of the outer centres from the walls
  const double free_width = setup.container.width - 2 * margin;
  const std::size_t columns = 1 + static_cast<std::size_t>(free_width / recipe.lattice_spacing);
  const double left = margin + 0.5 * (free_width - static_cast<double>(columns - 1) * recipe.lattice_spacing);

  // Numbered column by column, so that neighbours in a bed are neighbours in memory however wide it is; where the top
  // row is not full, its columns are the first.
  const std::size_t low = radii.size() / columns;
  const std::size_t in_high_columns = radii.size() % columns * (low + 1);
  Particles particles;
  particles.reserve(radii.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const bool high = i < in_high_columns;
    const std::size_t column = high ? i / (low + 1) : radii.size() % columns + (i - in_high_columns) / low;
    const std::size_t row = high ? i % (low + 1) : (i - in_high_columns) % low;
    const Vector2 node(left + static_cast<double>(column) * recipe.lattice_spacing,
                       margin + static_cast<double>(row) * recipe.lattice_spacing);
    const double dx = random.within(recipe.jitter);
    const double dy = random.within(recipe.jitter);
    const double vx = random.within(recipe.velocity);
    const double vy = random.within(recipe.velocity);
    particles.add(radii[i], setup.disc_mass(radii[i]), node + Vector2(dx, dy), Vector2(vx, vy));
  }
  return particles;
}

void place_bar(const Case& setup, Packing& packing) {
  if (!setup.bar) return;
  const double touching = touching_height(*setup.bar, packing.radius, packing.position);
  packing.bar_tip = setup.bar->tip > 0.0 ? setup.bar->tip : touching;
  check_bar_is_clear(setup, *packing.bar_tip, packing.position);
  check_bar_stays_above_floor(setup, *packing.bar_tip);
}

/// [m], top of the highest particle.
double height_of(const Packing& packing) {
  double height = 0.0;
  for (std::size_t i = 0; i < packing.radius.size(); ++i)
    height = std::max(height, packing.position[i].y() + packing.radius[i]);
  return height;
}

Packing placed_by_hand(const Case& setup, std::uint64_t seed) {
  Packing packing;
  packing.seed = seed;
  for (const PlacedParticle& particle : setup.placed) {
    packing.radius.push_back(particle.radius);
    packing.position.emplace_back(particle.x, particle.y);
    packing.velocity.emplace_back(particle.velocity_x, particle.velocity_y);
    packing.spin.push_back(particle.angular_velocity);
  }
  place_bar(setup, packing);
  const Particles particles = particles_of(packing, setup);
  packing.contacts = close_pairs(particles, 0.0).size();
  packing.kinetic_energy = kinetic_energy(particles);
  packing.bed_height = height_of(packing);
  return packing;
}

}  // namespace

SchemeChoice settling_scheme(const SchemeChoice& choice) {
  const bool settles = choice.name == "paper" && choice.readings.integrator == Integration::averaged_displacement;
  return settles ? choice : SchemeChoice{.name = "paper", .readings = {}};
}

Packing make_packing(const Case& setup, std::uint64_t seed, std::size_t threads) {
  if (!setup.placed.empty()) return placed_by_hand(setup, seed);
  Case settling = setup;
  settling.time.step = setup.packing.step;
  settling.particle_wall.friction = setup.packing.wall_friction;
  settling.scheme = settling_scheme(setup.scheme);
  Simulation simulation(settling, jittered_lattice(setup, seed), std::nullopt, threads);
  const auto elapsed = [&] { return static_cast<double>(simulation.steps()) * settling.time.step; };
  double energy = 0.0;
  do {
    simulation.advance(steps_between_looks);
    simulation.check();
    energy = kinetic_energy(simulation.particles());
    if (elapsed() > setup.packing.longest_settling) {
      std::ostringstream message;
      message << "the bed of seed " << seed << " did not settle: after " << elapsed()
              << " s its kinetic energy is still " << energy
              << " J, above packing.kinetic_energy_J = " << setup.packing.kinetic_energy
              << "; try a smaller packing.step_s than " << settling.time.step;
      throw SimulationError(message.str());
    }
  } while (elapsed() < setup.packing.settling || energy >= setup.packing.kinetic_energy);

  const Particles& bed = simulation.particles();
  Packing packing{.seed = seed,
                  .radius = bed.radius,
                  .position = bed.position,
                  .velocity = std::vector<Vector2>(bed.count(), Vector2::Zero()),
                  .spin = std::vector<double>(bed.count(), 0.0),
                  .bar_tip = std::nullopt,
                  .contacts = simulation.contacts(),
                  .kinetic_energy = energy,
                  .settling = elapsed()};
  packing.bed_height = height_of(packing);
  if (packing.bed_height > setup.container.height) {
    throw CaseError({"particles.count: the bed does not fit: settled it is " + std::to_string(packing.bed_height) +
                     " m high in a container of " + std::to_string(setup.container.height) + " m"});
  }
  place_bar(setup, packing);
  return packing;
}

void check_bar_stays_above_floor(const Case& setup, double bar_tip) {
  const double way = setup.bar->speed * setup.time.penetration;
  if (!(bar_tip > way)) {
    throw CaseError({"time.penetration_s: the bar starts at " + std::to_string(bar_tip) + " m and goes down by " +
                     std::to_string(way) + " m, through the floor; shorten the penetration"});
  }
}

void check_bar_is_clear(const Case& setup, double bar_tip, const std::vector<Vector2>& position) {
  const Bar bar(*setup.bar, bar_tip);
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (bar.contains(position[i])) {
      throw CaseError({"bar.tip_m: with its bottom face at " + exact(bar_tip) + " m particle " + std::to_string(i) +
                       " lies inside the bar"});
    }
  }
}

double touching_height(const BarGeometry& bar, const std::vector<double>& radius,
                       const std::vector<Vector2>& position) {
  double height = 0.0;
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double beside = std::max(0.0, std::abs(position[i].x() - bar.centre_x) - bar.width / 2);
    if (beside < radius[i])
      height = std::max(height, position[i].y() + std::sqrt(radius[i] * radius[i] - beside * beside));
  }
  return height;
}

Particles particles_of(const Packing& packing, const Case& setup) {
  Particles particles;
  particles.reserve(packing.radius.size());
  for (std::size_t i = 0; i < packing.radius.size(); ++i) {
    particles.add(packing.radius[i], setup.disc_mass(packing.radius[i]), packing.position[i], packing.velocity[i]);
    particles.spin[i] = packing.spin[i];
  }
  return particles;
}

}  // namespace crossdem
