// Eqs. (3)-(9): every branch and every reading, against numbers worked out by hand with k_n = 1000 N/m, k_s = 250 N/m,
// eta_n = 0.8 N s/m, eta_s = 0.4 N s/m, mu = 0.5, dt = 1e-4 s. Lengths in m, forces in N.

#include <gtest/gtest.h>

#include <random>

#include "laws/tanaka.hpp"

namespace crossdem {
namespace {

constexpr double dt = 1e-4;
constexpr ContactParameters parameters{1000.0, 250.0, 0.8, 0.4, 0.5};
constexpr double tolerance = 1e-15;  // [N], some roundings of numbers below 1

/// Averaged displacements: springs and dashpots see the same.
RelativeDisplacement moved(double normal, double shear, double overlap) {
  return {normal, shear, overlap, normal, shear};
}

ContactForce force(const RelativeDisplacement& u, ContactSpring& spring, const Readings& readings = {}) {
  return TanakaLaw<Readings>{readings}.force(u, parameters, dt, spring);
}

ContactForce first_force(const RelativeDisplacement& u, const Readings& readings = {}) {
  ContactSpring spring;
  return force(u, spring, readings);
}

ContactSpring held(double normal, double shear = 0.0) { return {normal, shear}; }

TEST(TanakaLaw, Eq3_FirstContactCountsTheOverlapOnlyForSpringAndDashpot) {
  ContactSpring spring;
  const ContactForce f = force(moved(5e-5, 0.0, 2e-5), spring);
  EXPECT_NEAR(spring.normal, 0.02, tolerance);  // 1000 x 2e-5
  EXPECT_NEAR(f.normal, 0.18, tolerance);       // + 0.8 x 2e-5 / 1e-4
  EXPECT_TRUE(spring.touching());
}

TEST(TanakaLaw, Eq3_ReadingSpringOnlyLetsTheDashpotSeeTheWholeStep) {
  ContactSpring spring;
  const ContactForce f =
      force(moved(5e-5, 1e-5, 2e-5), spring, {.first_contact_normal = FirstContactNormal::spring_only});
  EXPECT_NEAR(spring.normal, 0.02, tolerance);
  EXPECT_NEAR(f.normal, 0.42, tolerance);  // 0.02 + 0.8 x 5e-5 / 1e-4
  EXPECT_NEAR(f.shear, 0.017, tolerance);  // shear keeps Eq. (4)
}

TEST(TanakaLaw, Eq4_FirstContactCountsTheShearOfTheShareInContact) {
  ContactSpring spring;
  const ContactForce f = force(moved(5e-5, 1e-5, 2e-5), spring);  // share 0.4
  EXPECT_NEAR(spring.shear, 0.001, tolerance);                    // 250 x 4e-6
  EXPECT_NEAR(f.shear, 0.017, tolerance);                         // + 0.4 x 4e-6 / 1e-4
}

TEST(TanakaLaw, Eq4_TheShareIsAtMostOne) {
  EXPECT_NEAR(first_force(moved(1e-5, 1e-5, 2e-5)).shear, 0.0425, tolerance);  // 250 x 1e-5 + 0.4 x 0.1, not twice it
}

TEST(TanakaLaw, Eq4_TheShareIsZeroWhenTheContactBeginsWithoutApproach) {
  for (const double normal : {-1e-5, 0.0}) {
    const ContactForce f = first_force(moved(normal, 1e-5, 2e-5));
    EXPECT_EQ(f.shear, 0.0);
    EXPECT_NEAR(f.normal, 0.18, tolerance) << "the overlap counts all the same";
  }
}

TEST(TanakaLaw, Eq4_ReadingRawShareTakesTheRatioAsPrinted) {
  const Readings raw{.first_contact_shear = FirstContactShear::raw_share};
  EXPECT_NEAR(first_force(moved(5e-5, 1e-5, 2e-5), raw).shear, 0.017, tolerance);    // ratio 0.4
  EXPECT_NEAR(first_force(moved(1e-5, 1e-5, 2e-5), raw).shear, 0.085, tolerance);    // ratio 2
  EXPECT_NEAR(first_force(moved(-1e-5, 1e-5, 2e-5), raw).shear, -0.085, tolerance);  // ratio -2
  EXPECT_EQ(first_force(moved(0.0, 1e-5, 2e-5), raw).shear, 0.0);
}

TEST(TanakaLaw, Eq5to7_LaterStepsAddToTheSprings) {
  ContactSpring spring = held(0.02, 0.001);
  const ContactForce f = force(moved(1e-5, 2e-5, 7e-5), spring);  // the overlap is not looked at again
  EXPECT_NEAR(spring.normal, 0.03, tolerance);
  EXPECT_NEAR(f.normal, 0.11, tolerance);  // 0.03 + 0.8 x 0.1
  EXPECT_NEAR(spring.shear, 0.006, tolerance);
  EXPECT_NEAR(f.shear, 0.086, tolerance);  // 0.006 + 0.4 x 0.2
}

TEST(TanakaLaw, Eq5_ReadingOverlapTakesTheSpringFromTheOverlap) {
  ContactSpring spring = held(0.5);
  const ContactForce f = force(moved(1e-5, 0.0, 3e-5), spring, {.normal_spring = NormalSpring::overlap});
  EXPECT_NEAR(spring.normal, 0.03, tolerance);
  EXPECT_NEAR(f.normal, 0.11, tolerance);
}

TEST(TanakaLaw, Eq6_TheDashpotMayPullWhileTheSpringPushes) {
  ContactSpring spring = held(0.02);
  EXPECT_NEAR(force(moved(-1e-5, 0.0, 1e-5), spring).normal, -0.07, tolerance);  // 0.01 - 0.08
  EXPECT_NEAR(spring.normal, 0.01, tolerance);
}

TEST(TanakaLaw, Eq6_ReadingClippedLetsNoContactPull) {
  ContactSpring spring = held(0.02, 0.001);
  const ContactForce f = force(moved(-1e-5, 0.0, 1e-5), spring, {.attraction = Attraction::clipped});
  EXPECT_EQ(f.normal, 0.0);
  EXPECT_NEAR(f.shear, 0.001, tolerance);
  EXPECT_NEAR(spring.normal, 0.01, tolerance);
}

TEST(TanakaLaw, Eqs6And7_ReadingTrueVelocityFeedsTheDashpotsAlone) {
  const Readings velocity{.dashpot_velocity = DashpotVelocity::true_velocity};
  ContactSpring spring;
  ContactForce f = force({5e-5, 1e-5, 2e-5, 7e-5, 3e-5}, spring, velocity);
  EXPECT_NEAR(f.normal, 0.58, tolerance);       // 0.02 + 0.8 x 0.7, no share
  EXPECT_NEAR(f.shear, 0.121, tolerance);       // 0.001 + 0.4 x 0.3, no share
  EXPECT_NEAR(spring.shear, 0.001, tolerance);  // the spring keeps Eq. (4)
  f = force({1e-5, 0.0, 3e-5, -2e-5, 1e-5}, spring, velocity);
  EXPECT_NEAR(f.normal, -0.13, tolerance);  // 0.03 - 0.16
  EXPECT_NEAR(f.shear, 0.041, tolerance);   // 0.001 + 0.04
}

TEST(TanakaLaw, Eq8_NoTensionInTheSpringAndTheContactIsForgotten) {
  ContactSpring spring = held(0.02, 0.003);
  const ContactForce f = force(moved(-3e-5, 1e-6, 1e-5), spring);
  EXPECT_EQ(f.normal, 0.0);
  EXPECT_EQ(f.shear, 0.0);
  EXPECT_EQ(spring.shear, 0.0);
  EXPECT_FALSE(spring.touching());
  force(moved(2e-5, 0.0, 5e-5), spring);
  EXPECT_NEAR(spring.normal, 0.05, tolerance) << "still overlapping: a first contact again, Eq. (3)";
}

TEST(TanakaLaw, Eq8_ReadingKeepZeroGoesOnFromAnEmptySpring) {
  const Readings keep{.lost_contact = LostContact::keep_zero};
  ContactSpring spring = held(0.02, 0.003);
  EXPECT_EQ(force(moved(-3e-5, 0.0, 1e-5), spring, keep).normal, 0.0);
  EXPECT_EQ(spring.shear, 0.0);
  force(moved(2e-5, 0.0, 5e-5), spring, keep);
  EXPECT_NEAR(spring.normal, 0.02, tolerance);
}

TEST(TanakaLaw, Eq8_ReadingKeepNegativeMustFirstMakeUpForTheTension) {
  const Readings keep{.lost_contact = LostContact::keep_negative};
  ContactSpring spring = held(0.02, 0.003);
  EXPECT_EQ(force(moved(-3e-5, 0.0, 1e-5), spring, keep).normal, 0.0);
  EXPECT_EQ(spring.shear, 0.0);
  EXPECT_EQ(force(moved(5e-6, 0.0, 1e-5), spring, keep).normal, 0.0) << "e_n is still -0.005 N";
  force(moved(2e-5, 0.0, 5e-5), spring, keep);
  EXPECT_NEAR(spring.normal, 0.015, tolerance);
}

TEST(TanakaLaw, Eq8_ASpringOfExactlyZeroIsNotTension) {
  ContactSpring spring = held(1.0);
  EXPECT_EQ(force(moved(-1e-3, 0.0, 1e-5), spring).normal, -8.0);  // the dashpot: 0.8 x -1e-3 / 1e-4
  EXPECT_TRUE(spring.touching());
}

TEST(TanakaLaw, Eq9_SlipCapsTheSpringAndSwitchesTheDashpotOff) {
  ContactSpring spring = held(0.02, 0.009);
  EXPECT_EQ(force(moved(0.0, 1e-5, 1e-5), spring).shear, 0.01);  // e_s would be 0.0115; mu e_n = 0.01
  EXPECT_EQ(spring.shear, 0.01);
}

TEST(TanakaLaw, Eq9_SlipKeepsTheSignOfTheSpring) {
  ContactSpring spring = held(0.02, -0.009);
  EXPECT_EQ(force(moved(0.0, -1e-5, 1e-5), spring).shear, -0.01);
  EXPECT_EQ(spring.shear, -0.01);
}

TEST(TanakaLaw, Eq9_TheCapIsTheSpringForceNotTheTotalForce) {
  ContactSpring approaching = held(0.02, 0.012);
  EXPECT_NEAR(force(moved(1e-6, 0.0, 0.0), approaching).shear, 0.0105, tolerance) << "total 0.029 N would hold it";
  ContactSpring receding = held(0.02, 0.008);
  EXPECT_NEAR(force(moved(-1e-6, 0.0, 0.0), receding).shear, 0.008, tolerance) << "total 0.011 N would let it slip";
}

TEST(TanakaLaw, Eq9_AfterSlippingTheSpringComesBackFromTheCap) {
  ContactSpring spring = held(0.02, 0.01);
  EXPECT_NEAR(force(moved(0.0, -1e-6, 0.0), spring).shear, 0.00575, tolerance);  // 0.00975 - 0.4 x 0.01
}

TEST(TanakaLaw, Eq9_AtTheCapExactlyTheContactSticks) {
  ContactSpring spring = held(0.5, 0.25);
  EXPECT_NEAR(force({0.0, 0.0, 1e-5, 0.0, 1e-5}, spring).shear, 0.29, tolerance);  // the dashpot is on
}

TEST(TanakaLaw, Eq9_WithoutFrictionThereIsNoShear) {
  ContactParameters smooth = parameters;
  smooth.friction = 0.0;
  ContactSpring spring;
  EXPECT_EQ(TanakaLaw<DefaultReadings>{}.force(moved(5e-5, 3e-5, 2e-5), smooth, dt, spring).shear, 0.0);
  EXPECT_EQ(spring.shear, 0.0);
}

TEST(TanakaLaw, TheFastPathIsTheSameLaw) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> length(-3e-5, 3e-5);
  ContactSpring fast;
  ContactSpring slow;
  for (int n = 0; n < 10000; ++n) {
    const RelativeDisplacement u = moved(length(random), length(random), std::abs(length(random)));
    const ContactForce f = TanakaLaw<DefaultReadings>{}.force(u, parameters, dt, fast);
    const ContactForce s = force(u, slow);
    ASSERT_EQ(f.normal, s.normal);
    ASSERT_EQ(f.shear, s.shear);
    ASSERT_EQ(fast.touching(), slow.touching());
  }
}

}  // namespace
}  // namespace crossdem
