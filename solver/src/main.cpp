// crossdem-solver: resolve a case, make a packing, run, measure how fast a run is.
// Exit 0 done, 1 something went wrong (such as a full disk), 2 bad input, 3 the motion is beyond reason: it is not
// finite, left the box, exploded or does not settle.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "batch/kernels.hpp"
#include "crossdem/measure.hpp"
#include "crossdem/run.hpp"
#include "crossdem/simulation.hpp"
#include "crossdem/version.hpp"
#include "run_folder.hpp"
#include "text_file.hpp"

namespace {

constexpr int exit_failed = 1;
constexpr int exit_bad_input = 2;
constexpr int exit_beyond_reason = 3;
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

/// Empty for a number of seconds, finite and not negative.
std::string seconds_fault(const std::string& text) {
  double seconds = 0.0;
  const bool is_sound = CLI::detail::lexical_cast(text, seconds) && std::isfinite(seconds) && seconds >= 0.0;
  return is_sound ? "" : text + " is no number of seconds; give 0 for at every output";
}

struct Arguments {
  std::string case_file;
  std::string shown_name;  // of the case, in messages
  std::string packing_file;
  std::string output;
  std::uint64_t seed = 1;
  std::optional<long> steps;
  std::size_t threads = 1;
  std::optional<double> checkpoint_every;  // [s]
};

void resolve(const Arguments& given) {
  std::cout << crossdem::canonical_json(load(given.case_file, given.shown_name)) << std::flush;
  if (!std::cout) throw crossdem::FileError("standard output", "cannot be written");
}

void pack(const Arguments& given) {
  const crossdem::Case setup = load(given.case_file, given.shown_name);
  crossdem::claim_folder(given.output);
  crossdem::write_packing(crossdem::make_packing(setup, given.seed, given.threads), given.output);
}

void run(const Arguments& given) {
  const crossdem::Case setup = load(given.case_file, given.shown_name);
  crossdem::Packing packing = crossdem::read_packing(given.packing_file, setup);
  crossdem::run(setup, std::move(packing), given.output, given.threads, given.checkpoint_every);
}

void measure(const Arguments& given) {
  const crossdem::Case setup = load(given.case_file, given.shown_name);
  crossdem::Packing packing = crossdem::read_packing(given.packing_file, setup);
  const crossdem::Measurement found = crossdem::measure(setup, std::move(packing), given.steps, given.threads);
  const nlohmann::json line = {{"steps", found.steps},
                               {"particles", found.particles},
                               {"wall_s", found.wall},
                               {"cpu_s", found.cpu},
                               {"peak_memory_bytes", found.peak_memory}};
  std::cout << line.dump() << std::endl;
  if (!std::cout) throw crossdem::FileError("standard output", "cannot be written");
}

int command_line(int argc, char** argv) {
  CLI::App app{"Native solver of crossdem: discs by the Distinct Element Method of Tanaka et al. (2000)"};
  app.set_version_flag("--version", crossdem::version_line());
  app.require_subcommand(1);

  Arguments given;
  void (*command)(const Arguments&) = nullptr;
  const auto add_command = [&](const char* name, const char* help, void (*function)(const Arguments&)) {
    CLI::App* added = app.add_subcommand(name, help);
    added->callback([&command, function] { command = function; });
    added->add_option("case", given.case_file, "case as JSON; - reads standard input")->required();
    added->add_option("--file-name", given.shown_name, "name of the case in messages");
    return added;
  };
  add_command("resolve", "print the complete case as canonical JSON", resolve);
  CLI::App* packer = add_command("pack", "settle a bed and write packing.csv and packing.json", pack);
  packer->add_option("--seed", given.seed, "seed of the random lattice");
  packer->add_option("--output", given.output, "folder to write into")->required();
  CLI::App* runner = add_command("run", "write motion.h5, resistance.csv, ledger.csv and, at the end, run.json", run);
  runner->add_option("--packing", given.packing_file, "packing.csv, with packing.json beside it")->required();
  runner->add_option("--output", given.output, "folder to write into")->required();
  runner
      ->add_option("--checkpoint-every", given.checkpoint_every,
                   "keep a checkpoint in the folder, renewed after so many seconds: a run that was cut short goes on "
                   "from there when the same command is given again, to the same bits")
      ->check(CLI::Validator([](const std::string& text) { return seconds_fault(text); }, "SECONDS>=0"));
  CLI::App* measurer = add_command("measure", "print as JSON how long the steps of a run take; write nothing", measure);
  measurer->add_option("--packing", given.packing_file, "packing.csv, with packing.json beside it")->required();
  measurer->add_option("--steps", given.steps, "only so many, from the first on")
      ->check(CLI::Range(0L, std::numeric_limits<long>::max()));
  const std::vector<std::string_view> here = crossdem::batch::instruction_sets();
  const std::vector<std::string> instruction_sets(here.begin(), here.end());
  for (CLI::App* stepping : {packer, runner, measurer}) {
    stepping
        ->add_option("--threads", given.threads, "at most so many, where the bed is large; the results are the same")
        ->check(CLI::Range(1, 1024));
    stepping
        ->add_option_function<std::string>("--instructions", crossdem::batch::use_instruction_set,
                                           "not the widest of this machine but these; the results are the same")
        ->check(CLI::IsMember(instruction_sets));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_bad_input;
  }
  if (given.shown_name.empty()) given.shown_name = given.case_file == "-" ? "standard input" : given.case_file;

  try {
    command(given);
    return 0;
  } catch (const crossdem::CaseError& error) {
    for (const std::string& fault : error.faults()) std::cerr << given.shown_name << ": " << fault << "\n";
    return exit_bad_input;
  } catch (const crossdem::WriteError&) {
    throw;
  } catch (const crossdem::FileError& error) {
    std::cerr << error.what() << "\n";
    return exit_bad_input;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto tell = [](const char* fault) {
    std::fputs((std::string("crossdem-solver: ") + fault + "\n").c_str(), stderr);
  };
  try {
    return command_line(argc, argv);
  } catch (const crossdem::SimulationError& error) {
    tell(error.what());
    return exit_beyond_reason;
  } catch (const std::exception& error) {
    tell(error.what());
  } catch (...) {
    tell("unknown fault");
  }
  return exit_failed;
}
