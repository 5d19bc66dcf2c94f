// crossdem-solver: resolve a case, make a packing, run. Exit 0 done, 1 the run went wrong, 2 bad input.

#include <CLI/CLI.hpp>
#include <iostream>

#include "crossdem/run.hpp"
#include "crossdem/simulation.hpp"
#include "crossdem/version.hpp"
#include "text_file.hpp"

namespace {

constexpr int exit_failed = 1;
constexpr int exit_bad_input = 2;
constexpr std::uintmax_t most_case_bytes = 1 << 20;

std::string read_case_text(const std::string& file) {
  if (file != "-") return crossdem::read_text(file, most_case_bytes);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

/// Reads the case; its warnings go to stderr.
crossdem::Case load(const std::string& file, const std::string& shown_name) {
  crossdem::Case setup = crossdem::read_case(read_case_text(file));
  for (const std::string& warning : crossdem::warnings(setup))
    std::cerr << shown_name << ": warning: " << warning << "\n";
  return setup;
}

/// A folder that this call may write into: it is made, or exists and is empty.
void claim_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw crossdem::FileError(folder, "cannot be made: " + error.message());
  if (!std::filesystem::is_empty(folder, error) || error)
    throw crossdem::FileError(folder, "is not an empty folder; nothing was written");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Native solver of crossdem: discs by the Distinct Element Method of Tanaka et al. (2000)"};
  app.set_version_flag("--version", crossdem::version_line());
  app.require_subcommand(1);

  std::string case_file;
  std::string shown_name;
  std::string packing_file;
  std::string output;
  std::uint64_t seed = 1;
  const auto add_case = [&](CLI::App* command) {
    command->add_option("case", case_file, "case as JSON; - reads standard input")->required();
    command->add_option("--file-name", shown_name, "name of the case in messages");
  };
  CLI::App* resolve = app.add_subcommand("resolve", "print the complete case as canonical JSON");
  add_case(resolve);
  CLI::App* pack = app.add_subcommand("pack", "settle a bed and write packing.csv and packing.json");
  add_case(pack);
  pack->add_option("--seed", seed, "seed of the random lattice")
      ->check(CLI::Range(std::uint64_t{0}, ~std::uint64_t{0}));
  pack->add_option("--output", output, "folder to write into")->required();
  CLI::App* run = app.add_subcommand("run", "run the case and write motion.h5, resistance.csv, ledger.csv, run.json");
  add_case(run);
  run->add_option("--packing", packing_file, "packing.csv, with packing.json beside it")->required();
  run->add_option("--output", output, "folder to write into")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_bad_input;
  }

  if (shown_name.empty()) shown_name = case_file == "-" ? "standard input" : case_file;
  try {
    const crossdem::Case setup = load(case_file, shown_name);
    if (resolve->parsed()) {
      std::cout << crossdem::canonical_json(setup) << std::flush;
      if (!std::cout) throw crossdem::FileError("standard output", "cannot be written");
    } else if (pack->parsed()) {
      claim_folder(output);
      crossdem::write_packing(crossdem::make_packing(setup, seed), output);
    } else {
      const crossdem::Packing packing = crossdem::read_packing(packing_file, setup);
      claim_folder(output);
      crossdem::run(setup, packing, output);
    }
    return 0;
  } catch (const crossdem::CaseError& error) {
    for (const std::string& fault : error.faults()) std::cerr << shown_name << ": " << fault << "\n";
    return exit_bad_input;
  } catch (const crossdem::FileError& error) {
    std::cerr << error.what() << "\n";
    return exit_bad_input;
  } catch (const std::exception& error) {
    std::cerr << shown_name << ": " << error.what() << "\n";
    return exit_failed;
  }
}
