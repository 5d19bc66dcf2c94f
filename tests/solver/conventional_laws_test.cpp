// The contact laws of LIGGGHTS and YADE, one evaluation at a time: k_n 1000, k_s 250 N/m, eta 0.774, 0.387 N s/m, mu
// 0.5.

#include <gtest/gtest.h>

#include "laws/liggghts_hooke.hpp"
#include "laws/yade_viscel.hpp"

namespace crossdem::test {
namespace {

constexpr double dt = 1e-4;
const ContactParameters table2{1000.0, 250.0, 0.774, 0.387, 0.5};

/// Disc of 2 mm on a floor below it, 0.1 mm deep, moving with this velocity.
HookeApproach on_floor(const Vector2& velocity, double turning = 0.0) {
  const double distance = 0.0019;
  return {.delta = {0.0, distance}, .inverse = 1 / distance, .overlap = 1e-4, .velocity = velocity, .turning = turning};
}

TEST(LiggghtsHooke, PushesByOverlapAndApproach) {
  Vector2 shear = Vector2::Zero();
  EXPECT_NEAR(liggghts_hooke(on_floor({0.0, -0.1}), table2, dt, false, true, shear).force.y(), 0.1 + 0.0774, 1e-15);
}

TEST(LiggghtsHooke, PullsUnlessForcesAreLimited) {
  Vector2 shear = Vector2::Zero();
  EXPECT_NEAR(liggghts_hooke(on_floor({0.0, 1.0}), table2, dt, false, true, shear).force.y(), 0.1 - 0.774, 1e-15);
  EXPECT_EQ(liggghts_hooke(on_floor({0.0, 1.0}), table2, dt, true, true, shear).force.y(), 0.0);
}

TEST(LiggghtsHooke, SticksWithSpringAndDashpot) {
  Vector2 shear = Vector2::Zero();
  const HookeReaction f = liggghts_hooke(on_floor({0.01, 0.0}), table2, dt, false, true, shear);
  EXPECT_NEAR(shear.x(), 1e-6, 1e-20);
  EXPECT_NEAR(f.force.x(), -(250 * 1e-6 + 0.387 * 0.01), 1e-15);
  EXPECT_NEAR(f.couple, -f.force.x(), 1e-15) << "the normal is (0, 1)";
  EXPECT_NEAR(hooke_spring_energy(table2, 1e-4, 0.002, {shear}), 0.5 * 1000 * 1e-8 + 0.5 * 250 * 1e-12, 1e-20);
  EXPECT_EQ(hooke_spring_energy(table2, -1e-4, 0.002, {shear}), 0.0) << "apart";
}

TEST(LiggghtsHooke, SlipCapsTheForceByTheTotalNormalForceAndShortensTheSpring) {
  Vector2 shear(1e-3, 0.0);
  const HookeReaction f = liggghts_hooke(on_floor({0.0, -0.1}), table2, dt, false, true, shear);
  EXPECT_NEAR(f.force.x(), -0.5 * 0.1774, 1e-15);
  EXPECT_NEAR(shear.x(), 0.5 * 0.1774 / 250, 1e-18);
}

TEST(LiggghtsHooke, CapsByTheAbsoluteForceWhereItPulls) {
  Vector2 shear(1e-1, 0.0);
  EXPECT_NEAR(liggghts_hooke(on_floor({0.0, 1.0}), table2, dt, false, true, shear).force.x(), -0.5 * 0.674, 1e-15);
}

TEST(LiggghtsHooke, WithoutAdvanceTheMemoryStaysAsItIs) {
  Vector2 shear(1e-3, 0.0);
  liggghts_hooke(on_floor({0.01, 0.0}), table2, dt, false, false, shear);
  EXPECT_EQ(shear, Vector2(1e-3, 0.0));
}

TEST(LiggghtsHooke, ADiscThatRollsDoesNotSlide) {
  Vector2 shear = Vector2::Zero();
  // The surface moves by -spin x arm; LIGGGHTS takes the spin over the distance and gives the distance back.
  const double turning = -0.01 / 0.0019;
  EXPECT_NEAR(liggghts_hooke(on_floor({0.01, 0.0}, turning), table2, dt, false, true, shear).force.x(), 0.0, 1e-15);
}

/// A floor (body 1) below a disc (body 2): the force on the disc.
Vector2 yade_floor(double overlap, const Vector2& disc_velocity, ViscElMemory& memory) {
  Vector2 force = Vector2::Zero();
  yade_viscel({0.0, 1.0}, overlap, -disc_velocity, table2, dt, memory, force);
  return force;
}

TEST(YadeViscEl, ClipsAttraction) {
  ViscElMemory memory;
  EXPECT_NEAR(yade_floor(1e-4, {0.0, -0.1}, memory).y(), 0.1774, 1e-15);
  EXPECT_EQ(yade_floor(1e-4, {0.0, 1.0}, memory).y(), 0.0);
}

TEST(YadeViscEl, SticksFromItsFirstEvaluationOn) {
  ViscElMemory memory;
  EXPECT_NEAR(yade_floor(1e-4, {0.01, 0.0}, memory).x(), -(250 * 1e-6 + 0.387 * 0.01), 1e-15);
  EXPECT_NEAR(memory.shear.x(), -250e-6, 1e-18);
}

TEST(YadeViscEl, SlipCapsTheSpringByTheTotalForceAndSwitchesTheDashpotOff) {
  ViscElMemory memory{.shear = {-1.0, 0.0}, .normal = {0.0, 1.0}, .real = true};
  EXPECT_NEAR(yade_floor(1e-4, {0.01, -0.1}, memory).x(), -0.5 * 0.1774, 1e-15);
  EXPECT_NEAR(memory.shear.x(), -0.5 * 0.1774, 1e-15);
}

TEST(YadeViscEl, TurnsTheSpringWithTheContact) {
  ViscElMemory memory{.shear = {0.01, 0.0}, .normal = {std::sin(1e-3), std::cos(1e-3)}, .real = true};
  yade_floor(1e-4, {0.0, 0.0}, memory);  // from 1 mrad to the right of upright to upright: counter-clockwise
  EXPECT_NEAR(memory.shear.y(), 1e-5, 1e-10);
}

TEST(YadeViscEl, PartingForgetsTheSpringAndTouchingDoesNotPart) {
  ViscElMemory memory{.shear = {0.01, 0.0}, .normal = {0.0, 1.0}, .real = true};
  yade_floor(0.0, {0.0, -0.1}, memory);
  EXPECT_TRUE(memory.real);
  yade_floor(-1e-9, {0.0, 0.0}, memory);
  EXPECT_FALSE(memory.real);
  EXPECT_EQ(memory.shear, Vector2(Vector2::Zero()));
}

}  // namespace
}  // namespace crossdem::test
