// Settled beds: made from a seed, written, and read back with suspicion.

#include "crossdem/packing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "small_case.hpp"
#include "text_file.hpp"

namespace crossdem::test {
namespace {

Case few() { return small_case({{"particles", {{"count", 60}}}}); }

TEST(Packing, EqualSeedsGiveEqualBitsAndOthersAnotherBed) {
  const Packing first = make_packing(few(), 1);
  const Packing again = make_packing(few(), 1);
  const Packing other = make_packing(few(), 2);
  EXPECT_EQ(first.position, again.position);
  EXPECT_EQ(first.radius, again.radius);
  EXPECT_EQ(first.bar_tip, again.bar_tip);
  EXPECT_NE(first.position, other.position);
  EXPECT_NE(first.radius, other.radius);
  EXPECT_EQ(first.seed, 1U);
  EXPECT_EQ(other.seed, 2U);
}

TEST(Packing, HoldsTheMixOfTheCaseAtRestInTheContainer) {
  const Case c = small_case({{"particles", {{"count", 61}, {"number_shares", {0.25, 0.75}}}}});
  const Packing bed = make_packing(c, 5);
  EXPECT_EQ(std::count(bed.radius.begin(), bed.radius.end(), small_radius), 15);
  EXPECT_EQ(std::count(bed.radius.begin(), bed.radius.end(), large_radius), 46);
  EXPECT_LT(bed.kinetic_energy, 1e-9);
  EXPECT_GE(bed.settling, 0.3);
  double top = 0.0;
  for (std::size_t i = 0; i < bed.radius.size(); ++i) {
    EXPECT_GT(bed.position[i].x(), 0.9 * bed.radius[i]);  // no more than its weight's overlap in the walls
    EXPECT_LT(bed.position[i].x(), 0.06 - 0.9 * bed.radius[i]);
    EXPECT_GT(bed.position[i].y(), 0.8 * bed.radius[i]);
    top = std::max(top, bed.position[i].y() + bed.radius[i]);
  }
  EXPECT_EQ(bed.bed_height, top);
  EXPECT_GT(bed.contacts, 60U);
  const Particles resting = particles_of(bed, c);
  EXPECT_EQ(kinetic_energy(resting), 0.0);
  EXPECT_EQ(resting.position, bed.position);
}

/// Settled for one look of 100 steps only, without weight: what is seen is the lattice.
TEST(Packing, TheLatticeStartsWithoutOverlap) {
  const Case c = small_case(
      {{"gravity_m_s2", 0.0},
       {"packing", {{"settling_s", 0.0}, {"velocity_m_s", 0.0}, {"jitter_m", 0.0002}, {"kinetic_energy_J", 1.0}}}});
  const Packing lattice = make_packing(c, 1);
  EXPECT_EQ(lattice.contacts, 0U);
  double largest_shift = 0.0;
  for (const Vector2& at : lattice.position) {
    EXPECT_GE(at.x(), large_radius);
    EXPECT_LE(at.x(), 0.06 - large_radius);
    EXPECT_GE(at.y(), large_radius);
    const double row = (at.y() - 0.0027) / 0.0054;
    largest_shift = std::max(largest_shift, std::abs(row - std::round(row)) * 0.0054);
  }
  EXPECT_GT(largest_shift, 0.00015);
  EXPECT_LE(largest_shift, 0.0002 + 1e-12);
}

TEST(Packing, ABedThatDoesNotSettleIsAnError) {
  const Case restless =
      small_case({{"particles", {{"count", 60}}}, {"packing", {{"settling_s", 0.01}, {"longest_settling_s", 0.02}}}});
  const auto message = message_of<SimulationError>([&] { make_packing(restless, 9); });
  ASSERT_TRUE(message.has_value());
  EXPECT_NE(message->find("the bed of seed 9 did not settle"), std::string::npos) << *message;
}

TEST(Packing, ABedHigherThanTheContainerIsBadInput) {
  Case low = few();
  low.container.height = 0.015;
  const auto message = message_of<CaseError>([&] { make_packing(low, 1); });
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->rfind("particles.count: the bed does not fit: settled it is 0.02", 0), 0U) << *message;
}

TEST(Packing, TheBarTouchesTheTopmostParticleUnderIt) {
  const BarGeometry bar{.width = 0.01, .length = 0.15, .centre_x = 0.03, .speed = 0.01};  // 0.025 to 0.035
  const std::vector<double> radius{0.0025, 0.002, 0.002};
  EXPECT_NEAR(touching_height(bar, radius, {{0.03, 0.05}, {0.026, 0.0504}, {0.01, 0.1}}), 0.0525, 1e-16);
  // Beside the bar by 1.5 mm: only its left lower part is under the corner, sqrt(2.5^2 - 1.5^2) = 2 mm above the
  // centre.
  EXPECT_NEAR(touching_height(bar, {0.0025}, {{0.0235, 0.05}}), 0.052, 1e-15);
  EXPECT_NEAR(touching_height(bar, {0.0025}, {{0.0365, 0.05}}), 0.052, 1e-15);
  EXPECT_EQ(touching_height(bar, {0.0025}, {{0.0224, 0.05}}), 0.0) << "beside it altogether";
}

/// A written packing of 60 particles, to be spoilt.
class PackingFile : public testing::Test {
 protected:
  static void SetUpTestSuite() { bed = make_packing(few(), 3); }
  void SetUp() override { write_packing(bed, folder.path()); }

