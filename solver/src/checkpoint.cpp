#include "checkpoint.hpp"

#include <fcntl.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <fstream>
#include <limits>
#include <sstream>

#include "archive.hpp"
#include "crossdem/version.hpp"
#include "text_file.hpp"

namespace crossdem {

template <class Archive>
void serialize(Archive& archive, Progress& p) {
  archive(p.rested, p.recorded, p.frames, p.samples, p.resistance_bytes, p.ledger_bytes);
}

namespace {

constexpr const char* file_name = "checkpoint";

std::uint64_t checksum(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

std::uint64_t checksum(const Packing& packing) {
  std::ostringstream bytes;
  OutArchive archive(bytes);
  archive(packing.radius, packing.position, packing.velocity, packing.spin, packing.bar_tip.value_or(0.0));
  return checksum(bytes.view());
}

/// What stands before the state.
struct Head {
  std::array<char, 16> mark{'c', 'r', 'o', 's', 's', 'd', 'e', 'm', ' ', 'r', 'u', 'n', ' ', ' ', '1', '\n'};
  std::uint64_t build = checksum(build_line());
  std::uint64_t setup = 0;
  std::uint64_t packing = 0;
  std::uint64_t bytes = 0;
  std::uint64_t state = 0;  // checksum

  using Bytes = std::array<char, 56>;
};
static_assert(sizeof(Head) == sizeof(Head::Bytes));

std::filesystem::path beside(const std::filesystem::path& path) { return path.string() + ".part"; }

void force_to_disk(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool forced = file >= 0 && fsync(file) == 0;
  if (file >= 0) close(file);
  if (!forced) throw WriteError(path, "cannot be forced to the disk");
}

}  // namespace

CheckpointFile::CheckpointFile(const std::filesystem::path& folder, const Case& setup, const Packing& packing)
    : path_(folder / file_name), case_(checksum(canonical_json(setup))), packing_(checksum(packing)) {}

bool CheckpointFile::is_in(const std::filesystem::path& folder) {
  std::error_code none;
  return std::filesystem::is_regular_file(folder / file_name, none);
}

std::string CheckpointFile::run() const {
  std::ostringstream name;
  name << std::hex << case_ << "-" << packing_;
  return name.str();
}

void CheckpointFile::remove_unfinished(const std::filesystem::path& folder) {
  std::error_code none;
  std::filesystem::remove(beside(folder / file_name), none);
}

void CheckpointFile::write(const Progress& progress, const Simulation& simulation) const {
  std::ostringstream state;
  OutArchive{state}(progress);
  simulation.save(state);
  Head head;
  head.setup = case_;
  head.packing = packing_;
  head.bytes = state.view().size();
  head.state = checksum(state.view());
  const auto head_bytes = std::bit_cast<Head::Bytes>(head);

  const std::filesystem::path part = beside(path_);
  std::ofstream out(part, std::ios::binary);
  out.write(head_bytes.data(), head_bytes.size());
  out.write(state.view().data(), static_cast<std::streamsize>(state.view().size()));
  out.close();
  if (!out) throw WriteError(part, "cannot be written; is the disk full?");
  force_to_disk(part);
  std::error_code error;
  std::filesystem::rename(part, path_, error);
  if (error) throw WriteError(path_, "cannot be put in its place: " + error.message());
}

void CheckpointFile::read(Progress& progress, Simulation& simulation) const {
  const auto refuse = [&](const std::string& why) {
    return FileError(path_, why + "; to start afresh, choose another folder or remove this one");
  };
  const std::string text = read_text(path_, std::numeric_limits<std::uintmax_t>::max());
  const auto damaged = [&] { return refuse("is damaged, the run cannot be carried on from it"); };
  if (text.size() < sizeof(Head)) throw damaged();
  Head::Bytes head_bytes{};
  std::copy_n(text.begin(), head_bytes.size(), head_bytes.begin());
  const Head head = std::bit_cast<Head>(head_bytes);
  const std::string_view state = std::string_view(text).substr(sizeof(Head));
  if (head.mark != Head{}.mark || head.bytes != state.size() || head.state != checksum(state)) throw damaged();
  if (head.build != Head{}.build) throw refuse("was written by another build of crossdem-solver");
  if (head.setup != case_) throw refuse("is of another case");
  if (head.packing != packing_) throw refuse("is of another packing");
  try {
    std::istringstream in{std::string(state)};
    InArchive{in}(progress);
    simulation.load(in);
  } catch (const cereal::Exception&) {
    throw damaged();
  }
}

void CheckpointFile::remove() const {
  std::error_code none;
  std::filesystem::remove(path_, none);
}

}  // namespace crossdem
