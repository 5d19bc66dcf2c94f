// Beyond the paper: joints that carry tension up to a strength T, and springs against rolling, against closed forms.
// Both are off by default.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "laws/tanaka.hpp"
#include "small_case.hpp"

namespace crossdem::test {
namespace {

constexpr double dt = 1e-4;
constexpr double g = 9.80665;

// --- the law, one evaluation at a time: k_n 1000, k_s 250 N/m, eta 0.8, 0.4 N s/m, mu 0.5, T 0.05 N, mu_r 0.1
const ContactParameters joint{1000.0, 250.0, 0.8, 0.4, 0.5, 0.05};
const ContactParameters rolls{1000.0, 250.0, 0.8, 0.4, 0.5, 0.0, 0.1};

ContactForce force(const RelativeDisplacement& u, const ContactParameters& p, RollingContactSpring& spring,
                   const Readings& readings = {}) {
  return TanakaLaw<Readings>{readings}.force(u, p, dt, spring);
}

TEST(Joint, HoldsTensionUpToItsStrengthAndThenForgetsAll) {
  RollingContactSpring spring{{-0.0499, 0.001}};
  EXPECT_NEAR(force({.normal = 0.0, .overlap = -4.99e-5}, joint, spring).normal, -0.0499, 1e-15);
  const ContactForce broken = force({.normal = -2e-7, .overlap = -5.01e-5}, joint, spring);
  EXPECT_EQ(broken.normal, 0.0);
  EXPECT_EQ(broken.shear, 0.0);
  EXPECT_EQ(spring.shear, 0.0);
  EXPECT_FALSE(spring.touching());
}

TEST(Joint, Eq9_TheStrengthShiftsTheSlipCap) {
  for (const double held : {-0.04, 0.0, 0.1}) {
    RollingContactSpring spring{{held, 1.0}};
    EXPECT_NEAR(force({}, joint, spring).shear, 0.5 * (held + 0.05), 1e-15);
    EXPECT_NEAR(spring.shear, 0.5 * (held + 0.05), 1e-15);
  }
}

TEST(Joint, ClippedAttractionStillLeavesItsStrength) {
  RollingContactSpring spring{{-0.03, 0.0}};
  const RelativeDisplacement parting{.damped_normal = -1e-5};  // the dashpot pulls by 0.08 N
  EXPECT_NEAR(force(parting, joint, spring, {.attraction = Attraction::clipped}).normal, -0.05, 1e-15);
}

TEST(Rolling, TheSpringGrowsByTheShearStiffnessAndIsCappedByTheNormalSpring) {
  RollingContactSpring spring{{0.2, 0.0}};
  EXPECT_NEAR(force({.rolling = 1e-5}, rolls, spring).rolling, 0.0025, 1e-15);  // 250 x 1e-5
  EXPECT_NEAR(force({.rolling = 4e-5}, rolls, spring).rolling, 0.0125, 1e-15);
  EXPECT_NEAR(force({.rolling = 1e-4}, rolls, spring).rolling, 0.02, 1e-15);  // 0.1 x 0.2
  EXPECT_NEAR(force({.rolling = -1e-5}, rolls, spring).rolling, 0.0175, 1e-15) << "the spring itself was capped";
}

// --- whole steps

/// [m/s] of parting of two discs after `time`, which touch at the start and are drawn apart by `speed`; by springs
/// alone.
double parting_speed(double strength, double speed, double time) {
  Case c = springs_only();
  c.particle_particle.tensile_strength = strength;
  c.time.step = 1e-7;
  c.container.width = 0.2;
  Particles p = small_disc({0.02, 0.05}, Vector2::Zero());
  p.add(small_radius, small_mass, {0.024 - 1e-12, 0.05}, {speed, 0.0});
  Simulation s(c, p, std::nullopt);
  s.advance(std::lround(time / c.time.step));
  return s.particles().velocity[1].x() - s.particles().velocity[0].x();
}

// T^2 / 2 k_n of the energy m v^2 / 4 of the relative motion. The stronger joint stretches by 3 mm: beyond all that
// lists of neighbours hold in reserve.
TEST(Joint, BreaksWhereItHoldsItsStrengthAndKeepsItsEnergy) {
  const double half_period = std::numbers::pi * std::sqrt(small_mass / 2 / 1000.0);
  for (const double strength : {1e-3, 3.0}) {
    const double escape = strength * std::sqrt(2 / (1000.0 * small_mass));
    EXPECT_NEAR(parting_speed(strength, 0.99 * escape, half_period), -0.99 * escape, 1e-3 * escape) << "swings back";
    for (const double factor : {1.01, 1.5, 4.0})
      EXPECT_NEAR(parting_speed(strength, factor * escape, half_period), escape * std::sqrt(factor * factor - 1),
                  2e-3 * escape);
  }
  EXPECT_EQ(parting_speed(0.0, 0.1, half_period), 0.1) << "no joint";
}

struct Motion {
  double speed, spin;  // [m/s], [rad/s]
};

/// A disc on the floor, sunk in by its weight; as a rule it rolls.
Simulation disc_on_floor(Case c, double rolling_friction, const char* scheme, const Motion& motion) {
  c.scheme.name = scheme;
  c.particle_wall.friction = 0.75;
  c.particle_wall.rolling_friction = rolling_friction;
  const double sunk = small_mass * g / c.particle_wall.normal_stiffness;
  return {c, small_disc({0.02, small_radius - sunk}, {motion.speed, 0.0}, motion.spin), std::nullopt};
}
constexpr Motion rolling{0.02, -0.02 / small_radius};

// 3/2 m v' = -mu_r m g.
TEST(Rolling, ADiscIsSlowedByTwoThirdsOfTheRollingFrictionTimesG) {
  for (const char* scheme : {"paper", "liggghts"}) {
    Simulation s = disc_on_floor(small_case(), 0.05, scheme, rolling);
    s.advance(200);
    const double before = s.particles().velocity[0].x();
    s.advance(200);
    EXPECT_NEAR((before - s.particles().velocity[0].x()) / 0.02, 2.0 / 3.0 * 0.05 * g, 1e-3 * g * 0.05) << scheme;
  }
}

TEST(Rolling, ADiscComesToRestAndRollsOnWithoutIt) {
  const double way = 0.02 * 0.02 / (2 * 2.0 / 3.0 * 0.05 * g);
  for (const char* scheme : {"paper", "liggghts"}) {
    Simulation stops = disc_on_floor(small_case(), 0.05, scheme, rolling);
    Simulation rolls_on = disc_on_floor(small_case(), 0.0, scheme, rolling);
    stops.advance(5000);
    rolls_on.advance(5000);
    EXPECT_LT(kinetic_energy(stops.particles()), 1e-20) << scheme;
    EXPECT_NEAR(stops.particles().position[0].x(), 0.02 + way, 0.02 * way) << scheme;
    EXPECT_NEAR(rolls_on.particles().velocity[0].x(), 0.02, 1e-4) << scheme;
  }
}

// With x the way and q = r phi: m x'' = -k_s (x + q), m q'' / 2 = -k_s (x + q) - k_s q. The slow mode has
// omega^2 = (5 - sqrt(17)) / 2 k_s / m and q = (omega^2 m / k_s - 1) x.
TEST(Rolling, ADiscThatIsNotPushedBeyondTheCapRocks) {
  Case c = springs_only();
  c.gravity = g;
  c.time.step = 1e-7;
  const double share = (5 - std::sqrt(17.0)) / 2;
  const double half_period = std::numbers::pi / std::sqrt(share * 250.0 / small_mass);
  for (const char* scheme : {"paper", "liggghts"}) {
    Simulation s = disc_on_floor(c, 0.05, scheme, {1e-5, (share - 1) * 1e-5 / small_radius});
    s.advance(std::lround(half_period / c.time.step));
    EXPECT_NEAR(s.particles().velocity[0].x(), -1e-5, 1e-8) << scheme;
    EXPECT_NEAR(s.particles().spin[0] * small_radius, (1 - share) * 1e-5, 1e-8) << scheme;
  }
}

/// Two discs of unlike size that roll on one another like gears, pressed together by 0.1 N.
Simulation gears(const char* scheme, double rolling_friction) {
  Case c = weightless();
  c.scheme.name = scheme;
  c.particle_particle.rolling_friction = rolling_friction;
  c.time.step = 1e-7;
  Particles p = small_disc({0.02, 0.05}, Vector2::Zero(), 5.0);
  p.add(large_radius, large_mass, {0.02 + small_radius + large_radius - 1e-4, 0.05}, Vector2::Zero());
  p.spin[1] = -4.0;
  return {c, p, std::nullopt};
}

TEST(Rolling, PartnersReceiveOppositeMoments) {
  for (const char* scheme : {"paper", "liggghts"}) {
    Simulation resisted = gears(scheme, 0.1);
    Simulation free = gears(scheme, 0.0);
    for (Simulation* s : {&resisted, &free}) s->advance(1);
    const auto moment = [&](std::size_t i) {
      return resisted.particles().inertia[i] * (resisted.particles().spin[i] - free.particles().spin[i]) / 1e-7;
    };
    const double radius = small_radius * large_radius / (small_radius + large_radius);
    const double expected = 250 * radius * radius * 9.0 * 1e-7;  // in LIGGGHTS half of two evaluations
    EXPECT_NEAR(moment(0), -expected, 1e-3 * expected) << scheme;
    EXPECT_NEAR(moment(1), expected, 1e-3 * expected) << scheme;
  }
}

// Nothing slips and nothing is damped; what the springs hold is mostly shear and rolling, as the weight keeps the
// overlap.
TEST(Rolling, SpringsKeepWhatTheyAreGiven) {
  Case c = springs_only();
  c.gravity = g;
  c.time.step = 1e-7;
  for (const char* scheme : {"paper", "liggghts"}) {
    Simulation s = disc_on_floor(c, 1e3, scheme, {1e-5, 0.03});
    s.advance(3000);
    const EnergyLedger e = s.energy_ledger();
    EXPECT_GT(e.spring_change, 0.2 * e.kinetic) << scheme;
    EXPECT_NEAR(e.kinetic_change + e.spring_change + e.potential_change, 0.0, 5e-3 * e.spring_change) << scheme;
    EXPECT_NEAR(e.contact_work, e.spring_change, 5e-3 * e.spring_change) << scheme;
  }
}

}  // namespace
}  // namespace crossdem::test
