// The schemes beside the paper's: what each integrator does in closed form, what each conventional law does to one
// contact. That they equal LIGGGHTS and YADE to the last bit is tested against these, in tests/cross_code.

#include <gtest/gtest.h>

#include <array>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

constexpr double dt = 1e-4;
constexpr double g = 9.80665;

Case by_scheme(const char* name, const Case& base = small_case()) {
  Case c = base;
  c.scheme.name = name;
  return c;
}

/// Velocity and height above the start after `steps` of free fall.
std::pair<double, double> fallen(const Case& c, int steps) {
  Simulation s(c, small_disc({0.03, 0.1}, {0, 0}), std::nullopt);
  s.advance(steps);
  return {s.particles().velocity[0].y(), s.particles().position[0].y() - 0.1};
}

TEST(Schemes, LeapFrogFallsBySumsOfWholeSteps) {
  for (const Case& c : {by_scheme("yade"), case_reading("integrator", "leap_frog")}) {
    const auto [velocity, way] = fallen(c, 100);
    EXPECT_NEAR(velocity, -g * 100 * dt, 1e-13);
    EXPECT_NEAR(way, -g * dt * dt * 100 * 101 / 2, 1e-14);
  }
}

TEST(Schemes, VelocityVerletFallsAlongTheParabola) {
  for (const Case& c : {by_scheme("liggghts"), case_reading("integrator", "velocity_verlet")}) {
    const auto [velocity, way] = fallen(c, 100);
    EXPECT_NEAR(velocity, -g * 100 * dt, 1e-13);
    EXPECT_NEAR(way, -g * dt * dt * 100 * 100 / 2, 1e-14);
  }
}

TEST(Schemes, SetVelocitiesAndAMemoryForceAreTheAveragedDisplacementOfEqs19To21) {
  const auto [paper_velocity, paper_way] = fallen(small_case(), 100);
  for (const char* name : {"liggghts_averaged", "yade_averaged"}) {
    const auto [velocity, way] = fallen(by_scheme(name), 100);
    EXPECT_NEAR(velocity, paper_velocity, 1e-12) << name;
    EXPECT_NEAR(way, paper_way, 1e-15) << name;
  }
}

/// Force on one disc in the step that follows its start, from its change of velocity.
Vector2 first_force(const Case& c, const Vector2& at, const Vector2& velocity, double spin = 0.0) {
  Simulation s(c, small_disc(at, velocity, spin), std::nullopt);
  s.advance(1);
  return s.particles().mass[0] * (s.particles().velocity[0] - velocity) / dt;
}

// YADE evaluates before the first step: overlap 1e-4, f_n = 0.1 + 0.774 x 0.1; the spring shears by 0.25 x 1e-4 at
// once: 250 x 2.5e-5 + 0.387 x 0.25 = 0.103 > 0.75 x f_n is not reached.
TEST(Schemes, YadeCountsTheFirstShearInFullAndCapsItByTheTotalForce) {
  Case c = by_scheme("yade", weightless());
  c.particle_wall.friction = 0.75;
  const Vector2 sticking = first_force(c, {0.03, 0.0019}, {0.25, -0.1});
  EXPECT_NEAR(sticking.y(), 0.1774, 1e-9);
  EXPECT_NEAR(sticking.x(), -(250 * 2.5e-5 + 0.387 * 0.25), 1e-9);
  c.particle_wall.friction = 0.01;
  EXPECT_NEAR(first_force(c, {0.03, 0.0019}, {0.25, -0.1}).x(), -0.01 * 0.1774, 1e-12);
}

TEST(Schemes, YadeClipsAttractionAndTheOthersDoNot) {
  const Vector2 at(0.03, 0.0019);
  const Vector2 leaving(0.0, 1.0);  // f_n = 0.1 - 0.774
  EXPECT_NEAR(first_force(by_scheme("yade", weightless()), at, leaving).y(), 0.0, 1e-12);
  EXPECT_LT(first_force(by_scheme("liggghts", weightless()), at, leaving).y(), -0.3);
  EXPECT_LT(first_force(weightless(), at, leaving).y(), -0.3);
}

TEST(Schemes, TheMomentsArmIsTheRadiusInThePaperAndTheContactPointElsewhere) {
  const double overlap = 1e-4;
  const auto arm = [&](const Case& c) {
    Simulation s(c, small_disc({0.03, small_radius - overlap}, {0.01, 0.0}), std::nullopt);
    s.advance(1);
    const double force = s.particles().mass[0] * (s.particles().velocity[0].x() - 0.01);
    return s.particles().inertia[0] * s.particles().spin[0] / force;
  };
  EXPECT_NEAR(arm(weightless()), small_radius, 1e-12);
  EXPECT_NEAR(arm(by_scheme("liggghts", weightless())), small_radius - overlap / 2,
              2e-6);  // sinks in a little within the step
  EXPECT_NEAR(arm(by_scheme("yade", weightless())), small_radius - overlap, 1e-12) << "at a wall YADE's point is on it";
  Case mixed = case_reading("torque_arm", "contact_point");
  mixed.gravity = 0.0;
  EXPECT_NEAR(arm(mixed), small_radius - overlap / 2, 1e-12);
}

