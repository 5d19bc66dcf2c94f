// The cell grid against all pairs, and the list against one that is made anew at every step.

#include "neighbours.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "schemes/paper.hpp"
#include "small_case.hpp"

namespace crossdem::test {
namespace {

std::vector<ParticlePair> brute_force(const Particles& p, double gap) {
  std::vector<ParticlePair> pairs;
  for (std::uint32_t i = 0; i < p.count(); ++i)
    for (std::uint32_t j = i + 1; j < p.count(); ++j)
      if ((p.position[i] - p.position[j]).norm() < p.radius[i] + p.radius[j] + gap) pairs.push_back({i, j});
  return pairs;
}

/// `count` discs of 4 and 5 mm at places that `place` makes of two random numbers in [0, 1).
Particles scattered(int count, const std::function<Vector2(double, double)>& place) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Particles p;
  for (int k = 0; k < count; ++k) {
    const double first = unit(random);
    const double second = unit(random);
    p.add(k % 2 == 0 ? small_radius : large_radius, small_mass, place(first, second), Vector2::Zero());
  }
  return p;
}

void expect_all_pairs(const Particles& p) {
  for (const double gap : {0.0, 0.0008, 0.01}) {
    const std::vector<ParticlePair> expected = brute_force(p, gap);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(close_pairs(p, gap), expected) << "gap " << gap;
  }
}

TEST(Neighbours, TheGridFindsAllPairsOfARandomBed) {
  expect_all_pairs(scattered(500, [](double a, double b) { return Vector2(0.15 * a, 0.12 * b); }));
}

TEST(Neighbours, TheGridFindsAllPairsOfACluster) {
  expect_all_pairs(scattered(200, [](double a, double b) { return Vector2(0.01 * a * a, 0.01 * b * b); }));
}

TEST(Neighbours, TheGridFindsAllPairsWhenAFewAreFarAway) {
  for (const Vector2& far : {Vector2(1e6, 0.1), Vector2(0.1, -1e6), Vector2(1e6, 1e6), Vector2(-1e300, 0.0)}) {
    Particles p = scattered(300, [](double a, double b) { return Vector2(0.1 * a, 0.1 * b); });
    p.add(small_radius, small_mass, far, Vector2::Zero());
    expect_all_pairs(p);
  }
}

TEST(Neighbours, TheGridFindsAllPairsOfASingleRowOrColumn) {
  expect_all_pairs(scattered(300, [](double a, double) { return Vector2(a, 0.05); }));
  expect_all_pairs(scattered(300, [](double a, double) { return Vector2(0.05, a); }));
}

TEST(Neighbours, NoParticleAndOneParticleHaveNoPairs) {
  EXPECT_TRUE(close_pairs({}, 1.0).empty());
  EXPECT_TRUE(close_pairs(small_disc({0.1, 0.1}, {0, 0}), 1.0).empty());
}

TEST(Neighbours, TouchingExactlyIsNotClose) {
  Particles p = small_disc({0.0, 0.0}, {0, 0});
  p.add(small_radius, small_mass, {0.004, 0.0}, Vector2::Zero());
  EXPECT_TRUE(close_pairs(p, 0.0).empty());
  EXPECT_EQ(close_pairs(p, 1e-9).size(), 1U);
}

/// A loose cloud with fast particles, which the bar enters fast.
Particles cloud() {
  Particles p;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 60; ++k) {
    const Vector2 node(0.004 + 0.0057 * (k % 10), 0.004 + 0.0057 * (k / 10));
    const double vx = unit(random);
    const double vy = unit(random);
    p.add(k % 2 == 0 ? small_radius : large_radius, k % 2 == 0 ? small_mass : large_mass, node, {vx, vy});
  }
  return p;
}

World world_of(const Case& c, Particles particles, double bar_tip) {
  World world = make_world(c, std::move(particles), bar_tip);
  world.kinetic_limit = 1.0;
  Particles& p = world.particles;
  for (std::size_t i = 0; i < p.count(); ++i) p.displacement[i] = p.velocity[i] * c.time.step;
  return world;
}

