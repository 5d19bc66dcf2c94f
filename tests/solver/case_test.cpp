// Reading a case: every fault by its key path, all in one go; the canonical text of what is left.

#include "crossdem/case.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

using nlohmann::json;

std::vector<std::string> faults_of(const std::string& text) {
  try {
    read_case(text);
  } catch (const CaseError& error) {
    return error.faults();
  }
  return {};
}

struct Fault {
  const char* pointer;  // JSON pointer of the key that is set, or removed where `value` is discarded
  json value;
  const char* expected;  // beginning of the fault: key path and message
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.expected; }

json removed() { return json(json::value_t::discarded); }

std::string text_with(const Fault& fault) {
  json root = small_json();
  const json::json_pointer at(fault.pointer);
  if (fault.value.is_discarded()) {
    root.at(at.parent_pointer()).erase(at.back());
  } else {
    root[at] = fault.value;
  }
  return root.dump();
}

class CaseFault : public testing::TestWithParam<Fault> {};

TEST_P(CaseFault, IsTheOnlyOneReportedAndNamesItsKey) {
  const std::vector<std::string> faults = faults_of(text_with(GetParam()));
  ASSERT_EQ(faults.size(), 1U) << testing::PrintToString(faults);
  EXPECT_EQ(faults[0].substr(0, std::string(GetParam().expected).size()), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Keys, CaseFault,
    testing::Values(Fault{"/bar/colour", "red",
                          "bar.colour: unknown key; known here: centre_x_m, length_m, speed_m_s, tip_m, "
                          "width_m"},
                    Fault{"/colour", "red", "colour: unknown key"},
                    Fault{"/contact/particle_wall/colour", 1, "contact.particle_wall.colour: unknown key"},
                    Fault{"/contact/particle_wall/friction", removed(), "contact.particle_wall.friction: missing"},
                    Fault{"/schema_version", removed(), "schema_version: missing"},
                    Fault{"/schema_version", 2, "schema_version: this crossdem reads version 1, not 2"},
                    Fault{"/name", "", "name: must consist of 1 to 64 letters"},
                    Fault{"/name", "../up", "name: must consist of 1 to 64 letters"},
                    Fault{"/name", std::string(65, 'a'), "name: must consist of 1 to 64 letters"},
                    Fault{"/title", 7, "title: must be a text that is not empty, is 7"}));

INSTANTIATE_TEST_SUITE_P(
    Types, CaseFault,
    testing::Values(
        Fault{"/bar/width_m", "0.01", "bar.width_m: must be a finite number, is \"0.01\""},
        Fault{"/bar/width_m", "nan", "bar.width_m: must be a finite number, is \"nan\""},
        Fault{"/bar/width_m", "-inf", "bar.width_m: must be a finite number, is \"-inf\""},
        Fault{"/bar/width_m", nullptr, "bar.width_m: must be a finite number, is null"},
        Fault{"/bar/width_m", true, "bar.width_m: must be a finite number, is true"},
        Fault{"/bar", 7, "bar: must be a table, is 7"},
        Fault{"/engines", json::array(), "engines: must be a table, is []"},
        Fault{"/engines", {{"yade", 5e-5}}, "engines.yade: must be a table"},
        Fault{"/engines", {{"ya de", {{"step_s", 5e-5}}}}, "engines.ya de: a name here must consist of"},
        Fault{"/engines", {{"yade", json::object()}}, "engines.yade.step_s: missing"},
        Fault{"/particles/diameters_m", 0.004, "particles.diameters_m: must be a list of numbers, is 0.004"},
        Fault{"/particles/diameters_m", json::array(), "particles.diameters_m: must be a list of numbers, is []"},
        Fault{"/particles/diameters_m", {0.004, "x"}, "particles.diameters_m[1]: must be a finite number"},
        Fault{"/time/allow_above_eq32", 1, "time.allow_above_eq32: must be true or false, is 1"},
        Fault{"/check", json::object(), "check: must be a list of tables ([[check]]), is {}"},
        Fault{"/scheme",
              {{"name", "leapfrog"}},
              "scheme.name: must be one of paper, liggghts, yade, liggghts_averaged, yade_averaged, is \"leapfrog\""},
        Fault{"/scheme",
              {{"lost_contact", "keep"}},
              "scheme.lost_contact: must be one of forget, keep_zero, keep_negative, is \"keep\""},
        Fault{"/scheme", {{"bar_corner", 3}}, "scheme.bar_corner: must be one of nearest_point, faces_only, is 3"}));

INSTANTIATE_TEST_SUITE_P(
    Ranges, CaseFault,
    testing::Values(
        Fault{"/bar/width_m", 0.0, "bar.width_m: must be above 0, is 0.0"},
        Fault{"/bar/width_m", -0.01, "bar.width_m: must be above 0, is -0.01"},
        Fault{"/contact/particle_wall/friction", -0.1, "contact.particle_wall.friction: must not be negative, is -0.1"},
        Fault{"/contact/particle_wall/rolling_friction", -0.1,
              "contact.particle_wall.rolling_friction: must not be negative, is -0.1"},
        Fault{"/contact/particle_particle/tensile_strength_N", "strong",
              "contact.particle_particle.tensile_strength_N: must be a finite number, is \"strong\""},
        Fault{"/contact/particle_wall/tensile_strength_N", 0.1,
              "contact.particle_wall.tensile_strength_N: unknown key; known here: friction, "},
        Fault{"/particles/number_shares", {1.5, 0.5}, "particles.number_shares[0]: must be from 0 to 1, is 1.5"},
        Fault{"/particles/count", 0, "particles.count: must be a whole number from 1 to 10000000, is 0"},
        Fault{"/particles/count", -5, "particles.count: must be a whole number"},
        Fault{"/particles/count", 2.5, "particles.count: must be a whole number"},
        Fault{"/particles/count", "many", "particles.count: must be a whole number"},
        Fault{"/particles/count", 10000001, "particles.count: must be a whole number"},
        Fault{"/particles/count", 18446744073709551615U, "particles.count: must be a whole number"},
        Fault{"/gravity_m_s2", -9.8, "gravity_m_s2: must not be negative"}));

INSTANTIATE_TEST_SUITE_P(
    Contradictions, CaseFault,
    testing::Values(
        Fault{"/bar/width_m", 0.07, "bar.width_m: a bar of 0.07 m does not go into a container of 0.06 m"},
        Fault{"/bar/centre_x_m", 0.004, "bar.centre_x_m: the bar reaches from -0.001 to 0.009 m, out of"},
        Fault{"/bar/centre_x_m", 0.056, "bar.centre_x_m: the bar reaches from 0.051 to 0.061 m, out of"},
        Fault{"/particles/number_shares", {1.0}, "particles.number_shares: must have as many entries as"},
        Fault{"/particles/number_shares", {0.5, 0.4}, "particles.number_shares: must add up to 1"},
        Fault{"/particles/count", 600, "particles.count: the bed does not fit: it would be at least 0.1775 m high"},
        Fault{"/packing/jitter_m", 0.0003, "packing.jitter_m: is more than half the gap of the lattice"},
        Fault{"/packing/settling_s", 11.0, "packing.settling_s: is longer than packing.longest_settling_s"},
        Fault{"/packing/step_s", 4e-4, "packing.step_s: 0.0004 s is above the limit of Eq. (32)"},
        Fault{"/time/rest_s", 0.10005, "time.rest_s: 0.1001 s is not a whole number, up to 1e9, of time.step_s"},
        Fault{"/time/penetration_s", 0.25,
              "time.penetration_s: 0.25 s is not a whole number, up to 1e9, of time.frame_i"},
        Fault{"/bar/length_m", 0.0001, "bar.length_m: the bar is shorter than its way of"},
        Fault{"/bar/speed_m_s", 0.75, "time.penetration_s: the bar would go 0.15 m deep in a container of 0.15 m"}),
    [](const auto& at) { return "Nr" + std::to_string(at.index); });

TEST(Case, TheSmallBedHasNoFault) { EXPECT_TRUE(faults_of(small_json().dump()).empty()); }

TEST(Case, AllFaultsAreReportedInOneGo) {
  json root = small_json({{"bar", {{"colour", 1}, {"width_m", -1}}}, {"time", {{"step_s", nullptr}}}, {"name", 5}});
  root["particles"]["count"] = 0;
  const std::vector<std::string> faults = faults_of(root.dump());
  const auto has = [&](const std::string& beginning) {
    return std::any_of(faults.begin(), faults.end(), [&](const std::string& f) { return f.rfind(beginning, 0) == 0; });
  };
  for (const char* beginning : {"bar.colour: ", "bar.width_m: ", "time.step_s: ", "name: ", "particles.count: "})
    EXPECT_TRUE(has(beginning)) << beginning;
  EXPECT_EQ(faults.size(), 5U);
  const auto message = message_of<CaseError>([&] { read_case(root.dump()); });
  EXPECT_EQ(std::count(message->begin(), message->end(), '\n'), 4) << "what() names all of them";
}

TEST(Case, AnUnknownKeyDoesNotHideAContradiction) {
  EXPECT_EQ(faults_of(small_json({{"bar", {{"colour", 1}, {"width_m", 0.1}}}}).dump()).size(), 2U);
}

TEST(Case, OptionsBeyondThePaperAreRefusedByTheSchemesThatLackThem) {
  const auto faults_with = [](const char* scheme) {
    return faults_of(small_json({{"scheme", {{"name", scheme}}},
                                 {"contact",
                                  {{"particle_particle", {{"tensile_strength_N", 0.1}, {"rolling_friction", 0.2}}},
                                   {"particle_wall", {{"rolling_friction", 0.3}}}}}})
                         .dump());
  };
  EXPECT_TRUE(faults_with("paper").empty());
  for (const char* scheme : {"liggghts", "liggghts_averaged"}) {
    const std::vector<std::string> faults = faults_with(scheme);
    ASSERT_EQ(faults.size(), 1U) << scheme << testing::PrintToString(faults);
    EXPECT_EQ(faults[0].rfind("contact.particle_particle.tensile_strength_N: the scheme \"liggghts", 0), 0U)
        << faults[0];
  }
  for (const char* scheme : {"yade", "yade_averaged"}) {
    const std::vector<std::string> faults = faults_with(scheme);
    ASSERT_EQ(faults.size(), 3U) << scheme << testing::PrintToString(faults);
    EXPECT_EQ(faults[1].rfind("contact.particle_particle.rolling_friction: the scheme \"yade", 0), 0U) << faults[1];
    EXPECT_EQ(faults[2].rfind("contact.particle_wall.rolling_friction: the scheme \"yade", 0), 0U) << faults[2];
  }
}

TEST(Case, ABrokenJointIsForgottenByNoOtherReading) {
  const std::vector<std::string> faults =
      faults_of(small_json({{"scheme", {{"lost_contact", "keep_zero"}}},
                            {"contact", {{"particle_particle", {{"tensile_strength_N", 0.1}}}}}})
                    .dump());
  ASSERT_EQ(faults.size(), 1U) << testing::PrintToString(faults);
  EXPECT_EQ(faults[0].rfind("scheme.lost_contact: a joint that is broken is forgotten", 0), 0U) << faults[0];
}

TEST(Case, SeveralContradictionsAreReportedInOneGo) {
  EXPECT_EQ(faults_of(small_json({{"bar", {{"width_m", 0.1}}},
                                  {"particles", {{"count", 600}, {"number_shares", {0.3, 0.7}}}},
                                  {"packing", {{"lattice_spacing_m", 0.004}, {"jitter_m", 0.0}}}})
                          .dump())
                .size(),
            3U);  // bar, bed, lattice
}

TEST(Case, TextThatIsNotJsonSaysWhere) {
  for (const std::string text : {"", "{", "{\"name\": NaN}", "{\"name\": 1e999}", "{} {}", "{\"name\": \"\xff\"}"}) {
    const std::vector<std::string> faults = faults_of(text);
    ASSERT_EQ(faults.size(), 1U) << text;
    EXPECT_EQ(faults[0].rfind("not valid JSON: ", 0), 0U) << faults[0];
  }
  EXPECT_NE(faults_of("{\n  \"name\": ,\n}")[0].find("line 2, column 11"), std::string::npos);
  EXPECT_EQ(faults_of("[]"), std::vector<std::string>{"must be a table, is []"});
}

TEST(Case, TextThatIsNestedWithoutEndIsRefusedInASentence) {
  for (const std::size_t depth : {100U, 100'000U, 500'000U}) {
    const std::string text = R"({"name": )" + std::string(depth, '[') + std::string(depth, ']') + "}";
    EXPECT_EQ(faults_of(text), std::vector<std::string>{"nested more than 32 levels deep: no case is"});
  }
}

TEST(Case, ALongKeyIsShownByItsStart) {
  const std::string key(100'000, 'k');
  const std::vector<std::string> faults = faults_of("{\"" + key + R"(": {"a": 1, "a": 1, "a": 1}})");
  EXPECT_EQ(faults.at(0), std::string(64, 'k') + "....a: the key stands twice");
}

TEST(Case, AKeyThatStandsTwiceIsAFault) {
  std::string text = small_json().dump();
  text.insert(text.rfind('}'), R"(,"name":"other")");
  const std::vector<std::string> faults = faults_of(text);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0], "name: the key stands twice");
}

