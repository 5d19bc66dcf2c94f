// Eqs. (13)-(24) and what follows from them: free flight, rolling, bouncing, and the limit of Eq. (32).

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

constexpr double dt = 1e-4;

/// A disc flying free, first displacement zero: d_n = (d_(n-1) + v dt) / 2.
TEST(Motion, Eqs19To24_TheStepDisplacementIsTheMeanOfTheLastOneAndTheNewOne) {
  Case c = case_reading("initial_displacement", "zero");
  c.gravity = 0.0;
  Simulation s(c, small_disc({0.03, 0.05}, {0.1, -0.2}, 4.0), std::nullopt);
  const double after[] = {0.5, 0.75, 0.875};  // of velocity x dt
  double sum = 0.0;
  for (const double share : after) {
    s.advance(1);
    sum += share;
    EXPECT_NEAR(s.particles().displacement[0].x(), share * 1e-5, 1e-19);
    EXPECT_NEAR(s.particles().position[0].x(), 0.03 + sum * 1e-5, 1e-16);
    EXPECT_NEAR(s.particles().position[0].y(), 0.05 - sum * 2e-5, 1e-16);
    EXPECT_NEAR(s.particles().rotation[0], share * 4e-4, 1e-18);
    EXPECT_NEAR(s.particles().angle[0], sum * 4e-4, 1e-17);
  }
}

TEST(Motion, Eq19_ByDefaultTheFirstDisplacementIsVelocityTimesStep) {
  Simulation s(weightless(), small_disc({0.03, 0.05}, {0.1, 0.0}, 4.0), std::nullopt);
  s.advance(10);
  EXPECT_NEAR(s.particles().position[0].x(), 0.0301, 1e-15);
  EXPECT_NEAR(s.particles().angle[0], 4e-3, 1e-16);
}

/// v_n = -g n dt and d_n = (d_(n-1) + v_n dt) / 2 with d_0 = 0 give d_n = -g dt^2 (n - 1 + 2^-n), whose sum is this.
TEST(Motion, Eqs16To23_FreeFallFollowsTheClosedFormOfTheScheme) {
  Simulation s(small_case(), small_disc({0.03, 0.12}, Vector2::Zero()), std::nullopt);
  long n = 0;
  for (const long steps : {1L, 2L, 7L, 990L}) {
    s.advance(steps);
    n += steps;
    const double count = static_cast<double>(n);
    const double fall = 9.80665 * dt * dt * (count * (count - 1) / 2 + 1 - std::pow(0.5, count));
    EXPECT_NEAR(s.particles().position[0].y(), 0.12 - fall, 1e-14) << n << " steps";
    EXPECT_NEAR(s.particles().velocity[0].y(), -9.80665 * count * dt, 1e-13);
  }
}

/// Friction at the floor moves v and r w / 2 by equal amounts, so v + r w / 2 is kept and a disc ends with 2/3 v0.
TEST(Motion, Eq18_ASlidingDiscEndsRollingWithTwoThirdsOfItsSpeed) {
  const double weight_overlap = small_mass * 9.80665 / 1000.0;
  const double v0 = 0.03;
  Simulation s(small_case(), small_disc({0.01, small_radius - weight_overlap}, {v0, 0.0}), std::nullopt);
  s.advance(5000);
  EXPECT_NEAR(s.particles().velocity[0].x(), 0.02, 0.0001);  // a sphere: 5/7 v0 = 0.0214
  EXPECT_NEAR(s.particles().spin[0], -0.02 / small_radius, 0.05) << "to the right is clockwise";
  EXPECT_NEAR(s.particles().velocity[0].x() - small_radius * s.particles().spin[0] / 2, v0, 1e-12);
}

/// Rebound over approach speed of a 5 mm disc that meets the right wall head-on, mean over the phase of the step.
double restitution(Case c, double step) {
  c.time.step = step;
  c.gravity = 0.0;
  double sum = 0.0;
  const int phases = 20;
  for (int k = 0; k < phases; ++k) {
    const double gap = (3.0 + k / static_cast<double>(phases)) * 0.1 * step;  // of the approach at 0.1 m/s
    Particles p;
    p.add(large_radius, large_mass, {0.06 - large_radius - gap, 0.05}, {0.1, 0.0});
    Simulation s(c, p, std::nullopt);
    s.advance(std::lround(5e-3 / step));  // a contact lasts 1.7 ms
    sum -= s.particles().velocity[0].x() / 0.1;
  }
  return sum / phases;
}

