#pragma once
// A whole run of a case: rest, then penetration, recorded into a folder.

#include <filesystem>
#include <optional>

#include "crossdem/packing.hpp"

namespace crossdem {

/// Runs `setup` from `packing` and writes motion.h5, resistance.csv, ledger.csv and, when all is done, run.json into
/// `folder`, which is made, or is there and empty. Throws SimulationError or FileError; what was written until then
/// stays.
///
/// With `checkpoint_every` [s, of the clock on the wall, at the next output] the folder holds a checkpoint until the
/// run has ended: whatever cuts the run short, the same call of the same program then carries it on, to the same bits.
/// Once it has ended, the same call does nothing, or throws the same SimulationError; run.json tells which.
void run(const Case& setup, Packing packing, const std::filesystem::path& folder, std::size_t threads = 1,
         std::optional<double> checkpoint_every = std::nullopt);

}  // namespace crossdem