  /// Replaces line `number` (1 is the header) of packing.csv; empty text removes it.
  void spoil(std::size_t number, const std::string& text) const {
    std::vector<std::string> lines = lines_of(csv());
    lines.at(number - 1) = text;
    std::ofstream out(csv());
    for (const std::string& line : lines)
      if (!line.empty()) out << line << "\n";
  }
  void expect_refused(const std::string& part) const {
    const auto message = message_of<CaseError>([&] { read_packing(csv(), few()); });
    ASSERT_TRUE(message.has_value());
    EXPECT_NE(message->find(part), std::string::npos) << *message;
  }
  [[nodiscard]] std::filesystem::path csv() const { return folder / "packing.csv"; }

  inline static Packing bed;
  TemporaryFolder folder;
};

TEST_F(PackingFile, IsReadBackBitForBit) {
  const Packing read = read_packing(csv(), few());
  EXPECT_EQ(read.position, bed.position);
  EXPECT_EQ(read.velocity, bed.velocity);
  EXPECT_EQ(read.spin, bed.spin);
  EXPECT_EQ(read.radius, bed.radius);
  EXPECT_EQ(read.bar_tip, bed.bar_tip);
  EXPECT_EQ(read.seed, 3U);
  EXPECT_EQ(read.contacts, bed.contacts);
  EXPECT_EQ(read.kinetic_energy, bed.kinetic_energy);
  EXPECT_EQ(read.bed_height, bed.bed_height);
  EXPECT_EQ(read.settling, bed.settling);
  EXPECT_EQ(lines_of(csv())[0], "id,x_m,y_m,radius_m,velocity_x_m_s,velocity_y_m_s,angular_velocity_rad_s");
}

TEST_F(PackingFile, RefusesAnotherHeader) {
  spoil(1, "id,x,y,r");
  expect_refused("the first line must be id,x_m,y_m,radius_m");
}

TEST_F(PackingFile, RefusesRowsThatAreNotSevenFiniteNumbers) {
  for (const char* row : {"1,0.01,0.02,0.002,0,0", "1,0.01,0.02,0.002,0,0,0,7", "1,0.01,x,0.002,0,0,0",
                          "1,nan,0.02,0.002,0,0,0", "1,0.01,0.02,0.002,0,inf,0", "1,0.01,0.02,0.002,0,0,0 ",
                          "one,0.01,0.02,0.002,0,0,0", "1;0.01;0.02;0.002;0;0;0", "7,0.01,0.02,0.002,0,0,0"}) {
    write_packing(bed, folder.path());
    spoil(3, row);
    expect_refused("packing.csv: line 3: must be particle 1 as seven finite numbers");
  }
}

TEST_F(PackingFile, RefusesRadiiThatTheCaseDoesNotHave) {
  spoil(3, "1,0.01,0.02,0.00201,0,0,0");
  expect_refused("line 3: no particle of the case has the radius 0.00201");
}

TEST_F(PackingFile, RefusesParticlesOutsideTheContainer) {
  for (const char* row : {"1,-0.001,0.02,0.002,0,0,0", "1,0.0601,0.02,0.002,0,0,0", "1,0.01,-0.001,0.002,0,0,0"}) {
    write_packing(bed, folder.path());
    spoil(3, row);
    expect_refused("line 3: the particle is outside the container");
  }
}

TEST_F(PackingFile, RefusesAnotherNumberOfParticles) {
  spoil(61, "");
  expect_refused("packing.csv: holds 59 particles, the case 60");
}

TEST_F(PackingFile, RefusesFactsThatAreMissingOrBroken) {
  for (const char* facts : {"{", "{}", R"({"seed": "one"})"}) {
    std::ofstream(folder / "packing.json") << facts;
    expect_refused("packing.json: ");
  }
  std::filesystem::remove(folder / "packing.json");
  EXPECT_THROW(read_packing(csv(), few()), FileError);
}

TEST_F(PackingFile, RefusesABarThatStartsWithAParticleInside) {
  std::string facts;
  for (const std::string& line : lines_of(folder / "packing.json"))
    facts += line.find("bar_tip_m") == std::string::npos ? line : R"("bar_tip_m": 0.01,)";
  std::ofstream(folder / "packing.json") << facts;
  expect_refused("bar.tip_m: with its bottom face at 0.01 m particle ");
}

TEST_F(PackingFile, RefusesASeedThatIsNoSeed) {
  for (const char* seed : {"-1", "1.5", "\"1\""}) {
    std::ofstream(folder / "packing.json") << R"({"seed": )" << seed << "}";
    expect_refused("packing.json: seed must be a whole number that is not negative");
  }
}

TEST_F(PackingFile, RefusesAnEmptyFileAsOneWithoutItsFirstLine) {
  std::ofstream(folder / "packing.csv") << "";
  expect_refused("packing.csv: the first line must be id,");
}

TEST_F(PackingFile, RefusesContactsThatAreNoCount) {
  for (const char* contacts : {"-1", "1.5", "1e300", "\"1\""}) {
    std::ofstream(folder / "packing.json") << R"({"seed": 1, "contacts": )" << contacts << "}";
    expect_refused("packing.json: contacts must be a whole number that is not negative");
  }
}

TEST_F(PackingFile, RefusesAPenetrationThroughTheFloor) {
  Case deep = few();
  deep.time.penetration = 100 * *bed.bar_tip;  // at 0.01 m/s
  const auto message = message_of<CaseError>([&] { read_packing(csv(), deep); });
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->rfind("time.penetration_s: the bar starts at ", 0), 0U) << *message;
}

