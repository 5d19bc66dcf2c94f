// The bar as a rectangle: nearest points, corners, tip and shaft.

#include "bar.hpp"

#include <gtest/gtest.h>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

/// From x = 0.025 to 0.035, tip at y = 0.1, 0.15 long; as in small_bed.json.
Bar bar() { return {{.width = 0.01, .length = 0.15, .centre_x = 0.03, .speed = 0.01}, 0.1}; }

struct Place {
  const char* name;
  Vector2 centre, normal;
  double distance;
};

class NearestPointOfTheBar : public testing::TestWithParam<Place> {};

TEST_P(NearestPointOfTheBar, LiesOnTheFaceOrTheCorner) {
  const NearestPoint nearest = bar().nearest_point(GetParam().centre);
  EXPECT_NEAR(nearest.normal.x(), GetParam().normal.x(), 1e-12);
  EXPECT_NEAR(nearest.normal.y(), GetParam().normal.y(), 1e-12);
  EXPECT_NEAR(nearest.distance, GetParam().distance, 1e-16);
}

INSTANTIATE_TEST_SUITE_P(Places, NearestPointOfTheBar,
                         testing::Values(Place{"bottom", {0.027, 0.098}, {0.0, 1.0}, 0.002},
                                         Place{"left_side", {0.022, 0.12}, {1.0, 0.0}, 0.003},
                                         Place{"right_side", {0.038, 0.2}, {-1.0, 0.0}, 0.003},
                                         Place{"top", {0.03, 0.252}, {0.0, -1.0}, 0.002},
                                         Place{"left_bottom_corner", {0.0238, 0.0991}, {0.8, 0.6}, 0.0015},
                                         Place{"right_bottom_corner", {0.0362, 0.0991}, {-0.8, 0.6}, 0.0015},
                                         Place{"right_top_corner", {0.0362, 0.2509}, {-0.8, -0.6}, 0.0015},
                                         Place{"left_top_corner", {0.0238, 0.2509}, {0.8, -0.6}, 0.0015}),
                         [](const auto& place) { return place.param.name; });

TEST(Bar, ContainsOnlyWhatIsInside) {
  EXPECT_TRUE(bar().contains({0.026, 0.101}));
  EXPECT_TRUE(bar().contains({0.034, 0.249}));
  for (const Vector2& outside :
       {Vector2(0.024, 0.11), Vector2(0.036, 0.11), Vector2(0.03, 0.099), Vector2(0.03, 0.251)})
    EXPECT_FALSE(bar().contains(outside));
}

TEST(Bar, MovesDownByTheStepOnceStarted) {
  Bar moving = bar();
  moving.advance(0.1);
  EXPECT_EQ(moving.tip(), 0.1);
  EXPECT_EQ(moving.displacement(), Vector2::Zero());
  moving.start();
  for (int n = 0; n < 1000; ++n) moving.advance(1e-4);
  EXPECT_NEAR(moving.tip(), 0.099, 1e-16);
  EXPECT_NEAR(moving.travel(), 0.001, 1e-16);
  EXPECT_EQ(moving.displacement().x(), 0.0);
  EXPECT_NEAR(moving.displacement().y(), -1e-6, 1e-21);
}

/// Frictionless, so that only the direction of the normal counts; r = 2 mm, corner 1.5 mm away: 0.5 N along (0.8, 0.6).
Simulation at_corner(const char* reading) {
  Case c = case_reading("bar_corner", reading);
  c.gravity = 0.0;
  c.particle_wall.friction = 0.0;
  return {c, small_disc({0.0238, 0.0991}, Vector2::Zero()), 0.1};
}

TEST(Bar, ACornerPushesAlongTheLineFromTheCentre) {
  Simulation s = at_corner("nearest_point");
  s.advance(1);
  const Vector2 received = small_mass * s.particles().velocity[0] / 1e-4;
  EXPECT_NEAR(received.x(), -0.4, 1e-12);
  EXPECT_NEAR(received.y(), -0.3, 1e-12);
  EXPECT_NEAR(s.bar_force().tip.x(), 0.4, 1e-12);
  EXPECT_NEAR(s.bar_force().tip.y(), 0.3, 1e-12);
  EXPECT_EQ(s.bar_force().shaft, Vector2::Zero());
}

