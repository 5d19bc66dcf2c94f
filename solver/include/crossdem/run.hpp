#pragma once
// A whole run of a case: rest, then penetration, recorded into a folder.

#include <filesystem>

#include "crossdem/packing.hpp"

namespace crossdem {

/// Runs `setup` from `packing` and writes motion.h5, resistance.csv, ledger.csv and, when all is done, run.json into
/// the existing `folder`. Throws SimulationError or FileError; what was written until then stays.
void run(const Case& setup, Packing packing, const std::filesystem::path& folder, std::size_t threads = 1);

}  // namespace crossdem