/// Growth of an undamped contact in half a period. With x ~ z^-n Eqs. (5), (16), (19), (22) give
/// (1 - z)^2 (2 - z) + a^2 z = 0, a = dt sqrt(k / m); each step multiplies the amplitude by 1 / |z|.
double undamped_growth(double step) {
  const double a2 = step * step * 1000.0 / large_mass;
  std::complex<double> z(1.0, std::sqrt(a2));  // Newton, from the oscillator without averaging
  for (int n = 0; n < 50; ++n) {
    const std::complex<double> value = (1.0 - z) * (1.0 - z) * (2.0 - z) + a2 * z;
    const std::complex<double> slope = -2.0 * (1.0 - z) * (2.0 - z) - (1.0 - z) * (1.0 - z) + a2;
    z -= value / slope;
  }
  return std::pow(1.0 / std::abs(z), std::numbers::pi / std::abs(std::arg(z)));
}

TEST(Motion, Eqs19To22_AnUndampedContactGainsEnergyFromTheAveragedDisplacement) {
  EXPECT_NEAR(restitution(springs_only(), 1e-4), 1.31, 0.005);
  // A contact ends at a whole step, not at half a period: what is left to the closed form is of second order.
  EXPECT_NEAR(restitution(springs_only(), 1e-4), undamped_growth(1e-4), 0.005);
}

TEST(Motion, Eqs19To22_TheGainVanishesWithTheTimeStep) {
  for (const double step : {5e-5, 1e-5, 1e-6})
    EXPECT_NEAR(restitution(springs_only(), step), undamped_growth(step), 0.0005) << step;
  EXPECT_NEAR(restitution(springs_only(), 1e-6), 1.0, 0.003);
}

/// A linear spring and dashpot of damping ratio z parts at zero spring force with e = exp(-pi z / sqrt(1 - z^2)); the
/// paper's eta = sqrt(2 m k) is z = 1 / sqrt(2), so e = exp(-pi).
TEST(Motion, Eqs5And6_ThePapersDampingTakesNearlyAllOfTheSpeed) {
  Case c = small_case();
  c.particle_wall.normal_damping = std::sqrt(2 * large_mass * 1000.0);
  EXPECT_NEAR(restitution(c, 1e-6), std::exp(-std::numbers::pi), 0.0002);
  EXPECT_NEAR(restitution(c, 1e-4), std::exp(-std::numbers::pi), 0.005);
}

/// Eqs. (29)-(32): after the first step in contact, with overlap v dt, kinetic and spring energy against that before.
double energy_ratio_of_first_contact(double a) {
  Case c = weightless();
  c.time.step = a * std::sqrt(small_mass / 1000.0);
  c.particle_wall.normal_damping = std::sqrt(2 * small_mass * 1000.0);
  // Displaced by the left wall's own coordinate, so that the overlap after one free step is v dt but for rounding.
  Simulation s(c, small_disc({small_radius, 0.05}, {-0.1, 0.0}), std::nullopt);
  s.advance(2);
  const EnergyLedger energy = s.energy_ledger();
  return (energy.kinetic + energy.spring) / (0.5 * small_mass * 0.01);
}

TEST(Motion, Eq32_TheEnergyOfAFirstContactGrowsAboveTheRootOfTheCubic) {
  double a = 0.7;  // a^3 + 2 sqrt(2) a^2 + a - 2 sqrt(2) = 0
  const double root2 = std::numbers::sqrt2;
  for (int n = 0; n < 20; ++n) a -= (((a + 2 * root2) * a + 1) * a - 2 * root2) / ((3 * a + 4 * root2) * a + 1);
  EXPECT_NEAR(a, 0.7594, 5e-5);  // the paper prints 0.75
  EXPECT_LT(energy_ratio_of_first_contact(a - 1e-6), 1.0);
  EXPECT_GT(energy_ratio_of_first_contact(a + 1e-6), 1.0);
}

TEST(Motion, Eq32_TheLimitOfTheCaseUsesThePrinted075AndTheSmallestDisc) {
  EXPECT_NEAR(eq32_time_step(small_case()), 3.289e-4, 5e-8);
  Case stiff_walls = small_case();
  stiff_walls.particle_wall.normal_stiffness = 4000.0;
  EXPECT_NEAR(eq32_time_step(stiff_walls), 1.6443e-4, 5e-8);
}

TEST(State, DiscsHaveHalfTheInertiaOfARing) {
  const Particles p = small_disc({0, 0}, {3.0, 4.0}, 100.0);
  EXPECT_NEAR(p.inertia[0], 3.8453094e-10, 1e-16);  // m r^2 / 2
  EXPECT_NEAR(small_case().disc_mass(small_radius), small_mass, 1e-16);
  EXPECT_NEAR(small_case().disc_mass(large_radius), large_mass, 1e-16);
  EXPECT_NEAR(kinetic_energy(p), 0.5 * small_mass * 25.0 + 0.5 * 3.8453094e-10 * 1e4, 1e-12);
  EXPECT_NEAR(momentum(p).y(), small_mass * 4.0, 1e-18);
}

}  // namespace
}  // namespace crossdem::test
