// Files that notice what went wrong.

#include "text_file.hpp"

#include <gtest/gtest.h>

#include "small_case.hpp"

namespace crossdem::test {
namespace {

TEST(TextFile, NumbersKeepAllTheirDigits) {
  for (const double number : {0.1, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 1e-4})
    EXPECT_EQ(std::strtod(exact(number).c_str(), nullptr), number);
}

TEST(TextFile, RefusesWhatIsTooLarge) {
  const TemporaryFolder folder;
  std::ofstream(folder / "large") << std::string(101, 'x');
  EXPECT_EQ(read_text(folder / "large", 101).size(), 101U);
  const auto message = message_of<FileError>([&] { read_text(folder / "large", 100); });
  ASSERT_TRUE(message.has_value());
  EXPECT_NE(message->find("is larger than 100 bytes"), std::string::npos);
}

TEST(TextFile, ReadsAnEmptyFileAsNoText) {
  const TemporaryFolder folder;
  std::ofstream(folder / "empty") << "";
  EXPECT_EQ(read_text(folder / "empty", 100), "");
}

TEST(TextFile, RefusesWhatCannotBeReadOrMade) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_text(folder / "none", 100), FileError);
  EXPECT_THROW(read_text(folder.path(), 100), FileError) << "a folder";
  EXPECT_THROW(read_text("/proc/self/mem", 100), FileError) << "which fails only when it is read";
  EXPECT_THROW(LineFile(folder / "none" / "file"), FileError);
}

TEST(TextFile, EachLineIsHandedOverAtOnce) {
  const TemporaryFolder folder;
  LineFile file(folder / "file");
  file.line("one");
  EXPECT_EQ(text_of(folder / "file"), "one\n") << "readers see it while the file is open";
  EXPECT_THROW(LineFile("/dev/full").line("one"), WriteError);
}

}  // namespace
}  // namespace crossdem::test