TEST_F(PackingFile, ABedInWhichTheBarWouldReachTheFloorIsNotMade) {
  Case deep = few();
  deep.time.penetration = 100 * *bed.bar_tip;
  EXPECT_THROW(make_packing(deep, 3), CaseError);
}

TEST_F(PackingFile, AFileThatIsNotThereIsAFileError) {
  EXPECT_THROW(read_packing(folder / "none.csv", few()), FileError);
  EXPECT_THROW(read_packing(folder.path(), few()), FileError);
}

/// Two discs placed by hand, the second in flight.
Case placed(const nlohmann::json& changes = nlohmann::json::object()) {
  nlohmann::json root =
      small_json({{"packing", nullptr},
                  {"time", {{"rest_s", nullptr}}},
                  {"particles", {{"count", nullptr}, {"diameters_m", nullptr}, {"number_shares", nullptr}}}});
  root["particle"] = {{{"x_m", 0.03}, {"y_m", 0.002}, {"radius_m", 0.002}},
                      {{"x_m", 0.034},
                       {"y_m", 0.0023},
                       {"radius_m", 0.0025},
                       {"velocity_y_m_s", 0.1},
                       {"angular_velocity_rad_s", -3.0}}};
  root.merge_patch(changes);
  return read_case(root.dump());
}

