// What a run leaves behind.

#include "recorder.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>

#include "crossdem/run.hpp"
#include "small_case.hpp"

/// HDF5 1.10 loses a block of its own when a file on a full disk cannot be written.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the name that the leak sanitizer asks for
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace crossdem::test {
namespace {

/// A motion.h5 opened for reading.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path) : id_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Hdf5File() { H5Fclose(id_); }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  [[nodiscard]] std::vector<hsize_t> shape(const char* name) const {
    const hid_t set = H5Dopen2(id_, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    std::vector<hsize_t> sizes(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
    H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return sizes;
  }

  [[nodiscard]] std::vector<double> numbers(const char* name) const {
    std::size_t count = 1;
    for (const hsize_t size : shape(name)) count *= size;
    std::vector<double> values(count);
    const hid_t set = H5Dopen2(id_, name, H5P_DEFAULT);
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Dclose(set);
    return values;
  }

  [[nodiscard]] std::string text(const char* object, const char* attribute) const {
    const hid_t at = H5Aopen_by_name(id_, object, attribute, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(at);
    std::string value(H5Tget_size(type) * static_cast<std::size_t>(H5Aget_storage_size(at) / H5Tget_size(type)), ' ');
    EXPECT_GE(H5Aread(at, type, value.data()), 0) << object << " " << attribute;
    H5Tclose(type);
    H5Aclose(at);
    return value;
  }

  [[nodiscard]] std::array<int, 2> version() const {
    std::array<int, 2> value{};
    const hid_t at = H5Aopen_by_name(id_, "/h5md", "version", H5P_DEFAULT, H5P_DEFAULT);
    H5Aread(at, H5T_NATIVE_INT, value.data());
    H5Aclose(at);
    return value;
  }

 private:
  hid_t id_;
};

/// 60 particles, 0.2 s: 21 samples, 3 frames.
Case short_case() { return small_case({{"particles", {{"count", 60}}}}); }

class Recorded : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    bed = make_packing(short_case(), 4);
    folder = std::make_unique<TemporaryFolder>();
    run(short_case(), bed, folder->path());
  }
  static void TearDownTestSuite() { folder.reset(); }
  inline static Packing bed;
  inline static std::unique_ptr<TemporaryFolder> folder;
};

std::vector<double> numbers_of(const std::string& row) {
  std::vector<double> numbers;
  std::istringstream fields(row);
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  return numbers;
}

TEST_F(Recorded, MotionHasThePathsAndUnitsOfH5md) {
  const Hdf5File motion(*folder / "motion.h5");
  EXPECT_EQ(motion.version(), (std::array<int, 2>{1, 1}));
  EXPECT_EQ(motion.text("/h5md/creator", "name"), "native");
  EXPECT_EQ(motion.text("/h5md/author", "name"), "crossdem");
  EXPECT_EQ(motion.text("/particles/soil/box", "boundary"), "nonenone");
  using Shape = std::vector<hsize_t>;
  EXPECT_EQ(motion.shape("/particles/soil/position/value"), (Shape{3, 60, 2}));
  EXPECT_EQ(motion.shape("/particles/soil/velocity/value"), (Shape{3, 60, 2}));
  EXPECT_EQ(motion.shape("/particles/soil/angle/value"), (Shape{3, 60}));
  EXPECT_EQ(motion.shape("/particles/soil/angular_velocity/value"), (Shape{3, 60}));
  EXPECT_EQ(motion.shape("/observables/bar/tip/value"), (Shape{3}));
  EXPECT_EQ(motion.shape("/particles/soil/radius"), (Shape{60}));
  EXPECT_EQ(motion.text("/particles/soil/position/value", "unit"), "m");
  EXPECT_EQ(motion.text("/particles/soil/velocity/value", "unit"), "m s-1");
  EXPECT_EQ(motion.text("/particles/soil/angle/value", "unit"), "rad");
  EXPECT_EQ(motion.text("/particles/soil/angular_velocity/value", "unit"), "rad s-1");
  EXPECT_EQ(motion.text("/particles/soil/position/time", "unit"), "s");
  EXPECT_EQ(motion.text("/particles/soil/box/edges", "unit"), "m");
}

TEST_F(Recorded, MotionHoldsTheParticlesOfThePacking) {
  const Hdf5File motion(*folder / "motion.h5");
  EXPECT_EQ(motion.numbers("/particles/soil/radius"), bed.radius);
  EXPECT_EQ(motion.numbers("/particles/soil/id").back(), 59.0);
  EXPECT_EQ(motion.numbers("/particles/soil/box/edges"), (std::vector<double>{0.06, 0.15}));
  const std::vector<double> position = motion.numbers("/particles/soil/position/value");
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_NEAR(position[2 * i], bed.position[i].x(), 1e-4) << "the bed rested";
    EXPECT_NEAR(position[2 * i + 1], bed.position[i].y(), 1e-4);
  }
  for (const char* element : {"/particles/soil/velocity", "/observables/bar/tip"}) {
    EXPECT_EQ(motion.numbers((std::string(element) + "/step").c_str()), (std::vector<double>{0, 1000, 2000}));
    EXPECT_EQ(motion.numbers((std::string(element) + "/time").c_str()), (std::vector<double>{0.0, 0.1, 0.2}));
  }
  const std::vector<double> tip = motion.numbers("/observables/bar/tip/value");
  EXPECT_EQ(tip[0], bed.bar_tip);
  EXPECT_NEAR(tip[2], *bed.bar_tip - 0.002, 1e-15);
}

