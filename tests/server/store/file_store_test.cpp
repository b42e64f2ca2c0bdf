#include "server/store/file_store.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/random.hpp"
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

TEST(FileStore, ADamagedFileCouldNotBeReplacedByTheSamePictureSentAgain) {
  const test::TemporaryFolder folder;
  const auto files = FileStore::open(folder.path());
  const std::string bytes(10'000, 'p');
  const std::string sha = *files->put(bytes);
  for (const std::string& damaged : {std::string(), std::string("short"), std::string(10'000, 'q'), bytes + "x"}) {
    std::ofstream(folder.path() + "/" + sha, std::ios::binary | std::ios::trunc) << damaged;
    ASSERT_THAT(files->get(sha), test::Fails(Errc::kCorrupt));
    EXPECT_EQ(*files->put(bytes), sha);
    EXPECT_EQ(*files->get(sha), bytes);
  }
}

TEST(FileStore, WhatACrashLeftHalfWrittenStayedForEver) {
  const test::TemporaryFolder folder;
  const std::string sha = *FileStore::open(folder.path())->put("whole");
  std::ofstream(folder.path() + "/" + sha + ".4711.0.part") << "hal";
  std::ofstream(folder.path() + "/notes.txt") << "somebody's";
  const auto files = FileStore::open(folder.path());
  ASSERT_THAT(files, test::IsOk());
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/" + sha + ".4711.0.part"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/notes.txt")) << "nothing but our own is cleared away";
  EXPECT_EQ(*files->get(sha), "whole");
}

TEST(FileStore, KeepsAnyBytesFromManyThreadsAtOnce) {
  const test::TemporaryFolder folder;
  const auto files = FileStore::open(folder.path());
  std::vector<std::string> contents{""};
  std::mt19937_64 random(2);
  for (int i = 0; i < 12; ++i) {
    contents.emplace_back(uniform_index(random, 5000), '\0');
    for (char& c : contents.back()) c = static_cast<char>(random());
  }
  std::vector<std::thread> people;
  std::atomic<int> good = 0;
  for (int p = 0; p < 4; ++p)
    people.emplace_back([&] {
      for (const std::string& bytes : contents) {
        const auto sha = files->put(bytes);
        const auto back = sha ? files->get(*sha) : Result<std::string>(sha.error());
        good += back && *back == bytes && *sha == sha256_hex(bytes);
      }
    });
  for (std::thread& person : people) person.join();
  EXPECT_EQ(good, 4 * static_cast<int>(contents.size()));
  EXPECT_EQ(static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {})),
            contents.size());
}

}  // namespace
}  // namespace smokemap::server
