// Any bytes in place of packing.csv and packing.json: refused by a CaseError, or read as a packing that is written and
// read the same again. An input holds the two files one after the other, parted by a line of the second one's name.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "crossdem/case.hpp"
#include "crossdem/packing.hpp"

namespace {

constexpr std::string_view parting = "packing.json:\n";

/// A folder of this process for the two files, which goes with it.
class Folder {
 public:
  Folder() : path(std::filesystem::temp_directory_path() / ("packing_fuzz-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path path;
};

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Two discs under a bar; or without the bar.
crossdem::Case small_case(bool with_bar) {
  crossdem::Case setup = crossdem::read_case(text_of(CROSSDEM_PACKING_CASE));
  if (!with_bar) setup.bar.reset();
  return setup;
}

void read_and_write_again(const std::filesystem::path& folder, const crossdem::Case& setup) {
  const std::filesystem::path csv = folder / "packing.csv";
  crossdem::Packing packing;
  try {
    packing = crossdem::read_packing(csv, setup);
  } catch (const crossdem::CaseError&) {
    return;
  }
  crossdem::write_packing(packing, folder);
  const std::string table = text_of(csv);
  const std::string facts = text_of(folder / "packing.json");
  crossdem::write_packing(crossdem::read_packing(csv, setup), folder);
  if (text_of(csv) != table || text_of(folder / "packing.json") != facts) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static const crossdem::Case with_bar = small_case(true);
  static const crossdem::Case without_bar = small_case(false);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find(parting), text.size());
  for (const crossdem::Case* setup : {&with_bar, &without_bar}) {
    std::ofstream(folder.path / "packing.csv", std::ios::binary) << text.substr(0, end);
    std::ofstream(folder.path / "packing.json", std::ios::binary)
        << text.substr(std::min(end + parting.size(), text.size()));
    read_and_write_again(folder.path, *setup);
  }
  return 0;
}