TEST(Neighbours, AListThatLastsGivesTheBitsOfOneMadeAnewEachStep) {
  Case c = small_case();
  c.bar->speed = 0.5;
  Simulation listed(c, cloud(), 0.045);
  World anew = world_of(c, cloud(), 0.045);
  PaperContacts<ContactSpring> only_overlapping(MemoryOwner::pair,
                                                ListSkin::fixed(0.0));  // made anew whenever anything has moved
  const PaperScheme scheme;
  Step<PaperScheme> step(anew, only_overlapping, scheme);
  listed.start_bar();
  anew.surfaces.bar->start();
  for (int n = 0; n < 600; ++n) {
    listed.advance(1);
    step.forces_then_moves();
    ASSERT_EQ(listed.particles().position, anew.particles.position) << "step " << n;
    ASSERT_EQ(listed.particles().spin, anew.particles.spin) << "step " << n;
    ASSERT_EQ(listed.bar_force().tip, anew.totals.on_bar.tip) << "step " << n;
    ASSERT_EQ(listed.bar_force().shaft, anew.totals.on_bar.shaft) << "step " << n;
  }
  EXPECT_LT(listed.bar_tip(), 0.016);
  EXPECT_GT(listed.contacts(), 20U);
}

TEST(Contacts, AContactKeepsItsSpringsWhenTheListIsMadeAnew) {
  Particles p = small_disc({0.03, 0.0019}, {0, 0});
  p.add(small_radius, small_mass, {0.0339, 0.0019}, Vector2::Zero());
  const Surfaces surfaces{.width = 0.06, .bar = {}};
  PaperContacts<ContactSpring> contacts(MemoryOwner::pair, ListSkin::fixed(0.001));
  contacts.rebuild(p, surfaces);
  contacts.pairs().at(0).memory = {1.0, 2.0};
  contacts.on_surfaces().at(1).memory = {3.0, 4.0};
  p.add(small_radius, small_mass, {0.026, 0.0019}, Vector2::Zero());  // a new neighbour of the first
  contacts.rebuild(p, surfaces);
  ASSERT_EQ(contacts.pairs().size(), 2U);
  EXPECT_EQ(contacts.pairs()[0].memory.shear, 2.0);
  EXPECT_FALSE(contacts.pairs()[1].memory.touching());
  EXPECT_EQ(contacts.on_surfaces().at(1).memory.normal, 3.0);
  EXPECT_FALSE(contacts.on_surfaces().at(2).memory.touching());
}

TEST(Contacts, TheListIsOutdatedBeforeTwoSurfacesCanHaveMetUnseen) {
  Particles p = small_disc({0.03, 0.02}, {0, 0});
  Surfaces surfaces{.width = 0.06, .bar = Bar({.width = 0.01, .length = 0.1, .centre_x = 0.03, .speed = 1.0}, 0.04)};
  PaperContacts<ContactSpring> contacts(MemoryOwner::pair, ListSkin::fixed(0.001));
  EXPECT_TRUE(contacts.outdated(p, surfaces)) << "there is no list yet";
  contacts.rebuild(p, surfaces);
  p.position[0].x() += 0.00049;  // two particles may have approached by twice this
  EXPECT_FALSE(contacts.outdated(p, surfaces));
  p.position[0].x() += 0.00002;
  EXPECT_TRUE(contacts.outdated(p, surfaces));
  contacts.rebuild(p, surfaces);
  surfaces.bar->start();
  surfaces.bar->advance(0.0009);
  EXPECT_FALSE(contacts.outdated(p, surfaces));
  p.position[0].x() += 0.0002;  // bar and particle together exceed the skin
  EXPECT_TRUE(contacts.outdated(p, surfaces));
}

}  // namespace
}  // namespace crossdem::test