TEST(Schemes, ASphereTurnsByTwoFifthsOfTheInertia) {
  Simulation disc(weightless(), small_disc({0.03, 0.0019}, {0.01, 0.0}), std::nullopt);
  Case c = case_reading("inertia", "sphere");
  c.gravity = 0.0;
  Simulation sphere(c, small_disc({0.03, 0.0019}, {0.01, 0.0}), std::nullopt);
  disc.advance(1);
  sphere.advance(1);
  EXPECT_NEAR(sphere.particles().spin[0] / disc.particles().spin[0], 0.5 / 0.4, 1e-12);
}

const std::array every_scheme{"paper", "liggghts", "yade", "liggghts_averaged", "yade_averaged"};

/// Every scheme, and the paper's with velocity Verlet.
std::vector<Case> every_case(const Case& base = small_case()) {
  std::vector<Case> cases;
  for (const char* name : every_scheme) cases.push_back(by_scheme(name, base));
  cases.push_back(base);
  cases.back().scheme.readings.integrator = Integration::velocity_verlet;
  return cases;
}

TEST(Schemes, EveryOneAccountsForMomentumAndWork) {
  for (const Case& c : every_case()) {
    const std::string& name = c.scheme.name;
    Particles p = small_disc({0.0021, 0.0021}, {-0.3, -0.4}, 5.0);  // into the corner of the container
    p.add(small_radius, small_mass, {0.03, 0.0179}, {0.0, 0.0});    // under the bar, overlapping
    Simulation s(c, p, 0.0199);
    EXPECT_EQ(s.energy_ledger().contact_work, 0.0) << name << ": no time has passed";
    s.start_bar();
    s.advance(300);
    const MomentumLedger m = s.momentum_ledger();
    EXPECT_GT(m.floor.y(), 1e-5) << name;
    EXPECT_LT(m.bar.y(), -5e-7) << name;
    EXPECT_LT(m.residual().norm(), 1e-15) << name;
    EXPECT_NEAR(s.energy_ledger().bar_work, -0.01 * m.bar.y(), 1e-15) << name << ": force on the discs x way";
  }
}

TEST(Schemes, WhatAnIntegratorAddsVanishesWithTheTimeStep) {
  const auto added = [](Case c, double step) {
    c.time.step = step;
    Simulation s(c, small_disc({0.03, 0.0025}, {0.1, -0.3}, 20.0), std::nullopt);
    s.advance(std::lround(0.01 / step));
    return std::abs(s.energy_ledger().integration());
  };
  for (const Case& c : every_case(weightless())) EXPECT_LT(added(c, 2.5e-6), 0.4 * added(c, 1e-5)) << c.scheme.name;
}

/// A disc that bounces on the floor, spinning: the laws that the averaged schemes share with a mixture of the paper's.
TEST(Schemes, TheAveragedOnesAreTheMixtureOfTheirLawsAndThePapersIntegrator) {
  Case mixed = small_case({{"scheme",
                            {{"normal_spring", "overlap"},
                             {"slip_cap", "total"},
                             {"first_contact_normal", "spring_only"},
                             {"first_contact_shear", "whole_step"},
                             {"torque_arm", "contact_point"}}}});
  const auto path = [](const Case& c) {
    Simulation s(c, small_disc({0.03, 0.004}, {0.1, -0.2}, 40.0), std::nullopt);
    s.advance(3000);
    return std::pair(s.particles().position[0], s.particles().angle[0]);
  };
  const auto [place, angle] = path(mixed);
  const auto [place_in_liggghts, angle_in_liggghts] = path(by_scheme("liggghts_averaged"));
  EXPECT_LT((place - place_in_liggghts).norm(), 1e-12);
  EXPECT_NEAR(angle, angle_in_liggghts, 1e-9);
}

TEST(Schemes, ADiscNearTheBarsCornerFeelsSideAndCornerAtOnceInLiggghtsOnly) {
  // 1.9 mm beside the bar; at 0.3 mm above its tip the corner is 1.92 mm away.
  const auto push = [&](const char* name, double height) {
    const Case c = by_scheme(name, weightless());
    const double right = c.bar->centre_x + c.bar->width / 2;
    Simulation s(c, small_disc({right + 0.0019, 0.05 + height}, {0, 0}), 0.05);
    s.advance(1);
    return s.particles().velocity[0].x();
  };
  EXPECT_EQ(push("yade", 0.0003), push("yade", 0.003));
  EXPECT_GT(push("liggghts", 0.0003), 1.5 * push("liggghts", 0.003));
}

}  // namespace
}  // namespace crossdem::test
