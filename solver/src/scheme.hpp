#pragma once
// A scheme is a law and an integrator. One function turns its name into its type.

#include <stdexcept>

#include "laws/tanaka.hpp"
#include "step.hpp"

namespace crossdem {

/// `Choice`: DefaultReadings or Readings, see tanaka.hpp.
template <class Choice>
struct PaperScheme {
  using Integrator = AveragedDisplacement;
  TanakaLaw<Choice> law;
};

template <class Scheme>
void advance_forces_then_moves(World& world, const Scheme& scheme, long steps) {
  Step<Scheme> step(world, scheme);
  for (long n = 0; n < steps; ++n) step.forces_then_moves();
}

/// The function that advances a world by the scheme of the case.
inline auto advance_function(const SchemeChoice& choice) -> void (*)(World&, const Readings&, long) {
  if (choice.name != "paper") throw std::invalid_argument("no scheme \"" + choice.name + "\"");
  Readings only_start_differs = choice.readings;  // the first displacement concerns the start, not the law
  only_start_differs.initial_displacement = {};
  if (only_start_differs == Readings{}) {
    return [](World& world, const Readings&, long steps) {
      advance_forces_then_moves(world, PaperScheme<DefaultReadings>{}, steps);
    };
  }
  if (choice.readings.update_order == UpdateOrder::in_turn) {
    return [](World& world, const Readings& readings, long steps) {
      const PaperScheme<Readings> scheme{{readings}};
      Step<PaperScheme<Readings>> step(world, scheme);
      for (long n = 0; n < steps; ++n) step.in_turn();
    };
  }
  return [](World& world, const Readings& readings, long steps) {
    advance_forces_then_moves(world, PaperScheme<Readings>{{readings}}, steps);
  };
}

}  // namespace crossdem
