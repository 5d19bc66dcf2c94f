#pragma once
// How fast a run is: its stepping alone, by the clock.

#include <cstdint>
#include <optional>

#include "crossdem/packing.hpp"

namespace crossdem {

struct Measurement {
  long steps = 0;
  std::size_t particles = 0;
  double wall = 0.0;              // [s], of the steps: neither of reading the case and the packing nor of setting up
  double cpu = 0.0;               // [s], of all threads of the process, meanwhile
  std::uint64_t peak_memory = 0;  // [bytes] resident, of the process since it was started
};

/// Makes the steps of run(), or only the first `steps` of them, and writes nothing. Throws SimulationError as run()
/// does, CaseError where the case has fewer than `steps`.
Measurement measure(const Case& setup, Packing packing, std::optional<long> steps, std::size_t threads = 1);

}  // namespace crossdem
