// Eqs. (1), (2), (10)-(12): sign and size of what both partners of a contact receive. No weight; Table 2's constants.

#include <gtest/gtest.h>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

constexpr double dt = 1e-4;

/// [N], received by particle i in one step that began with velocity `before`.
Vector2 force_on(const Simulation& s, std::size_t i, const Vector2& before) {
  return s.particles().mass[i] * (s.particles().velocity[i] - before) / dt;
}
double moment_on(const Simulation& s, std::size_t i, double before) {
  return s.particles().inertia[i] * (s.particles().spin[i] - before) / dt;
}

void expect_near(const Vector2& found, const Vector2& expected, double tolerance) {
  EXPECT_NEAR(found.x(), expected.x(), tolerance);
  EXPECT_NEAR(found.y(), expected.y(), tolerance);
}

/// 4 mm disc i, 5 mm disc j up right of it at 30 degrees, 0.1 mm overlap.
struct Pair {
  Vector2 velocity_i{0.1, 0.0}, velocity_j{0.0, 0.05};
  double spin_i = 3.0, spin_j = -1.0;
  [[nodiscard]] Particles particles() const {
    const Vector2 at(0.03, 0.05);
    Particles p = small_disc(at, velocity_i, spin_i);
    p.add(large_radius, large_mass, at + 0.0044 * Vector2(0.86602540378443865, 0.5), velocity_j);
    p.spin[1] = spin_j;
    return p;
  }
};

// With u_i = (1e-5, 0), u_j = (0, 5e-6) and phi = 3e-4, -1e-4:
// du_n = 1e-5 cos 30 - 5e-6 sin 30 = 6.160254e-6,
// du_s = -1e-5 sin 30 - 5e-6 cos 30 + 0.002 x 3e-4 - 0.0025 x 1e-4 = -8.980127e-6,
// f_n = (0.1 + 6.160254e-3) + 0.774 x 0.06160254 = 0.1538406203,
// f_s = -2.245032e-3 - 0.387 x 0.08980127 = -0.0369981233.
TEST(Step, Eqs1To11_APairReceivesOppositeForces) {
  const Pair pair;
  Simulation s(weightless(), pair.particles(), std::nullopt);
  s.advance(1);
  const Vector2 expected(-0.1517289470, -0.0448789955);  // -f_n n - f_s t
  expect_near(force_on(s, 0, pair.velocity_i), expected, 1e-9);
  expect_near(force_on(s, 1, pair.velocity_j), -expected, 1e-9);
}

TEST(Step, Eq12_BothPartnersReceiveAMomentOfTheSameSign) {
  const Pair pair;
  Simulation s(weightless(), pair.particles(), std::nullopt);
  s.advance(1);
  EXPECT_NEAR(moment_on(s, 0, pair.spin_i), 7.39962466e-5, 1e-12);  // 0.002 x 0.0369981233
  EXPECT_NEAR(moment_on(s, 1, pair.spin_j), 9.24953083e-5, 1e-12);  // 0.0025 x 0.0369981233
}

TEST(Step, Eq2_DiscsThatRollOnOneAnotherDoNotShear) {
  Pair gears;
  gears.velocity_i = gears.velocity_j = Vector2::Zero();
  gears.spin_i = 5.0;
  gears.spin_j = -4.0;  // r_i w_i + r_j w_j = 0
  Simulation s(weightless(), gears.particles(), std::nullopt);
  s.advance(1);
  EXPECT_NEAR(moment_on(s, 0, 5.0), 0.0, 1e-16);
  EXPECT_NEAR(moment_on(s, 1, -4.0), 0.0, 1e-16);
}

TEST(Step, Eq1_OldContactsStartWithTheirOverlapAndNoShear) {
  Pair pair;
  pair.velocity_i = pair.velocity_j = Vector2::Zero();
  pair.spin_i = pair.spin_j = 0.0;
  Simulation s(weightless(), pair.particles(), std::nullopt);
  s.advance(1);  // 1000 N/m x 0.1 mm along the line of centres, no dashpot force
  expect_near(force_on(s, 1, Vector2::Zero()), Vector2(0.0866025404, 0.05), 1e-9);
  EXPECT_EQ(s.particles().spin[0], 0.0);
}

TEST(Step, DiscsThatOnlyComeCloseDoNotTouch) {
  Particles p = small_disc({0.03, 0.05}, Vector2::Zero());
  p.add(small_radius, small_mass, {0.0340001, 0.05}, Vector2::Zero());
  Simulation s(weightless(), p, std::nullopt);
  s.advance(10);
  EXPECT_EQ(s.particles().velocity[0], Vector2::Zero());
  EXPECT_EQ(s.contacts(), 0U);
}

struct WallSide {
  const char* name;
  Vector2 centre, velocity, force;
};

// Each: 0.1 mm overlap, approach 0.1 m/s, sliding 0.2 m/s against a spin of 10 rad/s. du_n = 1e-5, du_s = -2e-5 + 0.002
// x 1e-3 = -1.8e-5; f_n = 0.11 + 0.0774 = 0.1874; f_s = -0.0045 - 0.387 x 0.18 = -0.07416; moment -0.002 f_s.
class Walls : public testing::TestWithParam<WallSide> {};

TEST_P(Walls, Eqs1To12_ForceAndMomentOfAWall) {
  const WallSide side = GetParam();
  Simulation s(weightless(), small_disc(side.centre, side.velocity, 10.0), 0.1);
  s.advance(1);
  expect_near(force_on(s, 0, side.velocity), side.force, 1e-9);
  EXPECT_NEAR(moment_on(s, 0, 10.0), 1.4832e-4, 1e-12);
}

