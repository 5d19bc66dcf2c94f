// The momentum and energy accounts.

#include <gtest/gtest.h>

#include <cmath>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

/// Discs that fall in rows, some fast, on the floor, against the walls and under a fast bar.
Particles rows() {
  Particles p;
  for (int k = 0; k < 40; ++k) {
    const Vector2 node(0.004 + 0.0058 * (k % 10), 0.004 + 0.0058 * (k / 10));
    p.add(k % 3 == 0 ? small_radius : large_radius, k % 3 == 0 ? small_mass : large_mass, node,
          {0.3 * (k % 5 - 2), 0.2 * (k % 7 - 3)});
  }
  return p;
}

void expect_balanced(const Simulation& s) {
  const MomentumLedger m = s.momentum_ledger();
  const double largest = m.weight.norm() + m.floor.norm() + m.bar.norm() + m.left_wall.norm() + m.right_wall.norm();
  EXPECT_LT(m.residual().norm(), 1e-13 * largest);
}

TEST(MomentumLedger, WallsBarAndWeightGiveTheChangeOfMomentumToRounding) {
  Case c = small_case();
  c.bar->speed = 0.2;
  Simulation s(c, rows(), 0.03);
  s.advance(300);
  s.start_bar();
  for (int n = 0; n < 10; ++n) {
    s.advance(100);
    expect_balanced(s);
  }
  const MomentumLedger m = s.momentum_ledger();
  for (const double part : {m.left_wall.x(), -m.right_wall.x(), m.floor.y(), -m.bar.y()})
    EXPECT_GT(part, 1e-6) << "each surface has pushed inwards";
}

TEST(MomentumLedger, BalancesAtAnyTimeStep) {
  for (const double step : {2e-4, 1e-5}) {
    Case c = small_case();
    c.time.step = step;
    Simulation s(c, rows(), 0.03);
    s.advance(500);
    expect_balanced(s);
  }
}

TEST(MomentumLedger, EachSurfaceIsChargedWithItsOwnPush) {
  Case c = springs_only();
  c.time.step = 1e-5;
  Simulation s(c, small_disc({0.0021, 0.05}, {-0.1, 0.0}), 0.1);
  s.advance(500);
  const MomentumLedger m = s.momentum_ledger();
  EXPECT_NEAR(m.left_wall.x(), small_mass * (s.particles().velocity[0].x() + 0.1), 1e-18);
  EXPECT_GT(m.left_wall.x(), 1.9 * small_mass * 0.1);
  EXPECT_EQ(m.right_wall, Vector2::Zero());
  EXPECT_EQ(m.floor, Vector2::Zero());
  EXPECT_EQ(m.bar, Vector2::Zero());
}

TEST(MomentumLedger, InFreeFallThereIsWeightOnly) {
  Simulation s(small_case(), small_disc({0.03, 0.1}, {0.1, 0.0}), std::nullopt);
  s.advance(500);
  EXPECT_NEAR(s.momentum_ledger().weight.y(), -small_mass * 9.80665 * 0.05, 1e-18);
  EXPECT_NEAR(s.momentum_ledger().change.y(), -small_mass * 9.80665 * 0.05, 1e-16);
  EXPECT_EQ(s.momentum_ledger().change.x(), 0.0);
  EXPECT_EQ(s.momentum_ledger().floor, Vector2::Zero());
}

TEST(MomentumLedger, AtRestTheFloorCarriesTheWholeWeight) {
  const Case c = small_case({{"contact", {{"particle_wall", {{"friction", 0.0}}}}}});  // nothing hangs on the walls
  Simulation s(c, rows(), std::nullopt);
  s.advance(20000);
  const double before = s.momentum_ledger().floor.y();
  s.advance(2000);
  const double force = (s.momentum_ledger().floor.y() - before) / 0.2;
  const double weight = (14 * small_mass + 26 * large_mass) * 9.80665;
  EXPECT_NEAR(force, weight, 1e-5 * weight);
}

