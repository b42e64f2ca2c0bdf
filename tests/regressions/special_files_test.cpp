// `smokemap ... -o /dev/null` put a regular file in the place of the device: write_file renamed over whatever was
// there.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "recording/file_bytes.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap {
namespace {

TEST(WritingToAPipe, FillsItAndLeavesItThere) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_THAT(write_file(path, std::string("through")), test::IsOk());
  char bytes[16] = {};
  EXPECT_EQ(::read(reader, bytes, sizeof bytes), 7);
  EXPECT_STREQ(bytes, "through");
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(WritingThroughALinkToADevice, LeavesBothThereAndTellsThatItIsFull) {
  const test::TemporaryFolder folder;
  const std::string null = folder.path() + "/null", full = folder.path() + "/full";
  std::filesystem::create_symlink("/dev/null", null);
  std::filesystem::create_symlink("/dev/full", full);
  EXPECT_THAT(write_file(null, std::string("anything")), test::IsOk());
  EXPECT_THAT(write_file(full, std::string("anything")), test::Fails(Errc::kIo));
  EXPECT_TRUE(std::filesystem::is_symlink(null));
  EXPECT_TRUE(std::filesystem::is_symlink(full));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(WritingToAFile, StillReplacesItWhole) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/file";
  EXPECT_THAT(write_file(path, std::string("a longer text")), test::IsOk());
  EXPECT_THAT(write_file(path, std::string("short")), test::IsOk());
  EXPECT_EQ(std::filesystem::file_size(path), 5u);
  EXPECT_THAT(write_file(folder.path() + "/none/file", std::string("x")), test::Fails(Errc::kIo));
}

}  // namespace
}  // namespace smokemap
