// The measurement of a run: it counts the steps of one, and refuses more than there are.

#include "crossdem/measure.hpp"

#include <gtest/gtest.h>

#include "crossdem/run.hpp"
#include "small_case.hpp"

namespace crossdem::test {
namespace {

Case short_case() {
  return small_case({{"time",
                      {{"step_s", 1e-4},
                       {"rest_s", 0.02},
                       {"penetration_s", 0.03},
                       {"sample_interval_s", 0.015},
                       {"frame_interval_s", 0.03}}}});
}

TEST(Measure, MakesTheStepsOfRestAndPenetration) {
  const Case setup = short_case();
  const Packing packing = make_packing(setup, 1);
  const Measurement whole = measure(setup, packing, {});
  EXPECT_EQ(whole.steps, 500);
  EXPECT_EQ(whole.particles, 200U);
  EXPECT_GT(whole.wall, 0.0);
  EXPECT_GT(whole.cpu, 0.0);
  EXPECT_GT(whole.peak_memory, 1'000'000U);
  EXPECT_EQ(measure(setup, packing, 230).steps, 230);
  const Measurement none = measure(setup, packing, 0);
  EXPECT_EQ(none.steps, 0);
  EXPECT_LT(none.wall, whole.wall);
}

TEST(Measure, RefusesMoreStepsThanTheCaseHas) {
  const Case setup = short_case();
  EXPECT_THROW(measure(setup, make_packing(setup, 1), 501), CaseError);
}

/// A bar so fast that it runs over particles soon after it starts: both must say so of the same particle and step.
TEST(Measure, StepsAsARunDoes) {
  Case setup = short_case();
  const Packing packing = make_packing(setup, 1);
  ASSERT_TRUE(setup.bar);
  setup.bar->speed = 30.0;
  const auto said = [](const auto& steps) -> std::string {
    try {
      steps();
    } catch (const SimulationError& error) {
      return error.what();
    }
    return "nothing";
  };
  const TemporaryFolder folder;
  const std::string of_run = said([&] { run(setup, packing, folder.path()); });
  EXPECT_NE(of_run.find("into the bar after 2"), std::string::npos) << of_run;  // 200 steps of rest, then some
  EXPECT_EQ(said([&] { measure(setup, packing, {}); }), of_run);
}

}  // namespace
}  // namespace crossdem::test