TEST_F(Recorded, TablesHaveTheirColumnsAndARowPerSample) {
  const std::vector<std::string> resistance = lines_of(*folder / "resistance.csv");
  ASSERT_EQ(resistance.size(), 22U);
  EXPECT_EQ(resistance[0],
            "time_s,depth_m,force_x_N,force_y_N,tip_force_y_N,shaft_force_y_N,floor_force_y_N,contacts,"
            "kinetic_energy_J");
  const std::vector<std::string> ledger = lines_of(*folder / "ledger.csv");
  ASSERT_EQ(ledger.size(), 22U);
  EXPECT_EQ(numbers_of(ledger[1]).size(), 22U);
  EXPECT_EQ(std::count(ledger[0].begin(), ledger[0].end(), ','), 21);
  bool pushed = false;
  for (std::size_t k = 1; k < resistance.size(); ++k) {
    const std::vector<double> row = numbers_of(resistance[k]);
    ASSERT_EQ(row.size(), 9U);
    EXPECT_NEAR(row[0], 0.01 * static_cast<double>(k - 1), 1e-15);
    EXPECT_NEAR(row[1], 0.01 * row[0], 1e-16);
    EXPECT_NEAR(row[3], row[4] + row[5], 1e-15) << "tip and shaft";
    EXPECT_LT(row[6], 0.0) << "the bed lies on the floor";
    EXPECT_GT(row[7], 50.0);
    EXPECT_GT(row[8], 0.0);
    pushed = pushed || row[3] > 0.01;
    const std::vector<double> account = numbers_of(ledger[k]);
    EXPECT_EQ(account[0], row[0]);
    for (const std::size_t axis : {1U, 2U}) {  // left and right wall, floor, bar, weight add up to the change
      double received = 0.0;
      for (std::size_t entry = axis + 2; entry < axis + 12; entry += 2) received += account[entry];
      EXPECT_NEAR(received, account[axis], 1e-15);
      EXPECT_LT(std::abs(account[axis + 12]), 1e-15) << "momentum residual";
    }
    EXPECT_EQ(account[15], row[8]) << "kinetic energy";
  }
  EXPECT_TRUE(pushed);
}

TEST_F(Recorded, RunJsonSaysThatAllIsDone) {
  const nlohmann::json done = nlohmann::json::parse(text_of(*folder / "run.json"));
  EXPECT_EQ(done.at("completed"), true);
  EXPECT_EQ(done.at("rest_steps"), 1000);
  EXPECT_EQ(done.at("penetration_steps"), 2000);
  EXPECT_EQ(done.at("particles"), 60);
  EXPECT_EQ(done.at("frames"), 3);
  EXPECT_EQ(done.at("samples"), 21);
}

TEST_F(Recorded, EqualRunsGiveEqualBytes) {
  const TemporaryFolder again;
  run(short_case(), bed, again.path());
  for (const char* file : {"resistance.csv", "ledger.csv", "run.json"})
    EXPECT_EQ(text_of(again / file), text_of(*folder / file)) << file;
  EXPECT_EQ(Hdf5File(again / "motion.h5").numbers("/particles/soil/position/value"),
            Hdf5File(*folder / "motion.h5").numbers("/particles/soil/position/value"));
}

TEST_F(Recorded, AFolderThatIsNotEmptyIsAFileError) {
  const std::string before = text_of(*folder / "resistance.csv");
  EXPECT_THROW(run(short_case(), bed, folder->path()), FileError);
  EXPECT_EQ(text_of(*folder / "resistance.csv"), before);
}

TEST_F(Recorded, AFullDiskIsAWriteErrorThatNamesTheFile) {
  const TemporaryFolder full;
  const std::filesystem::path path = full / "file";
  std::filesystem::create_symlink("/dev/full", path);
  const auto said = [&](auto write) { return message_of<WriteError>(write).value_or("nothing"); };
  const std::string expected = path.string() + ": cannot be written any further; is the disk full?";
  EXPECT_EQ(said([&] { ResistanceFile file(path); }), expected);
  EXPECT_EQ(said([&] { LedgerFile file(path); }), expected);
  EXPECT_EQ(said([&] {
              MotionFile(path, short_case(), small_disc({0.03, 0.03}, {0, 0}));
            }),
            path.string() + ": HDF5 could not write it; is the disk full?");
}

TEST(ResistanceFile, ARowHoldsTheForceOnTheBarAsASumAndInItsParts) {
  Particles p = small_disc({0.03, 0.0981}, Vector2::Zero());            // under the bar, e_n = 0.1 N
  p.add(small_radius, small_mass, {0.0231, 0.12}, Vector2(0.0, -0.1));  // rubs its left side downwards
  Case c = small_case({{"gravity_m_s2", 0.0}});
  Simulation s(c, p, 0.1);
  s.advance(1);
  const TemporaryFolder folder;
  ResistanceFile(folder / "resistance.csv").row(0.5, 0.005, s);
  const std::vector<double> row = numbers_of(lines_of(folder / "resistance.csv").at(1));
  // shaft: e_s = 250 x -1e-5, dashpot 0.387 x -0.1
  const double expected[] = {0.5, 0.005, 0.1, 0.1 - 0.0412, 0.1, -0.0412, 0.0, 0.0};
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(row.at(k), expected[k], 1e-12) << "column " << k;
  EXPECT_NEAR(row.at(8), kinetic_energy(s.particles()), 0.0);
}

TEST(ResistanceFile, ADiscThatLiesOnTheFloorPushesItDownByItsWeight) {
  const Case c = small_case();
  Simulation s(c, small_disc({0.03, small_radius - small_mass * c.gravity / 1000}, {0, 0}), std::nullopt);
  s.advance(1);
  const TemporaryFolder folder;
  ResistanceFile(folder / "resistance.csv").row(0.0, 0.0, s);
  EXPECT_NEAR(numbers_of(lines_of(folder / "resistance.csv").at(1)).at(6), -small_mass * c.gravity, 1e-12);
}

}  // namespace
}  // namespace crossdem::test