TEST(EnergyLedger, KnowsTheEnergyOfSpringsAndMotion) {
  Particles p = small_disc({0.03, 0.05}, {0.3, 0.4}, 20.0);
  p.add(small_radius, small_mass, {0.0339, 0.05}, Vector2::Zero());
  p.add(small_radius, small_mass, {0.0018, 0.05}, Vector2::Zero());
  const EnergyLedger e = Simulation(small_case(), p, std::nullopt).energy_ledger();
  EXPECT_NEAR(e.spring, 5e-6 + 20e-6, 1e-16);  // 1000 x (1e-4)^2 / 2 and 1000 x (2e-4)^2 / 2
  EXPECT_NEAR(e.kinetic, 0.5 * small_mass * 0.25 + 0.25 * small_mass * 4e-6 * 400, 1e-16);
  EXPECT_EQ(e.spring_change, 0.0);
  EXPECT_EQ(e.kinetic_change, 0.0);
}

TEST(EnergyLedger, ShearSpringsHoldEnergyToo) {
  Case c = weightless();
  c.particle_wall.shear_damping = 0.0;
  Simulation s(c, small_disc({0.0019, 0.05}, {0.0, 0.1}), std::nullopt);
  s.advance(1);  // e_n = 0.1, e_s = 250 x 1e-5
  EXPECT_NEAR(s.energy_ledger().spring, 5e-6 + 1.25e-8, 1e-16);
}

TEST(EnergyLedger, PotentialEnergyFallsWithTheParticles) {
  Simulation s(small_case(), small_disc({0.03, 0.1}, Vector2::Zero()), std::nullopt);
  s.advance(500);
  const double fall = 0.1 - s.particles().position[0].y();
  EXPECT_NEAR(s.energy_ledger().potential_change, -small_mass * 9.80665 * fall, 1e-16);
}

/// A disc that falls on the floor obliquely and bounces, damped, until it has come to rest.
EnergyLedger after_bounces(double step) {
  Case c = small_case();
  c.time.step = step;
  Simulation s(c, small_disc({0.02, 0.005}, {0.05, 0.0}, 10.0), std::nullopt);
  s.advance(std::lround(0.2 / step));
  return s.energy_ledger();
}

TEST(EnergyLedger, WhatTheIntegratorAddsVanishesLinearlyWithTheTimeStep) {
  const double coarse = after_bounces(2e-5).integration();
  const double fine = after_bounces(1e-5).integration();
  const double finer = after_bounces(5e-6).integration();
  EXPECT_NEAR(coarse / fine, 2.0, 0.3);
  EXPECT_NEAR(fine / finer, 2.0, 0.3);
}

TEST(EnergyLedger, ContactsTakeUpWhatTheFallGives) {
  const EnergyLedger e = after_bounces(2e-6);
  const double given = -e.potential_change - e.kinetic_change;
  EXPECT_NEAR(e.contact_work, given, 0.02 * given);
  EXPECT_NEAR(e.dissipated(), given, 0.02 * given) << "next to nothing stays in the springs";
}

/// Pushed steadily, a disc between bar and floor: what the bar does goes into springs and dashpots.
TEST(EnergyLedger, TheBarWorksOnWhatItPushes) {
  Case c = weightless();
  c.time.step = 1e-6;
  Simulation s(c, small_disc({0.03, 0.002}, Vector2::Zero()), 0.004);
  s.start_bar();
  s.advance(20000);  // 0.2 mm in 20 ms: the disc is squeezed by half of it at either end
  const EnergyLedger e = s.energy_ledger();
  // spring: 2 x 1000 x (1e-4)^2 / 2; dashpots: 2 x 0.774 x (0.005 m/s)^2 x 0.02 s; kinetic energy is a thousandth of it
  EXPECT_NEAR(e.spring_change, 1e-5, 1e-7);
  EXPECT_NEAR(e.dissipated(), 7.74e-7, 2e-8);
  EXPECT_NEAR(e.bar_work, 1.0774e-5, 1e-7);
  EXPECT_NEAR(e.integration(), 0.0, 1e-9);
}

}  // namespace
}  // namespace crossdem::test