// The container is 0.06 m wide; the bar's faces are at x = 0.025 and 0.035, its tip at y = 0.1.
INSTANTIATE_TEST_SUITE_P(Sides, Walls,
                         testing::Values(WallSide{"left", {0.0019, 0.05}, {-0.1, 0.2}, {0.1874, -0.07416}},
                                         WallSide{"right", {0.0581, 0.05}, {0.1, -0.2}, {-0.1874, 0.07416}},
                                         WallSide{"floor", {0.01, 0.0019}, {-0.2, -0.1}, {0.07416, 0.1874}},
                                         WallSide{"bar_bottom", {0.03, 0.0981}, {0.2, 0.1}, {-0.07416, -0.1874}},
                                         WallSide{"bar_left_side", {0.0231, 0.13}, {0.1, -0.2}, {-0.1874, 0.07416}},
                                         WallSide{"bar_right_side", {0.0369, 0.13}, {-0.1, 0.2}, {0.1874, -0.07416}}),
                         [](const auto& side) { return side.param.name; });

TEST(Step, WallsHaveTheirOwnParameters) {
  Case c = weightless();
  c.particle_wall = {2000.0, 0.0, 0.0, 0.0, 0.0};
  Simulation wall(c, small_disc({0.0019, 0.05}, Vector2::Zero()), std::nullopt);
  wall.advance(1);
  expect_near(force_on(wall, 0, Vector2::Zero()), {0.2, 0.0}, 1e-9);
  c.particle_particle = {3000.0, 0.0, 0.0, 0.0, 0.0};
  Pair pair;
  pair.velocity_i = pair.velocity_j = Vector2::Zero();
  Simulation discs(c, pair.particles(), std::nullopt);
  discs.advance(1);
  expect_near(force_on(discs, 1, Vector2::Zero()), {0.2598076211, 0.15}, 1e-9);  // 0.3 N along n
}

TEST(Step, AMovingBarApproachesAParticleAtRest) {
  Case c = weightless();
  c.bar->speed = 0.5;  // 5e-5 m a step
  Simulation s(c, small_disc({0.03, 0.0981}, Vector2::Zero()), 0.1);
  s.start_bar();
  s.advance(1);  // e_n = 0.1 + 0.05, dashpot 0.774 x 0.5
  expect_near(force_on(s, 0, Vector2::Zero()), {0.0, -0.537}, 1e-9);
  EXPECT_NEAR(s.bar_tip().value(), 0.09995, 1e-15);
}

TEST(Step, TheBarWaitsUntilItIsStarted) {
  Simulation s(weightless(), small_disc({0.01, 0.05}, Vector2::Zero()), 0.1);
  s.advance(100);
  EXPECT_EQ(s.bar_tip(), 0.1);
  s.start_bar();
  s.advance(1000);
  EXPECT_NEAR(s.bar_tip().value(), 0.099, 1e-15);  // 0.01 m/s for 0.1 s
  EXPECT_THROW(Simulation(weightless(), small_disc({0.01, 0.05}, {0, 0}), std::nullopt).start_bar(), std::logic_error);
}

/// Two 4 mm discs side by side, overlapping by 0.1 mm, at rest.
Particles squeezed() {
  Particles p = small_disc({0.03, 0.05}, Vector2::Zero());
  p.add(small_radius, small_mass, {0.0339, 0.05}, Vector2::Zero());
  return p;
}

TEST(Step, Order_AllForcesThenAllMovesTreatsBothPartnersAlike) {
  Simulation s(weightless(), squeezed(), std::nullopt);
  s.advance(1);
  EXPECT_NEAR(s.particles().velocity[1].x(), 0.0520114193, 1e-10);  // 0.1 N / m x 1e-4 s
  EXPECT_EQ(s.particles().velocity[0], -s.particles().velocity[1]);
}

// The second disc sees the first one already moved by -2.60057e-6 m: e_n = 0.0973994, f_n = e_n - 0.774 x 0.0260057.
TEST(Step, Order_InTurnTheSecondParticleSeesTheFirstOneMoved) {
  Case c = case_reading("update_order", "in_turn");
  c.gravity = 0.0;
  Simulation s(c, squeezed(), std::nullopt);
  s.advance(1);
  EXPECT_NEAR(s.particles().velocity[0].x(), -0.0520114193, 1e-10);
  EXPECT_NEAR(s.particles().velocity[1].x(), 0.0401897489, 1e-10);
}

// Dashpots see (v - w) dt = 1e-5 m, springs the step displacement, here nothing: f_n = 0.1 + 0.0774.
TEST(Step, ReadingTrueVelocityTakesTheVelocityOfEqs16To18) {
  for (const bool at_wall : {false, true}) {
    Case c = small_case({{"scheme", {{"dashpot_velocity", "true_velocity"}, {"initial_displacement", "zero"}}}});
    c.gravity = 0.0;
    Particles p = at_wall ? small_disc({0.0581, 0.05}, {0.1, 0.0}, 10.0) : squeezed();
    if (!at_wall) {
      p.velocity[0].x() = 0.1;
      p.spin[0] = 10.0;
    }
    Simulation s(c, p, std::nullopt);
    s.advance(1);  // f_s = 0.387 x 0.002 x 10 = 0.00774 N, downwards at the right rim
    expect_near(force_on(s, 0, {0.1, 0.0}), {-0.1774, -0.00774}, 1e-9);
    EXPECT_NEAR(moment_on(s, 0, 10.0), -1.548e-5, 1e-12);
  }
}

}  // namespace
}  // namespace crossdem::test
