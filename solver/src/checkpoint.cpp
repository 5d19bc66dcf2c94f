#include "checkpoint.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <streambuf>

#include "archive.hpp"

namespace crossdem {

template <class Archive>
void serialize(Archive& archive, FileMark& mark) {
  archive(mark.bytes, mark.checksum);
}

template <class Archive>
void serialize(Archive& archive, Progress& p) {
  archive(p.rested, p.recorded, p.frames, p.samples, p.resistance, p.ledger, p.spool);
}

namespace {

constexpr const char* file_name = "checkpoint";

std::uint64_t checksum(std::string_view bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.value();
}

std::uint64_t checksum(const Packing& packing) {
  Checksum sum;
  sum.add(packing.radius);
  sum.add(packing.position);
  sum.add(packing.velocity);
  sum.add(packing.spin);
  sum.add(std::vector{packing.bar_tip.value_or(0.0)});
  return sum.value();
}

/// Of the program that runs: its state and its bits are those of this build alone.
std::uint64_t checksum_of_program() {
  const Beginning program = beginning_of("/proc/self/exe", std::numeric_limits<std::uintmax_t>::max());
  if (program.bytes == 0) throw FileError("/proc/self/exe", "cannot be read");
  return program.checksum.value();
}

/// What stands before the state.
struct Head {
  std::array<char, 16> mark{'c', 'r', 'o', 's', 's', 'd', 'e', 'm', ' ', 'r', 'u', 'n', ' ', ' ', '2', '\n'};
  std::uint64_t program = 0;
  std::uint64_t setup = 0;
  std::uint64_t packing = 0;
  std::uint64_t bytes = 0;
  std::uint64_t state = 0;  // checksum

  using Bytes = std::array<char, 56>;
};
static_assert(sizeof(Head) == sizeof(Head::Bytes));

std::filesystem::path beside(const std::filesystem::path& path) { return path.string() + ".part"; }

/// To read what is in memory already.
struct InMemory : std::streambuf {
  explicit InMemory(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
};

}  // namespace

CheckpointFile::CheckpointFile(const std::filesystem::path& folder, const Case& setup, const Packing& packing)
    : path_(folder / file_name),
      case_(checksum(canonical_json(setup))),
      packing_(checksum(packing)),
      program_(checksum_of_program()) {}

bool CheckpointFile::is_in(const std::filesystem::path& folder) {
  std::error_code none;
  return std::filesystem::is_regular_file(folder / file_name, none);
}

bool CheckpointFile::was_begun() const {
  std::error_code error;
  const std::filesystem::path part = beside(path_);
  const auto files = std::filesystem::directory_iterator(path_.parent_path(), error);
  if (error || std::distance(begin(files), end(files)) != 1) return false;
  if (!std::filesystem::is_regular_file(part, error)) return false;
  const Head head;
  const std::uintmax_t size = std::filesystem::file_size(part, error);
  const std::string_view mark(head.mark.data(), std::min<std::uintmax_t>(size, head.mark.size()));
  return !error && beginning_of(part, mark.size()).checksum.value() == checksum(mark);
}

std::string CheckpointFile::run() const {
  std::ostringstream name;
  name << std::hex << case_ << "-" << packing_ << "-" << program_;
  return name.str();
}

void CheckpointFile::write(const Progress& progress, const Simulation& simulation) const {
  std::ostringstream state;
  OutArchive{state}(progress);
  simulation.save(state);
  Head head;
  head.setup = case_;
  head.packing = packing_;
  head.program = program_;
  head.bytes = state.view().size();
  head.state = checksum(state.view());
  const auto head_bytes = std::bit_cast<Head::Bytes>(head);

  const std::filesystem::path part = beside(path_);
  std::ofstream out(part, std::ios::binary);
  if (!out) throw FileError(part, std::string("cannot be written: ") + std::strerror(errno));
  out.write(head_bytes.data(), head_bytes.size());
  out.write(state.view().data(), static_cast<std::streamsize>(state.view().size()));
  out.close();
  std::error_code error;
  if (!out) {
    std::filesystem::remove(part, error);  // which makes room
    throw WriteError(part, "cannot be written; is the disk full?");
  }
  force_to_disk(part);
  std::filesystem::rename(part, path_, error);
  if (error) throw WriteError(path_, "cannot be put in its place: " + error.message());
  force_to_disk(path_.parent_path());
}

void CheckpointFile::read(Progress& progress, Simulation& simulation) const {
  const auto damaged = [&] { return refusal(path_, "is damaged"); };
  Head::Bytes head_bytes{};
  std::ifstream in(path_, std::ios::binary);
  in.read(head_bytes.data(), head_bytes.size());
  const Head head = std::bit_cast<Head>(head_bytes);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path_, error);
  if (!in || error || head.mark != Head{}.mark || size - sizeof(Head) != head.bytes) throw damaged();
  std::string state(head.bytes, '\0');
  in.read(state.data(), static_cast<std::streamsize>(state.size()));
  if (!in || head.state != checksum(state)) throw damaged();
  if (head.program != program_) throw refusal(path_, "was written by another build of crossdem-solver");
  if (head.setup != case_) throw refusal(path_, "is of another case");
  if (head.packing != packing_) throw refusal(path_, "is of another packing");
  InMemory bytes(state);
  std::istream from(&bytes);
  InArchive{from}(progress);
  simulation.load(from);
}

FileError CheckpointFile::refusal(const std::filesystem::path& file, const std::string& why) const {
  return {file, why + "; to start afresh, choose another folder, or remove " + path_.parent_path().string()};
}

void CheckpointFile::remove() const {
  std::error_code none;
  std::filesystem::remove(beside(path_), none);
  std::filesystem::remove(path_, none);
}

}  // namespace crossdem
