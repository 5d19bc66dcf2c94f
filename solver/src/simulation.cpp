#include "crossdem/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "archive.hpp"
#include "neighbours.hpp"
#include "scheme.hpp"

namespace crossdem {
namespace {

/// Kinetic energy beyond this multiple of what motion and springs held at the start, and of what weight can give over
/// the height of container and particles, is no physics.
constexpr double explosion_factor = 10.0;
/// The same for the bar's push: no particle gets this many times faster than the bar.
constexpr double explosion_speed = 100.0;

double total_mass(const Particles& particles) {
  double sum = 0.0;
  for (const double mass : particles.mass) sum += mass;
  return sum;
}

double highest(const Particles& particles) {
  double height = 0.0;
  for (const Vector2& position : particles.position) height = std::max(height, position.y());
  return height;
}

double moment_of_mass(const Particles& particles) {
  double sum = 0.0;
  for (std::size_t i = 0; i < particles.count(); ++i) sum += particles.mass[i] * particles.position[i].y();
  return sum;
}

}  // namespace

struct Simulation::State {
  State(World of, std::unique_ptr<Stepper> by) : world(std::move(of)), stepper(std::move(by)) {}
  World world;
  std::unique_ptr<Stepper> stepper;
};

World make_world(const Case& setup, Particles particles, std::optional<double> bar_tip) {
  if (particles.count() == 0) throw std::invalid_argument("a simulation needs particles");
  World w{.particles = std::move(particles),
          .surfaces = {.width = setup.container.width, .bar = {}},
          .particle_particle = setup.particle_particle,
          .particle_wall = setup.particle_wall,
          .gravity = setup.gravity,
          .dt = setup.time.step,
          .loads = {},
          .totals = {},
          .contact_work = {},
          .momentum_ledger = {},
          .energy_ledger = {}};
  w.contact_work.assign(w.particles.count(), 0.0);
  if (bar_tip) w.surfaces.bar.emplace(setup.bar.value(), *bar_tip);
  w.kinetic_limit = std::numeric_limits<double>::infinity();
  w.check();
  return w;
}

Simulation::Simulation(const Case& setup, Particles particles, std::optional<double> bar_tip, std::size_t threads)
    : state_(std::make_unique<State>(make_world(setup, std::move(particles), bar_tip), nullptr)) {
  World& w = state_->world;
  w.threads = threads;
  state_->stepper = make_stepper(setup, w);
  w.kinetic_at_start = kinetic_energy(w.particles);
  w.momentum_at_start = momentum(w.particles);
  w.spring_at_start = state_->stepper->spring_energy(w);
  const double bar_speed = bar_tip ? explosion_speed * setup.bar->speed : 0.0;
  const double height = std::max(setup.container.height, highest(w.particles));
  const double weight_energy = total_mass(w.particles) * w.gravity * height;
  w.kinetic_limit = explosion_factor * (w.kinetic_at_start + w.spring_at_start + weight_energy) +
                    0.5 * total_mass(w.particles) * bar_speed * bar_speed;
  w.moment_of_mass_at_start = moment_of_mass(w.particles);
}

void Simulation::save(std::ostream& to) const {
  OutArchive archive(to);
  archive(state_->world);
  state_->stepper->save(archive);
}

void Simulation::load(std::istream& from) {
  InArchive archive(from);
  archive(state_->world);
  state_->stepper->load(archive);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::advance(long steps) { state_->stepper->advance(state_->world, steps); }

void Simulation::start_bar() {
  if (!state_->world.surfaces.bar) throw std::logic_error("there is no bar to start");
  state_->world.surfaces.bar->start();
}

void Simulation::check() const { state_->world.check(); }
const Particles& Simulation::particles() const { return state_->world.particles; }
std::optional<double> Simulation::bar_tip() const {
  const std::optional<Bar>& bar = state_->world.surfaces.bar;
  return bar ? std::optional(bar->tip()) : std::nullopt;
}
BarForce Simulation::bar_force() const { return state_->world.totals.on_bar; }
Vector2 Simulation::floor_force() const {
  return -state_->world.totals.force[static_cast<std::size_t>(Surface::floor)];
}
long Simulation::steps() const { return state_->world.steps; }

MomentumLedger Simulation::momentum_ledger() const {
  const World& w = state_->world;
  MomentumLedger ledger = w.momentum_ledger;
  const double time = static_cast<double>(w.steps) * w.dt;
  ledger.weight = Vector2(0.0, -total_mass(w.particles) * w.gravity * time);
  ledger.change = momentum(w.particles) - w.momentum_at_start;
  return ledger;
}

EnergyLedger Simulation::energy_ledger() const {
  const World& w = state_->world;
  EnergyLedger ledger = w.energy_ledger;
  ledger.contact_work = std::accumulate(w.contact_work.begin(), w.contact_work.end(), 0.0);
  ledger.kinetic = kinetic_energy(w.particles);
  ledger.spring = state_->stepper->spring_energy(w);
  ledger.kinetic_change = ledger.kinetic - w.kinetic_at_start;
  ledger.spring_change = ledger.spring - w.spring_at_start;
  ledger.potential_change = w.gravity * (moment_of_mass(w.particles) - w.moment_of_mass_at_start);
  return ledger;
}

std::size_t Simulation::contacts() const { return close_pairs(state_->world.particles, 0.0).size(); }

void World::enter_impulses(double share) {
  const auto impulse = [&](Surface surface) -> Vector2 {
    return totals.force[static_cast<std::size_t>(surface)] * (share * dt);
  };
  momentum_ledger.left_wall += impulse(Surface::left);
  momentum_ledger.right_wall += impulse(Surface::right);
  momentum_ledger.floor += impulse(Surface::floor);
  momentum_ledger.bar += impulse(Surface::bar);
  if (surfaces.bar)
    energy_ledger.bar_work +=
        totals.force[static_cast<std::size_t>(Surface::bar)].dot(surfaces.bar->displacement()) * share;
}

void World::check() const {
  const auto fail = [&](const std::string& what) {
    std::ostringstream message;
    message << what << " after " << steps << " steps of " << dt << " s; try a smaller time step";
    throw SimulationError(message.str());
  };
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector2& at = particles.position[i];
    if (!at.allFinite() || !particles.velocity[i].allFinite() || !std::isfinite(particles.spin[i]))
      fail("the motion of particle " + std::to_string(i) + " is not finite");
    if (surfaces.lost(at)) fail("particle " + std::to_string(i) + " went through a wall or into the bar");
  }
  const double kinetic = kinetic_energy(particles);
  if (kinetic > kinetic_limit) {
    std::ostringstream what;
    what << "the kinetic energy exploded to " << kinetic << " J";
    fail(what.str());
  }
}

}  // namespace crossdem
