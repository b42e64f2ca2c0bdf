#include "server/store/file_store.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(FileStore, GivesBackWhatWasPutByItsHashOnly) {
  const test::TemporaryFolder folder;
  const auto files = FileStore::open(folder.path() + "/files");
  ASSERT_THAT(files, test::IsOk());
  const std::string bytes("\0picture\xff", 9);
  const auto sha = files->put(bytes);
  ASSERT_THAT(sha, test::IsOk());
  EXPECT_EQ(*files->put(bytes), *sha);
  EXPECT_EQ(*files->get(*sha), bytes);
  for (const char* name :
       {"", "../smokemap.db", "ABC", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"})
    EXPECT_THAT(files->get(name), test::Fails(Errc::kNotFound)) << name;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path() + "/files"), {}), 1)
      << "nothing half-written stays";
}

TEST(FileStore, NoticesAFileThatChanged) {
  const test::TemporaryFolder folder;
  const auto files = FileStore::open(folder.path());
  const std::string sha = *files->put("picture");
  std::ofstream(folder.path() + "/" + sha) << "forged";
  EXPECT_THAT(files->get(sha), test::Fails(Errc::kCorrupt));
}

TEST(FileStore, SaysWhenItCannotWrite) {
  const test::TemporaryFolder folder;
  const auto files = FileStore::open(folder.path() + "/files");
  std::filesystem::remove_all(folder.path() + "/files");
  EXPECT_THAT(files->put("picture"), test::Fails(Errc::kIo));
}

}  // namespace
}  // namespace smokemap::server
