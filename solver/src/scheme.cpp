#include "scheme.hpp"

#include <stdexcept>

#include "schemes/batched.hpp"
#include "schemes/liggghts_batches.hpp"
#include "schemes/paper_batches.hpp"
#include "schemes/yade_batches.hpp"

namespace crossdem {

namespace {

bool resists_rolling(const Case& setup) {
  return setup.particle_particle.rolling_friction > 0.0 || setup.particle_wall.rolling_friction > 0.0;
}

/// Of the discs that LIGGGHTS moves by `Motion`.
template <class Motion>
std::unique_ptr<Stepper> liggghts(const Case& setup, World& world) {
  if (!resists_rolling(setup)) return std::make_unique<BatchedStepper<LiggghtsBatches<Motion>>>(setup, world);
  return std::make_unique<ConventionalStepper<LiggghtsScheme<Motion>>>(setup, world);
}

}  // namespace

std::unique_ptr<Stepper> make_stepper(const Case& setup, World& world) {
  const SchemeChoice& choice = setup.scheme;
  if (choice.name == "paper") {
    Readings only_start_differs = choice.readings;  // these two concern the start, not the step
    only_start_differs.initial_displacement = {};
    only_start_differs.inertia = {};
    if (only_start_differs == Readings{}) {
      if (resists_rolling(setup)) return std::make_unique<BatchedStepper<PaperBatches<RollingScheme>>>(setup, world);
      return std::make_unique<BatchedStepper<PaperBatches<PaperScheme>>>(setup, world);
    }
    return std::make_unique<PaperStepper<MixedScheme>>(MixedScheme{{choice.readings}, {choice.readings.integrator}},
                                                       choice.readings, world);
  }
  if (choice.name == "liggghts") return liggghts<LiggghtsVerlet>(setup, world);
  if (choice.name == "liggghts_averaged") return liggghts<LiggghtsSetVelocities>(setup, world);
  if (choice.name == "yade") return std::make_unique<BatchedStepper<YadeBatches<YadeLeapFrog>>>(setup, world);
  if (choice.name == "yade_averaged")
    return std::make_unique<BatchedStepper<YadeBatches<YadeMemoryForce>>>(setup, world);
  throw std::invalid_argument("no scheme \"" + choice.name + "\"");
}

}  // namespace crossdem
