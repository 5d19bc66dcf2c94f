// The measurement of a run: it counts the steps of one, and refuses more than there are.

#include "crossdem/measure.hpp"

#include <gtest/gtest.h>

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

TEST(Measure, StopsWhereTheMotionIsBeyondReason) {
  Case setup = short_case();
  const Packing packing = make_packing(setup, 1);
  setup.time.step = 3e-3;
  EXPECT_THROW(measure(setup, packing, {}), SimulationError);
}

}  // namespace
}  // namespace crossdem::test
