#include "text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <sstream>

namespace crossdem {

std::string read_text(const std::filesystem::path& path, std::uintmax_t most_bytes) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > most_bytes)
    throw FileError(path, "is larger than " + std::to_string(most_bytes) + " bytes");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  const bool is_file = in && !std::filesystem::is_directory(path, error);
  if (is_file && in.peek() == std::ifstream::traits_type::eof() && !in.bad()) return {};  // as << finds nothing to do
  if (!is_file || in.bad() || !(text << in.rdbuf())) throw FileError(path, "cannot be read");
  return std::move(text).str();
}

std::string exact(double number) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  return {digits.data(), end};
}

Beginning beginning_of(const std::filesystem::path& path, std::uintmax_t bytes) {
  std::error_code error;
  Beginning found;
  if (!std::filesystem::is_regular_file(path, error)) return found;
  std::ifstream in(path, std::ios::binary);
  std::array<char, 1 << 16> block{};
  while (in && found.bytes < bytes) {
    in.read(block.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(block.size(), bytes - found.bytes)));
    found.add({block.data(), static_cast<std::size_t>(in.gcount())});
  }
  return found;
}

void cut_behind(const Beginning& kept, const std::filesystem::path& path) {
  if (kept.bytes == 0) return;
  std::error_code error;
  std::filesystem::resize_file(path, kept.bytes, error);
  if (error) throw FileError(path, "cannot be written: " + error.message());
}

void force_to_disk(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool forced = file >= 0 && fsync(file) == 0;
  if (file >= 0) close(file);
  if (!forced) throw WriteError(path, "cannot be forced to the disk");
}

LineFile::LineFile(std::filesystem::path path, const Beginning& kept) : path_(std::move(path)), written_(kept) {
  cut_behind(kept, path_);
  out_.open(path_, std::ios::binary | (kept.bytes > 0 ? std::ios::app : std::ios::trunc));
  if (!out_) throw FileError(path_, "cannot be written");
}

void LineFile::line(const std::string& text) {
  out_ << text << '\n' << std::flush;
  if (!out_) throw WriteError(path_, "cannot be written any further; is the disk full?");
  written_.add(text);
  written_.add("\n");
}

}  // namespace crossdem
