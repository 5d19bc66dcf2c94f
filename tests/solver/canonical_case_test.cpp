// The resolved case as text, by which runs are named, and the warnings that go with it.

#include <gtest/gtest.h>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

using nlohmann::json;

json everything() {
  return small_json(
      {{"title", "Gr\u00f6\u00dfe"},
       {"gravity_m_s2", 1.62},
       {"engines", {{"yade", {{"step_s", 2.5e-5}}}, {"other", {{"step_s", 1e-5}}}}},
       {"scheme",
        {{"name", "paper"},
         {"update_order", "in_turn"},
         {"first_contact_normal", "spring_only"},
         {"first_contact_shear", "raw_share"},
         {"lost_contact", "keep_negative"},
         {"attraction", "clipped"},
         {"normal_spring", "overlap"},
         {"dashpot_velocity", "true_velocity"},
         {"initial_displacement", "zero"},
         {"bar_corner", "faces_only"},
         {"slip_cap", "total"},
         {"torque_arm", "contact_point"},
         {"integrator", "leap_frog"},
         {"inertia", "sphere"}}},
       {"answer", {{{"quantity", "rest"}, {"kind", "absolute"}, {"tolerance", 1e-3}, {"reason", "a"}}}},
       {"difference",
        {{{"engine", "yade"}, {"quantity", "rest"}, {"value", -0.1}, {"tolerance", 1e-3}, {"reason", "d"}}}},
       {"twin", {{{"engine", "yade-averaged"}, {"limit_m", 0.0}, {"until_s", 0.1}, {"reason", "t"}}}},
       {"check",
        {{{"quantity", "mean_resistance"},
          {"kind", "relative"},
          {"margin", 0.12},
          {"seed_scatter", 0.08},
          {"reason", "r"}},
         {{"quantity", "bump"}, {"kind", "ratio"}, {"margin", 1.5}, {"seed_scatter", 1.2}, {"reason", "s"}}}}});
}

TEST(CanonicalCase, IsAFixedPoint) {
  for (const json& root : {small_json(), everything()}) {
    const std::string once = canonical_json(read_case(root.dump()));
    EXPECT_EQ(canonical_json(read_case(once)), once);
  }
}

TEST(CanonicalCase, HoldsEveryValueThatWasSet) {
  const json written = json::parse(canonical_json(read_case(everything().dump())));
  EXPECT_EQ(written, [&] {
    json merged = written;
    merged.merge_patch(everything());
    return merged;
  }());
  EXPECT_EQ(written["scheme"].size(), 14U);
  EXPECT_EQ(written["engines"]["liggghts"]["step_s"], 5e-5) << "defaults are filled in";
}

TEST(CanonicalCase, DoesNotDependOnTheOrderOfKeysOrOnWhiteSpace) {
  const json sorted = small_json();
  nlohmann::ordered_json reversed;
  for (auto it = sorted.rbegin(); it != sorted.rend(); ++it) reversed[it.key()] = it.value();
  EXPECT_NE(reversed.dump(2), sorted.dump());
  EXPECT_EQ(canonical_json(read_case(reversed.dump(2))), canonical_json(small_case()));
}

TEST(CanonicalCase, ADefaultThatIsWrittenOutChangesNothing) {
  EXPECT_EQ(canonical_json(small_case({{"gravity_m_s2", 9.80665}, {"scheme", {{"lost_contact", "forget"}}}})),
            canonical_json(small_case()));
  EXPECT_NE(canonical_json(small_case({{"gravity_m_s2", 9.8}})), canonical_json(small_case()));
}

/// Runs and records of the paper's law keep their names, by whatever options there are beyond it.
TEST(CanonicalCase, OptionsThatAreOffAreNotWritten) {
  const auto with = [](double strength, double rolling) {
    return canonical_json(small_case({{"contact",
                                       {{"particle_particle", {{"tensile_strength_N", strength}}},
                                        {"particle_wall", {{"rolling_friction", rolling}}}}}}));
  };
  EXPECT_EQ(with(0.0, 0.0), canonical_json(small_case()));
  const json written = json::parse(with(0.1, 0.2));
  EXPECT_EQ(written["contact"]["particle_particle"]["tensile_strength_N"], 0.1);
  EXPECT_EQ(written["contact"]["particle_wall"]["rolling_friction"], 0.2);
}

TEST(CanonicalCase, IsSortedAndWithoutWhiteSpace) {
  const std::string text = canonical_json(small_case());
  EXPECT_EQ(text.find_first_of(" \n\t"), std::string::npos);
  EXPECT_EQ(text, json::parse(text).dump());
  EXPECT_EQ(text.rfind("{\"answer\":[],\"bar\":{\"centre_x_m\":0.03,", 0), 0U);
}

/// 16 eta_s / m of the 4 mm disc: m / eta_s = 4.968e-4 s; times 6 / 16 and 2 / 16.
TEST(CaseWarnings, NameThePackedBedLimitOfTheScheme) {
  EXPECT_NEAR(packed_bed_time_step(small_case(), averaged_displacement_gain), 1.863e-4, 1e-7);
  EXPECT_NEAR(packed_bed_time_step(small_case(), conventional_gain), 6.21e-5, 1e-7);
  EXPECT_TRUE(warnings(small_case()).empty());
  const std::vector<std::string> found = warnings(small_case(
      {{"time", {{"step_s", 2e-4}}}, {"engines", {{"yade", {{"step_s", 1e-4}}}, {"liggghts", {{"step_s", 5e-5}}}}}}));
  ASSERT_EQ(found.size(), 2U) << testing::PrintToString(found);
  EXPECT_EQ(found[0].rfind("time.step_s = 0.0002 s is above the packed-bed limit of ", 0), 0U) << found[0];
  EXPECT_NE(found[0].find("0.0001863 s"), std::string::npos) << found[0];
  EXPECT_EQ(found[1].rfind("engines.yade.step_s = 0.0001 s is above the packed-bed limit of ", 0), 0U) << found[1];
  EXPECT_NE(found[1].find("6.21e-05 s"), std::string::npos) << found[1];
}

TEST(CaseWarnings, TrueVelocitiesAndThePackingHaveLimitsOfTheirOwn) {
  Case c = small_case();
  EXPECT_TRUE(warnings(c).empty());
  c.packing.step = 2e-4;
  ASSERT_EQ(warnings(c).size(), 1U);
  EXPECT_EQ(warnings(c)[0].rfind("packing.step_s = 0.0002 s is above the packed-bed limit", 0), 0U) << warnings(c)[0];
  c.packing.step = c.time.step;
  c.scheme.readings.dashpot_velocity = DashpotVelocity::true_velocity;  // 1e-4 s against 6.2e-5 s
  ASSERT_EQ(warnings(c).size(), 1U);
  EXPECT_EQ(warnings(c)[0].rfind("time.step_s = 0.0001 s is above", 0), 0U) << warnings(c)[0];
}

TEST(CaseWarnings, WithoutShearDashpotsThereIsNoPackedBedLimit) {
  Case c = small_case();
  c.time.step = 1.0;
  c.engines.clear();
  EXPECT_EQ(warnings(c).size(), 1U);
  c.particle_particle.shear_damping = c.particle_wall.shear_damping = 0.0;
  EXPECT_TRUE(warnings(c).empty());
}

}  // namespace
}  // namespace crossdem::test