TEST(PlacedParticles, StandInThePackingAsTheyAreGiven) {
  const Packing packing = make_packing(placed(), 7);
  EXPECT_EQ(packing.seed, 7U);
  EXPECT_EQ(packing.radius, (std::vector<double>{0.002, 0.0025}));
  EXPECT_EQ(packing.position[1], Vector2(0.034, 0.0023));
  EXPECT_EQ(packing.velocity[1], Vector2(0.0, 0.1));
  EXPECT_EQ(packing.spin[1], -3.0);
  EXPECT_EQ(packing.contacts, 1U);
  EXPECT_EQ(packing.settling, 0.0);
  EXPECT_NEAR(packing.bar_tip.value(), 0.0048, 1e-15) << "the bar touches the topmost of them";
  EXPECT_EQ(particles_of(packing, placed()).spin[1], -3.0);
}

TEST(PlacedParticles, TellTheirNumberAndDiametersThemselves) {
  const Case c = placed();
  EXPECT_EQ(c.particles.count, 2);
  EXPECT_EQ(c.particles.diameters, (std::vector<double>{0.004, 0.005}));
  EXPECT_EQ(c.time.rest, 0.0);
  EXPECT_EQ(canonical_json(read_case(canonical_json(c))), canonical_json(c));
  const auto refused = message_of<CaseError>([] { placed({{"particles", {{"count", 3}}}}); });
  EXPECT_EQ(refused.value_or(""),
            "particles: count, diameters_m and number_shares follow from the [[particle]] tables: leave them out");
  EXPECT_NE(message_of<CaseError>([] {
              placed({{"packing", {{"jitter_m", 0.0}}}});
            })
                .value_or("")
                .find("packing: unknown key"),
            std::string::npos);
}

TEST(PlacedParticles, NeedNoBar) {
  const Case c = placed({{"bar", nullptr}});
  EXPECT_FALSE(c.bar.has_value());
  EXPECT_FALSE(make_packing(c, 1).bar_tip.has_value());
}

TEST(PlacedParticles, ABarStartsWhereTheCaseSays) {
  EXPECT_EQ(make_packing(placed({{"bar", {{"tip_m", 0.01}}}}), 1).bar_tip, 0.01);
  const auto refused = message_of<CaseError>([] { placed({{"bar", {{"tip_m", 0.001}}}}); });
  EXPECT_EQ(refused.value_or("").substr(0, 54), "bar.tip_m: with its bottom face at 0.001 m particle 0 ");
}

TEST(PlacedParticles, ThatNoContactCouldPartAreAFault) {
  const auto disc = [](double x, double y) { return nlohmann::json{{"x_m", x}, {"y_m", y}, {"radius_m", 0.002}}; };
  const auto refused = [](const nlohmann::json& discs) {
    return message_of<CaseError>([&] { placed({{"particle", discs}, {"bar", nullptr}}); }).value_or("");
  };
  EXPECT_EQ(refused(nlohmann::json::array({disc(-0.01, 0.002)})),
            "particle[0]: its centre is not inside the container");
  EXPECT_EQ(refused(nlohmann::json::array({disc(0.01, 0.0)})), "particle[0]: its centre is not inside the container");
  EXPECT_EQ(refused({disc(0.01, 0.01), disc(0.02, 0.01), disc(0.01, 0.01)}),
            "particle[2]: its centre is that of particle[0]");
}

TEST(PlacedParticles, WithoutOneUnderTheBarItMustSayWhereItStarts) {
  const nlohmann::json aside = nlohmann::json::array({{{"x_m", 0.01}, {"y_m", 0.01}, {"radius_m", 0.002}}});
  EXPECT_EQ(message_of<CaseError>([&] {
              placed({{"particle", aside}});
            }).value_or(""),
            "bar.tip_m: no particle is under the bar for it to touch: say where it starts");
}

}  // namespace
}  // namespace crossdem::test
