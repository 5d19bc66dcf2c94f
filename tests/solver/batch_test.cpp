// Eight pairs and particles at a time give the bits of the plain steps, on every set of instructions.

#include <gtest/gtest.h>

#include <random>

#include "schemes/batched.hpp"
#include "schemes/liggghts_batches.hpp"
#include "schemes/paper_batches.hpp"
#include "schemes/yade_batches.hpp"
#include "small_case.hpp"

namespace crossdem::test {
namespace {

struct Start {
  const char* name;
  Case setup;
  Particles particles;
  std::optional<double> bar_tip;
  long steps;
};

/// Discs apart from one another that fly about: contacts come and go.
Particles gas(std::size_t count) {
  std::mt19937_64 random(count);
  const auto within = [&](double half_width) {
    return half_width * (2.0 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1.0);
  };
  Particles particles;
  for (std::size_t i = 0; i < count; ++i) {
    const bool small = i % 3 == 0;
    const Vector2 node(0.005 + 0.006 * static_cast<double>(i % 8), 0.005 + 0.006 * static_cast<double>(i / 8));
    particles.add(small ? small_radius : large_radius, small ? small_mass : large_mass,
                  node + Vector2(within(0.0004), within(0.0004)), Vector2(within(0.5), within(0.5)));
    particles.spin.back() = within(50.0);
  }
  return particles;
}

std::vector<Start> made_starts() {
  std::vector<Start> all;
  for (const std::size_t count : {1, 2, 7, 8, 9, 100})
    all.push_back({"gas", small_case(), gas(count), std::nullopt, 1000});
  all.push_back({"weightless gas", weightless(), gas(64), std::nullopt, 1000});
  const Case fast = small_case({{"bar", {{"speed_m_s", 0.1}}}});
  const Packing bed = make_packing(fast, 1);
  all.push_back({"bar", fast, particles_of(bed, fast), bed.bar_tip, 1500});
  // Two discs that lie in one another fly apart within the first steps, further than a list is good for.
  Particles burst = particles_of(bed, fast);
  for (const double x : {0.029, 0.030}) burst.add(large_radius, large_mass, {x, 0.2}, Vector2::Zero());
  all.push_back({"burst", fast, burst, std::nullopt, 100});
  return all;
}

const std::vector<Start>& starts() {
  static const std::vector<Start> all = made_starts();
  return all;
}

/// With joints, of which some break.
std::vector<Start> joined(std::vector<Start> all) {
  for (Start& start : all) start.setup.particle_particle.tensile_strength = 0.02;
  return all;
}

std::vector<Start> rolling(std::vector<Start> all) {
  for (Start& start : all)
    start.setup.particle_particle.rolling_friction = start.setup.particle_wall.rolling_friction = 0.1;
  return all;
}

/// Everything that can be seen of a world, as one list of numbers.
std::vector<double> state_of(const World& w, const Stepper& stepper) {
  std::vector<double> all;
  const Particles& p = w.particles;
  for (std::size_t i = 0; i < p.count(); ++i)
    for (const double x :
         {p.position[i].x(), p.position[i].y(), p.velocity[i].x(), p.velocity[i].y(), p.displacement[i].x(),
          p.displacement[i].y(), p.angle[i], p.spin[i], p.rotation[i], w.contact_work[i]})
      all.push_back(x);
  for (const Vector2& force : w.totals.force) all.insert(all.end(), {force.x(), force.y()});
  for (const Vector2& v : {w.totals.on_bar.tip, w.totals.on_bar.shaft, w.momentum_ledger.floor, w.momentum_ledger.bar,
                           w.momentum_ledger.left_wall, w.momentum_ledger.right_wall})
    all.insert(all.end(), {v.x(), v.y()});
  all.insert(all.end(), {w.energy_ledger.bar_work, stepper.spring_energy(w), static_cast<double>(w.steps)});
  return all;
}

template <class AnyStepper>
std::vector<double> after(const Start& start, std::size_t threads = 1) {
  World w = make_world(start.setup, start.particles, start.bar_tip);
  w.kinetic_limit = std::numeric_limits<double>::infinity();
  w.threads = threads;
  AnyStepper stepper(start.setup, w);
  stepper.advance(w, start.steps / 4);
  if (w.surfaces.bar) w.surfaces.bar->start();
  stepper.advance(w, start.steps - start.steps / 4);
  return state_of(w, stepper);
}

template <class Scheme>
class PlainPaper final : public Stepper {
 public:
  PlainPaper(const Case& setup, World& world) : stepper_(PaperBatches<Scheme>::plain(setup, world)) {}
  void advance(World& world, long steps) override { stepper_.advance(world, steps); }
  [[nodiscard]] double spring_energy(const World& world) const override { return stepper_.spring_energy(world); }
  void save(OutArchive& archive) override { stepper_.save(archive); }
  void load(InArchive& archive) override { stepper_.load(archive); }

