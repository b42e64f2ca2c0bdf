#include "server/store/store.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/failing_vfs.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

namespace fs = std::filesystem;

Event event(const std::string& id) {
  return {0, 1000, {"d-1", "Anna", Role::kCommander}, id, "place_poi", "{\"poi_id\":\"" + id + "\"}", ""};
}

std::unique_ptr<Store> opened(const std::string& folder) {
  auto store = Store::open(folder);
  EXPECT_THAT(store, test::IsOk());
  return std::move(*store);
}

TEST(EventLog, NumbersEventsFromOneAndGivesThemBack) {
  const test::TemporaryFolder folder;
  const auto store = opened(folder.path());
  EXPECT_EQ(*store->append(event("a")), 1);
  EXPECT_EQ(*store->append(event("b")), 2);
  ASSERT_THAT(store->set_outcome(1, "done"), test::IsOk());
  const auto events = store->events(1, 10);
  ASSERT_THAT(events, test::IsOk());
  ASSERT_EQ(events->size(), 2u);
  EXPECT_EQ((*events)[0].outcome, "done");
  EXPECT_EQ((*events)[1].outcome, "stored");
  EXPECT_EQ((*events)[1].data, event("b").data);
  EXPECT_EQ((*events)[0].who.role, Role::kCommander);
  EXPECT_EQ(store->events(2, 10)->size(), 1u);
  EXPECT_EQ(store->events(1, 1)->size(), 1u);
}

TEST(EventLog, FindsACommandByItsIdAndTakesItOnlyOnce) {
  const test::TemporaryFolder folder;
  const auto store = opened(folder.path());
  ASSERT_THAT(store->append(event("a")), test::IsOk());
  EXPECT_THAT(store->append(event("a")), test::Fails(Errc::kConflict));
  ASSERT_TRUE(store->find("a")->has_value());
  EXPECT_FALSE(store->find("b")->has_value());
}

TEST(EventLog, KeepsEverythingThatWasAppendedWhenTheProcessDiesAtThatMoment) {
  const test::TemporaryFolder folder, after;
  const auto store = opened(folder.path());
  for (int i = 0; i < 50; ++i) {
    ASSERT_THAT(store->append(event("e" + std::to_string(i))), test::IsOk());
    if (i % 10 != 3) continue;
    // What the disk holds now, without the database having been closed.
    const std::string copy = after.path() + "/" + std::to_string(i);
    fs::copy(folder.path(), copy, fs::copy_options::recursive);
    EXPECT_EQ(opened(copy)->events(1, 100)->size(), static_cast<std::size_t>(i + 1));
  }
}

TEST(EventLog, SaysOnceAndClearlyThatAFileIsDamaged) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() + "/smokemap.db") << std::string(5000, 'x');
  const auto store = Store::open(folder.path());
  ASSERT_THAT(store, test::Fails(Errc::kCorrupt));
  EXPECT_NE(store.error().message.find("is damaged"), std::string::npos) << store.error().message;
}

TEST(EventLog, NoticesPagesThatWereOverwritten) {
  const test::TemporaryFolder folder;
  {
    const auto store = opened(folder.path());
    for (int i = 0; i < 30; ++i) {
      Event large = event("event number " + std::to_string(i));
      large.data = "\"" + std::string(3000, 'x') + "\"";
      ASSERT_THAT(store->append(large), test::IsOk());
    }
  }
  std::fstream file(folder.path() + "/smokemap.db", std::ios::in | std::ios::out | std::ios::binary);
  for (int page = 1; page < 12; ++page) file.seekp(4096 * page + 8) << std::string(3000, '\xff');
  file.close();
  EXPECT_THAT(Store::open(folder.path()), test::Fails(Errc::kCorrupt));
}

TEST(EventLog, IsNotOpenedByASecondServer) {
  const test::TemporaryFolder folder;
  const auto store = opened(folder.path());
  ASSERT_THAT(store->append(event("a")), test::IsOk());
  EXPECT_THAT(Store::open(folder.path()), test::Fails(Errc::kConflict));
}