TEST(Case, AKeyThatStandsTwiceInATableIsNamedByItsPathBesideAllOtherFaults) {
  std::string text = small_json({{"bar", {{"speed_m_s", -1}}}}).dump();
  text.insert(text.find("\"width_m\""), R"("width_m":0.02,)");  // keys are sorted: that of the bar comes first
  EXPECT_EQ(faults_of(text),
            (std::vector<std::string>{"bar.width_m: the key stands twice", "bar.speed_m_s: must be above 0, is -1"}));
}

TEST(Case, AnIntervalOfMoreStepsThanCanBeCountedIsAFault) {
  const auto faults = faults_of(small_json({{"time", {{"rest_s", 1e300}}}}).dump());
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0].rfind("time.rest_s: 1e+300 s is not a whole number, up to 1e9,", 0), 0U) << faults[0];
}

TEST(Case, EqualKeysOfDifferentTablesAreNoFault) {
  EXPECT_TRUE(
      faults_of(small_json({{"packing", {{"step_s", 1e-4}}}, {"engines", {{"yade", {{"step_s", 5e-5}}}}}}).dump())
          .empty());
}

TEST(Case, Eq32_AStepAboveTheLimitIsAFaultUnlessItIsOnPurpose) {
  const json above = {{"time", {{"step_s", 4e-4}, {"sample_interval_s", 0.1}, {"frame_interval_s", 0.2}}}};
  std::vector<std::string> faults = faults_of(small_json(above).dump());
  ASSERT_EQ(faults.size(), 1U) << testing::PrintToString(faults);
  EXPECT_EQ(faults[0].rfind("time.step_s: 0.0004 s is above the limit of Eq. (32), 0.75 sqrt(m/k) = 0.0003289 s", 0),
            0U);
  EXPECT_NE(faults[0].find("time.allow_above_eq32 = true"), std::string::npos);
  json allowed = small_json(above);
  allowed["time"]["allow_above_eq32"] = true;
  EXPECT_TRUE(faults_of(allowed.dump()).empty());
  const json engine = {{"engines", {{"yade", {{"step_s", 4e-4}}}}},
                       {"time", {{"sample_interval_s", 0.1}, {"frame_interval_s", 0.2}}}};
  faults = faults_of(small_json(engine).dump());
  ASSERT_EQ(faults.size(), 1U) << testing::PrintToString(faults);
  EXPECT_EQ(faults[0].rfind("engines.yade.step_s: 0.0004 s is above the limit", 0), 0U);
}