 private:
  PaperStepper<Scheme> stepper_;
};

class Batches : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override { batch::use_instruction_set(GetParam()); }
  void TearDown() override { batch::use_instruction_set(batch::instruction_sets().front()); }

  template <class Scheme, class Plain>
  static void give_the_bits_of() {
    give_the_bits_from<Scheme, Plain>(starts());
  }

  template <class Scheme, class Plain>
  static void give_the_bits_from(const std::vector<Start>& all) {
    EXPECT_EQ(batch::instruction_set(), GetParam());
    for (const Start& start : all) {
      EXPECT_EQ(after<Plain>(start), after<BatchedStepper<Scheme>>(start))
          << start.name << " of " << start.particles.count();
    }
  }
};

TEST_P(Batches, GiveTheBitsOfPlainStepsEqs1To24) {
  give_the_bits_of<PaperBatches<PaperScheme>, PlainPaper<PaperScheme>>();
}

TEST_P(Batches, GiveTheBitsOfPlainStepsWithJoints) {
  give_the_bits_from<PaperBatches<PaperScheme>, PlainPaper<PaperScheme>>(joined(starts()));
}

TEST_P(Batches, GiveTheBitsOfPlainStepsWithRollingResistance) {
  give_the_bits_from<PaperBatches<RollingScheme>, PlainPaper<RollingScheme>>(rolling(starts()));
}

TEST_P(Batches, GiveTheBitsOfPlainStepsWithJointsAndRollingResistance) {
  give_the_bits_from<PaperBatches<RollingScheme>, PlainPaper<RollingScheme>>(rolling(joined(starts())));
}

TEST_P(Batches, GiveTheBitsOfPlainStepsOfLiggghts) {
  give_the_bits_of<LiggghtsBatches<LiggghtsVerlet>, ConventionalStepper<LiggghtsScheme<LiggghtsVerlet>>>();
}

TEST_P(Batches, GiveTheBitsOfPlainStepsOfLiggghtsWithVelocitiesThatAreSet) {
  give_the_bits_of<LiggghtsBatches<LiggghtsSetVelocities>,
                   ConventionalStepper<LiggghtsScheme<LiggghtsSetVelocities>>>();
}

TEST_P(Batches, GiveTheBitsOfPlainStepsOfYade) {
  give_the_bits_of<YadeBatches<YadeLeapFrog>, ConventionalStepper<YadeScheme<YadeLeapFrog>>>();
}

TEST_P(Batches, GiveTheBitsOfPlainStepsOfYadeWithAMemoryForce) {
  give_the_bits_of<YadeBatches<YadeMemoryForce>, ConventionalStepper<YadeScheme<YadeMemoryForce>>>();
}

INSTANTIATE_TEST_SUITE_P(OnThisMachine, Batches, testing::ValuesIn(batch::instruction_sets()),
                         [](const auto& of) { return std::string(of.param); });

template <class Scheme, class Plain>
void threads_give_the_bits_of() {
  const Particles many = gas(20000);  // of which each of four threads has its share
  const Start start{"gas", small_case(), many, std::nullopt, 60};
  const std::vector<double> plain = after<Plain>(start);
  for (const std::size_t threads : {1, 2, 3, 4})
    EXPECT_EQ(plain, after<BatchedStepper<Scheme>>(start, threads)) << threads;
}

TEST(Threads, GiveTheBitsOfOne) { threads_give_the_bits_of<PaperBatches<PaperScheme>, PlainPaper<PaperScheme>>(); }

TEST(Threads, GiveTheBitsOfOneByTheSchemeOfLiggghts) {
  threads_give_the_bits_of<LiggghtsBatches<LiggghtsVerlet>, ConventionalStepper<LiggghtsScheme<LiggghtsVerlet>>>();
}

TEST(Threads, GiveTheBitsOfOneByTheSchemeOfLiggghtsWithVelocitiesThatAreSet) {
  threads_give_the_bits_of<LiggghtsBatches<LiggghtsSetVelocities>,
                           ConventionalStepper<LiggghtsScheme<LiggghtsSetVelocities>>>();
}

TEST(Threads, GiveTheBitsOfOneByTheSchemeOfYade) {
  threads_give_the_bits_of<YadeBatches<YadeLeapFrog>, ConventionalStepper<YadeScheme<YadeLeapFrog>>>();
}

TEST(Threads, GiveTheBitsOfOneByTheSchemeOfYadeWithAMemoryForce) {
  threads_give_the_bits_of<YadeBatches<YadeMemoryForce>, ConventionalStepper<YadeScheme<YadeMemoryForce>>>();
}

TEST(InstructionSets, RefuseWhatIsNotHere) {
  EXPECT_THROW(batch::use_instruction_set("AVX-4096"), std::invalid_argument);
  EXPECT_FALSE(batch::instruction_sets().empty());
}

}  // namespace
}  // namespace crossdem::test
