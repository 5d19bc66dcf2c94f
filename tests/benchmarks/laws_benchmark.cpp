// One contact by each law.

#include <cmath>
#include <numbers>
#include <random>

#include "bed.hpp"
#include "laws/liggghts_hooke.hpp"
#include "laws/tanaka.hpp"
#include "laws/yade_viscel.hpp"

namespace crossdem::benchmarks {
namespace {

constexpr double dt = 1e-4;  // [s]

struct Contact {
  Vector2 normal;       // from i to j
  double overlap;       // [m]
  Vector2 velocity;     // [m/s], of i relative to j at the contact
  double shear_spring;  // [N]

  [[nodiscard]] Vector2 tangent() const { return {-normal.y(), normal.x()}; }
};

const ContactParameters& parameters() {
  static const ContactParameters paper = test::small_case().particle_particle;
  return paper;
}

/// As many as stay in the nearest cache; a tenth of them slip.
std::vector<Contact> contacts() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Contact> all;
  for (int k = 0; k < 256; ++k) {
    const double angle = 2 * std::numbers::pi * unit(random);
    const double overlap = 1e-4 * unit(random);
    const Vector2 velocity(0.01 * (unit(random) - 0.5), 0.01 * (unit(random) - 0.5));
    const double cap = parameters().friction * parameters().normal_stiffness * overlap;
    all.push_back({{std::cos(angle), std::sin(angle)}, overlap, velocity, cap * (2 * unit(random) - 1) / 0.9});
  }
  return all;
}

/// `law` works on what `prepare` makes of a contact, each time on a fresh copy: springs do not run away.
template <class Prepare, class Law>
void evaluate(benchmark::State& state, Prepare prepare, Law law) {
  std::vector<std::invoke_result_t<Prepare, const Contact&>> prepared;
  for (const Contact& contact : contacts()) prepared.push_back(prepare(contact));
  for (auto _ : state) {
    for (auto contact : prepared) {
      law(contact);
      benchmark::DoNotOptimize(contact);
    }
  }
  report(state, "contact", prepared.size());
}

void tanaka(benchmark::State& state) {
  struct Prepared {
    RelativeDisplacement moved;
    ContactSpring spring;
    ContactForce force;
  };
  const auto prepare = [](const Contact& c) {
    const double normal = c.velocity.dot(c.normal) * dt;
    const double shear = c.velocity.dot(c.tangent()) * dt;
    return Prepared{
        {normal, shear, c.overlap, normal, shear}, {parameters().normal_stiffness * c.overlap, c.shear_spring}, {}};
  };
  evaluate(state, prepare,
           [](Prepared& c) { c.force = TanakaLaw<DefaultReadings>{}.force(c.moved, parameters(), dt, c.spring); });
}
BENCHMARK(tanaka);

void liggghts_hooke(benchmark::State& state) {
  struct Prepared {
    HookeApproach approach;
    Vector2 shear;
    HookeReaction reaction;
  };
  const auto prepare = [](const Contact& c) {
    const double distance = test::small_radius + test::large_radius - c.overlap;
    return Prepared{{-distance * c.normal, 1.0 / distance, c.overlap, c.velocity, 0.0},
                    c.shear_spring / parameters().shear_stiffness * c.tangent(),
                    {}};
  };
  evaluate(state, prepare, [](Prepared& c) {
    c.reaction = crossdem::liggghts_hooke(c.approach, parameters(), dt, false, true, c.shear);
  });
}
BENCHMARK(liggghts_hooke);

void yade_viscel(benchmark::State& state) {
  struct Prepared {
    Contact contact;
    ViscElMemory memory;
    Vector2 force;
  };
  const auto prepare = [](const Contact& c) {
    return Prepared{c, {c.shear_spring * c.tangent(), c.normal, true}, Vector2::Zero()};
  };
  evaluate(state, prepare, [](Prepared& c) {
    crossdem::yade_viscel(c.contact.normal, c.contact.overlap, c.contact.velocity, parameters(), dt, c.memory, c.force);
  });
}
BENCHMARK(yade_viscel);

}  // namespace
}  // namespace crossdem::benchmarks