TEST(Case, IntervalsMustBeWholeNumbersOfEveryEnginesSteps) {
  const auto faults = faults_of(small_json({{"engines", {{"yade", {{"step_s", 3e-5}}}}}}).dump());
  ASSERT_EQ(faults.size(), 3U);  // samples, frames, rest
  for (const std::string& fault : faults) EXPECT_NE(fault.find("engines.yade.step_s = 3e-05 s"), std::string::npos);
  EXPECT_EQ(faults_of(small_json({{"time", {{"sample_interval_s", 4e-5}}}}).dump()).size(), 3U) << "less than a step";
}

TEST(Case, DefaultsAreFilled) {
  const Case c = small_case();
  EXPECT_EQ(c.title, "small_bed");
  EXPECT_EQ(c.gravity, 9.80665);
  EXPECT_EQ(c.bar->length, 0.15);
  EXPECT_EQ(c.bar->centre_x, 0.03);
  EXPECT_NEAR(c.time.sample_interval, 0.01, 1e-15);
  EXPECT_NEAR(c.time.frame_interval, 0.1, 1e-15);
  EXPECT_EQ(c.engines.at("yade").step, 5e-5);
  EXPECT_EQ(c.engines.at("liggghts").step, 5e-5);
  EXPECT_NEAR(c.packing.lattice_spacing, 0.0054, 1e-15);
  EXPECT_NEAR(c.packing.jitter, 0.0002, 1e-15);
  EXPECT_EQ(c.packing.step, 1e-4);
  EXPECT_EQ(c.scheme.name, "paper");
  EXPECT_TRUE(c.scheme.readings == Readings{});
  EXPECT_FALSE(c.time.allow_above_eq32);
}

}  // namespace
}  // namespace crossdem::test
