#pragma once
// A whole run of a case: rest, then penetration, recorded into a folder.

#include <filesystem>
#include <optional>

#include "crossdem/packing.hpp"

namespace crossdem {

/// Runs `setup` from `packing` and writes motion.h5, resistance.csv, ledger.csv and, when all is done, run.json into
/// the existing `folder`. Throws SimulationError or FileError; what was written until then stays.
///
/// With `checkpoint_every` [s, of the clock on the wall, at the next output] the folder holds a checkpoint until the
/// run has ended: whatever cuts the run short, the same call then carries it on, to the same bits.
void run(const Case& setup, Packing packing, const std::filesystem::path& folder, std::size_t threads = 1,
         std::optional<double> checkpoint_every = std::nullopt);

/// Whether `folder` holds a run that was cut short and can be carried on, or that has ended, with which the call above
/// has nothing to do if it is the same. A checkpoint that was cut short itself is removed: the first one is there
/// before all other files.
bool can_be_carried_on(const std::filesystem::path& folder);

}  // namespace crossdem
