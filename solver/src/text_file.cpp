#include "text_file.hpp"

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

void cut_to(const std::filesystem::path& path, std::uintmax_t bytes) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size < bytes) throw FileError(path, "is not there as far as the checkpoint says");
  std::filesystem::resize_file(path, bytes, error);
  if (error) throw FileError(path, "cannot be written: " + error.message());
}

LineFile::LineFile(std::filesystem::path path, std::uintmax_t keep) : path_(std::move(path)), bytes_(keep) {
  if (keep > 0) cut_to(path_, keep);
  out_.open(path_, std::ios::binary | (keep > 0 ? std::ios::app : std::ios::trunc));
  if (!out_) throw FileError(path_, "cannot be written");
}

void LineFile::line(const std::string& text) {
  out_ << text << '\n' << std::flush;
  if (!out_) throw WriteError(path_, "cannot be written any further; is the disk full?");
  bytes_ += text.size() + 1;
}

}  // namespace crossdem