TEST(EventLog, OfANewerProgramIsLeftAlone) {
  const test::TemporaryFolder folder;
  opened(folder.path()).reset();
  {
    auto database = Database::open(folder.path() + "/smokemap.db");
    ASSERT_THAT(database->run("PRAGMA user_version = 99"), test::IsOk());
  }
  EXPECT_THAT(Store::open(folder.path()), test::Fails(Errc::kUnsupported));
}

TEST(EventLog, CannotBeOpenedWhereThereIsNoFolder) {
  EXPECT_THAT(Store::open("/proc/nothing/here"), test::Fails(Errc::kIo));
}

/// Appends until something fails; returns how many were acknowledged.
int append_with_failure_at(const std::string& folder, int nth, bool& failed) {
  const test::FailingVfs vfs(nth);
  auto store = Store::open(folder, test::FailingVfs::kName);
  int acknowledged = 0;
  for (int i = 0; store && i < 2; ++i) {
    const auto seq = (*store)->append(event("e" + std::to_string(i)));
    if (!seq) {
      EXPECT_EQ(seq.error().code, Errc::kIo) << seq.error().message;
      break;
    }
    ++acknowledged;
  }
  failed = vfs.failed();
  if (store) store->reset();
  return acknowledged;
}

TEST(EventLog, LosesNothingAcknowledgedWhicheverWriteOrSyncFails) {
  bool failed = true;
  int rounds = 0;
  for (int nth = 1; failed && nth < 200; ++nth, ++rounds) {
    const test::TemporaryFolder folder;
    const int acknowledged = append_with_failure_at(folder.path(), nth, failed);
    const auto store = Store::open(folder.path());
    ASSERT_THAT(store, test::IsOk()) << "after failure " << nth;
    const auto events = (*store)->events(1, 100);
    ASSERT_THAT(events, test::IsOk());
    EXPECT_GE(events->size(), static_cast<std::size_t>(acknowledged)) << "after failure " << nth;
    for (int i = 0; i < acknowledged; ++i)
      EXPECT_EQ((*events)[static_cast<std::size_t>(i)].command_id, "e" + std::to_string(i));
  }
  EXPECT_GT(rounds, 10) << "the failing disk was not asked";
  EXPECT_FALSE(failed);
}

TEST(Epochs, GrowEvenWhenTheClockStandsOrGoesBack) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(*opened(folder.path())->next_epoch(1000), 1000u);
  EXPECT_EQ(*opened(folder.path())->next_epoch(1000), 1001u);
  EXPECT_EQ(*opened(folder.path())->next_epoch(500), 1002u);
  EXPECT_EQ(*opened(folder.path())->next_epoch(2000), 2000u);
}

TEST(DevicesAndPictures, ComeBackAfterARestart) {
  const test::TemporaryFolder folder;
  {
    const auto store = opened(folder.path());
    ASSERT_THAT(store->add_device({{"d-1", "Anna", Role::kFirefighter}, "hash", 5, false}), test::IsOk());
    ASSERT_THAT(store->add_picture({"plan", "rectified", "one", "image/png", 3, 4, 10}), test::IsOk());
    ASSERT_THAT(store->add_picture({"plan", "rectified", "two", "image/png", 5, 6, 20}), test::IsOk());
  }
  const auto store = opened(folder.path());
  const auto devices = store->devices();
  ASSERT_EQ(devices->size(), 1u);
  EXPECT_EQ((*devices)[0].who.role, Role::kFirefighter);
  EXPECT_EQ((*devices)[0].token_hash, "hash");
  const auto newest = store->picture("plan", "rectified"), older = store->picture("plan", "rectified", "one");
  ASSERT_TRUE(newest->has_value() && older->has_value());
  EXPECT_EQ((*newest)->sha256, "two");
  EXPECT_EQ((*older)->width_px, 3);
  EXPECT_FALSE(store->picture("plan", "picture")->has_value());
}

}  // namespace
}  // namespace smokemap::server