TEST(Bar, ReadingFacesOnlyHasNoForceAtACorner) {
  Simulation s = at_corner("faces_only");
  s.advance(1);
  EXPECT_EQ(s.particles().velocity[0], Vector2::Zero());
  EXPECT_EQ(s.bar_force().tip, Vector2::Zero());
}

TEST(Bar, ReadingFacesOnlyKeepsTheFaces) {
  Case c = case_reading("bar_corner", "faces_only");
  c.gravity = 0.0;
  Particles p = small_disc({0.026, 0.0981}, Vector2::Zero());  // under the bottom
  p.add(small_radius, small_mass, {0.0231, 0.12}, Vector2::Zero());
  Simulation s(c, p, 0.1);
  s.advance(1);
  EXPECT_NEAR(s.bar_force().tip.y(), 0.1, 1e-12);
  EXPECT_NEAR(s.bar_force().shaft.x(), 0.1, 1e-12);
}

TEST(Bar, FacesOnlyDoesNotTouchTheContainer) {
  Case c = case_reading("bar_corner", "faces_only");
  c.gravity = 0.0;
  Simulation s(c, small_disc({0.0019, 0.05}, Vector2::Zero()), 0.1);
  s.advance(1);
  EXPECT_GT(s.particles().velocity[0].x(), 0.05);
}

TEST(Bar, ForceSplitsIntoTipAndShaft) {
  Particles p = small_disc({0.03, 0.0981}, Vector2::Zero());            // bottom face
  p.add(small_radius, small_mass, {0.0362, 0.0991}, Vector2::Zero());   // right corner, overlap 0.5 mm
  p.add(small_radius, small_mass, {0.0231, 0.12}, Vector2(0.0, -0.1));  // left side, rubbing downwards
  p.add(large_radius, large_mass, {0.0373, 0.14}, Vector2::Zero());     // right side, overlap 0.2 mm
  Simulation s(weightless(), p, 0.1);
  s.advance(1);
  EXPECT_NEAR(s.bar_force().tip.x(), -0.4, 1e-12);
  EXPECT_NEAR(s.bar_force().tip.y(), 0.1 + 0.3, 1e-12);
  EXPECT_NEAR(s.bar_force().shaft.x(), 0.1 - 0.2, 1e-12);
  // du_s = -1e-5 with t = (0, 1): e_s = -0.0025, within mu e_n = 0.025; f_s = -0.0025 - 0.387 x 0.1; the bar is dragged
  // down
  EXPECT_NEAR(s.bar_force().shaft.y(), -0.0412, 1e-12);
}

TEST(Bar, TheForceIsThatOfTheLatestStepOnly) {
  Simulation s(springs_only(), small_disc({0.03, 0.0981}, Vector2::Zero()), 0.1);
  s.advance(1);
  EXPECT_GT(s.bar_force().tip.y(), 0.0);
  s.advance(50);  // pushed away
  EXPECT_EQ(s.bar_force().tip, Vector2::Zero());
}

/// One contact per particle and bar: sliding off the bottom face over the edge is no first contact. Step 1 pushes with
/// 0.1 N: v_y = -0.0520114, d_y = -2.60057e-6; step 2 has e_n = 0.1 - 0.0026, f_n = e_n - 0.774 x 0.0260057 = 0.077271,
/// whereas a first contact would push with 0.097 + 0.774 x 0.97 = 0.85 N.
TEST(Bar, AParticleKeepsItsSpringWhileItSlidesFromFaceToCorner) {
  Case c = weightless();
  c.particle_wall.friction = 0.0;
  Simulation s(c, small_disc({0.034995, 0.0981}, {0.1, 0.0}), 0.1);
  s.advance(1);
  EXPECT_LT(s.particles().position[0].x() - 1e-5, 0.035);
  EXPECT_GT(s.particles().position[0].x(), 0.035);
  EXPECT_NEAR(s.bar_force().tip.y(), 0.1, 1e-12);
  s.advance(1);  // the normal has turned by 0.002628: du_n is u_x x 0.002628 = 2.63e-8 less, f_n 0.000230 less
  EXPECT_NEAR(s.bar_force().tip.y(), 0.077041, 2e-6);
}

}  // namespace
}  // namespace crossdem::test
