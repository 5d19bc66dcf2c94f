#include "crossdem/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scheme.hpp"

namespace crossdem {
namespace {

/// Neighbours within a fifth of the smallest diameter are listed: wide enough that lists last hundreds of steps in a
/// bed that creeps, narrow enough that few pairs are looked at in vain.
constexpr double skin_share = 0.2;

/// Kinetic energy beyond this multiple of what motion and springs held at the start, and of what weight can give over
/// the container's height, is no physics.
constexpr double explosion_factor = 10.0;
/// The same for the bar's push: no particle gets this many times faster than the bar.
constexpr double explosion_speed = 100.0;

double total_mass(const Particles& particles) {
  double sum = 0.0;
  for (const double mass : particles.mass) sum += mass;
  return sum;
}

double moment_of_mass(const Particles& particles) {
  double sum = 0.0;
  for (std::size_t i = 0; i < particles.count(); ++i) sum += particles.mass[i] * particles.position[i].y();
  return sum;
}

}  // namespace

Simulation::Simulation(const Case& setup, Particles particles, std::optional<double> bar_tip) {
  if (particles.count() == 0) throw std::invalid_argument("a simulation needs particles");
  const double smallest = *std::min_element(particles.radius.begin(), particles.radius.end());
  const bool in_turn = setup.scheme.readings.update_order == UpdateOrder::in_turn;
  world_ = std::make_unique<World>(World{
      .particles = std::move(particles),
      .surfaces = {.width = setup.container.width, .bar = {}},
      .contacts = Contacts(in_turn ? SpringOwner::particle : SpringOwner::pair, skin_share * 2 * smallest),
      .particle_particle = setup.particle_particle,
      .particle_wall = setup.particle_wall,
      .gravity = setup.gravity,
      .dt = setup.time.step,
      .loads = {},
      .totals = {},
      .momentum_ledger = {},
      .energy_ledger = {},
      .advance = advance_function(setup.scheme),
      .readings = setup.scheme.readings,
  });
  World& w = *world_;
  Particles& p = w.particles;
  if (bar_tip) w.surfaces.bar.emplace(setup.bar, *bar_tip);
  if (setup.scheme.readings.initial_displacement == InitialDisplacement::velocity) {
    for (std::size_t i = 0; i < p.count(); ++i) {
      p.displacement[i] = p.velocity[i] * w.dt;
      p.rotation[i] = p.spin[i] * w.dt;
    }
  }
  w.kinetic_at_start = kinetic_energy(p);
  w.kinetic_limit = w.kinetic_at_start;
  w.check();
  w.contacts.rebuild(p, w.surfaces);
  for (PairContact& contact : w.contacts.pairs()) {
    const double overlap =
        p.radius[contact.i] + p.radius[contact.j] - (p.position[contact.j] - p.position[contact.i]).norm();
    if (overlap > 0.0) contact.spring = {w.particle_particle.normal_stiffness * overlap, 0.0, true};
  }
  for (SurfaceContact& contact : w.contacts.on_surfaces()) {
    const double overlap =
        p.radius[contact.i] - w.surfaces.nearest_point(contact.surface, p.position[contact.i]).distance;
    if (overlap > 0.0) contact.spring = {w.particle_wall.normal_stiffness * overlap, 0.0, true};
  }
  w.momentum_at_start = momentum(p);
  w.spring_at_start = w.spring_energy();
  const double bar_speed = bar_tip ? explosion_speed * setup.bar.speed : 0.0;
  const double weight_energy = total_mass(p) * w.gravity * setup.container.height;
  w.kinetic_limit = explosion_factor * (w.kinetic_at_start + w.spring_at_start + weight_energy) +
                    0.5 * total_mass(p) * bar_speed * bar_speed;
  w.moment_of_mass_at_start = moment_of_mass(p);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::advance(long steps) { world_->advance(*world_, world_->readings, steps); }

void Simulation::start_bar() {
  if (!world_->surfaces.bar) throw std::logic_error("there is no bar to start");
  world_->surfaces.bar->start();
}

void Simulation::check() const { world_->check(); }
const Particles& Simulation::particles() const { return world_->particles; }
double Simulation::bar_tip() const { return world_->surfaces.bar.value().tip(); }
BarForce Simulation::bar_force() const { return world_->totals.on_bar; }
long Simulation::steps() const { return world_->steps; }

MomentumLedger Simulation::momentum_ledger() const {
  const World& w = *world_;
  MomentumLedger ledger = w.momentum_ledger;
  const double time = static_cast<double>(w.steps) * w.dt;
  ledger.weight = Vector2(0.0, -total_mass(w.particles) * w.gravity * time);
  ledger.change = momentum(w.particles) - w.momentum_at_start;
  return ledger;
}

EnergyLedger Simulation::energy_ledger() const {
  const World& w = *world_;
  EnergyLedger ledger = w.energy_ledger;
  ledger.kinetic = kinetic_energy(w.particles);
  ledger.spring = w.spring_energy();
  ledger.kinetic_change = ledger.kinetic - w.kinetic_at_start;
  ledger.spring_change = ledger.spring - w.spring_at_start;
  ledger.potential_change = w.gravity * (moment_of_mass(w.particles) - w.moment_of_mass_at_start);
  return ledger;
}

std::size_t Simulation::contacts() const { return close_pairs(world_->particles, 0.0).size(); }

double World::spring_energy() const {
  double energy = 0.0;
  const auto add = [&](const ContactSpring& spring, const ContactParameters& parameters) {
    energy += spring.normal * spring.normal / (2 * parameters.normal_stiffness);
    if (parameters.shear_stiffness > 0.0) energy += spring.shear * spring.shear / (2 * parameters.shear_stiffness);
  };
  for (const PairContact& contact : contacts.pairs()) add(contact.spring, particle_particle);
  for (const SurfaceContact& contact : contacts.on_surfaces()) add(contact.spring, particle_wall);
  return energy;
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
