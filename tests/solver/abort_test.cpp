// Runs that go wrong say so, and keep what was written.

#include <gtest/gtest.h>

#include <limits>

#include "crossdem/run.hpp"
#include "small_case.hpp"

namespace crossdem::test {
namespace {

void expect_message(const std::optional<std::string>& message, const std::string& part) {
  ASSERT_TRUE(message.has_value()) << "nothing was thrown";
  EXPECT_NE(message->find(part), std::string::npos) << *message;
}

/// Message of a simulation that is advanced far, if it fails.
std::optional<std::string> failure(const Case& c, const Particles& p, std::optional<double> bar_tip = std::nullopt) {
  return message_of<SimulationError>([&] {
    Simulation s(c, p, bar_tip);
    if (bar_tip) s.start_bar();
    for (int n = 0; n < 100; ++n) {
      s.advance(10);
      s.check();
    }
  });
}

TEST(Abort, MotionThatIsNotFiniteAtTheStart) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  expect_message(failure(small_case(), small_disc({nan, 0.05}, {0, 0})), "motion of particle 0 is not finite");
  expect_message(failure(small_case(), small_disc({0.03, 0.05}, {0, -infinite})), "particle 0 is not finite");
  expect_message(failure(small_case(), small_disc({0.03, 0.05}, {0, 0}, nan)), "particle 0 is not finite");
}

TEST(Abort, MotionThatBecomesNotFinite) {
  Particles p = small_disc({0.01, 0.05}, {0, 0});
  for (int k = 0; k < 2; ++k) p.add(small_radius, small_mass, {0.03, 0.05}, Vector2::Zero());  // one upon the other
  expect_message(failure(small_case(), p), "the motion of particle 1 is not finite after 10 steps of 0.0001 s");
}

TEST(Abort, ParticlesOutsideAtTheStart) {
  for (const Vector2& outside : {Vector2(-0.001, 0.05), Vector2(0.0601, 0.05), Vector2(0.03, -1e-6)})
    expect_message(failure(small_case(), small_disc(outside, {0, 0})), "particle 0 went through a wall");
  expect_message(failure(small_case(), small_disc({0.03, 0.11}, {0, 0}), 0.1),
                 "particle 0 went through a wall or into");
  EXPECT_FALSE(failure(small_case(), small_disc({0.03, 0.11}, {0, 0})).has_value())
      << "without the bar it may be there";
}

TEST(Abort, AParticleThatGoesThroughAWallWhileRunning) {
  for (const Vector2& velocity : {Vector2(-70, 0), Vector2(70, 0), Vector2(0, -70)}) {  // 7 mm a step
    const auto message = failure(small_case(), small_disc({0.03, 0.03}, velocity));
    expect_message(message, "particle 0 went through a wall");
    expect_message(message, "steps of 0.0001 s; try a smaller time step");
  }
  Case fast_bar = small_case();
  fast_bar.bar->speed = 70.0;
  expect_message(failure(fast_bar, small_disc({0.03, 0.03}, {0, 0}), 0.05), "or into the bar");
}

TEST(Abort, KineticEnergyThatExplodes) {
  Case c = small_case();
  c.particle_particle.normal_stiffness = 1e5;
  Particles p = small_disc({0.03, 0.05}, {0, 0});
  p.add(small_radius, small_mass, {0.0325, 0.05}, Vector2::Zero());  // 0.1 J in the spring, weight can give 6 mJ
  expect_message(failure(c, p), "the kinetic energy exploded to ");
}

TEST(Abort, WhatWeightAndBarCanGiveIsNoExplosion) {
  EXPECT_FALSE(failure(small_case(), small_disc({0.03, 0.149}, {0, 0})).has_value());
  Case c = weightless();
  c.bar->speed = 0.5;
  EXPECT_FALSE(failure(c, small_disc({0.03, 0.09}, {0, 0}), 0.1).has_value());
}

TEST(Abort, ASimulationOfNothingIsRefused) {
  EXPECT_THROW(Simulation(small_case(), Particles{}, std::nullopt), std::invalid_argument);
}

/// A bed that was settled at 1e-4 s and is run far above Eq. (32).
TEST(Abort, AFailedRunKeepsWhatItHasWritten) {
  Case c = small_case({{"particles", {{"count", 60}}}});
  const Packing packing = make_packing(c, 1);
  c.time.step = 1e-3;
  c.time.rest = 0.0;
  const TemporaryFolder folder;
  EXPECT_TRUE(message_of<SimulationError>([&] { run(c, packing, folder.path()); }).has_value());
  const std::vector<std::string> rows = lines_of(folder / "resistance.csv");
  ASSERT_GE(rows.size(), 2U);
  EXPECT_EQ(rows[1].substr(0, 4), "0,0,") << "the row of t = 0 stays";
  EXPECT_EQ(lines_of(folder / "ledger.csv").size(), rows.size());
  EXPECT_GT(std::filesystem::file_size(folder / "motion.h5"), 1000U);
  EXPECT_FALSE(std::filesystem::exists(folder / "run.json")) << "run.json says that all is done";
}

}  // namespace
}  // namespace crossdem::test
