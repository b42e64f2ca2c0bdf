#include "server/store/store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/random.hpp"
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

/// The disk lost the end of what was being written: what is there is the beginning of the log, without a gap.
TEST(EventLog, KeepsABeginningWhereverTheWriteAheadLogWasCutOff) {
  const test::TemporaryFolder folder, after;
  const auto store = opened(folder.path());
  for (int i = 0; i < 12; ++i) ASSERT_THAT(store->append(event("e" + std::to_string(i))), test::IsOk());
  const std::string wal = "/smokemap.db-wal";
  const auto size = fs::file_size(folder.path() + wal);
  ASSERT_GT(size, 10'000u);
  std::size_t most = 0, least = 12;
  for (std::uintmax_t cut = 0; cut <= size; cut += 1 + size / 19) {
    const std::string copy = after.path() + "/" + std::to_string(cut);
    fs::create_directories(copy);
    fs::copy(folder.path() + "/smokemap.db", copy + "/smokemap.db");
    fs::copy(folder.path() + wal, copy + wal);
    fs::resize_file(copy + wal, cut);
    const auto reopened = Store::open(copy);
    ASSERT_THAT(reopened, test::IsOk()) << cut;
    const auto events = (*reopened)->events(1, 100);
    ASSERT_THAT(events, test::IsOk());
    for (std::size_t i = 0; i < events->size(); ++i) EXPECT_EQ((*events)[i].command_id, "e" + std::to_string(i));
    const auto next = (*reopened)->append(event("next"));
    ASSERT_THAT(next, test::IsOk());
    EXPECT_EQ(*next, static_cast<std::int64_t>(events->size()) + 1);
    most = std::max(most, events->size()), least = std::min(least, events->size());
  }
  EXPECT_EQ(least, 0u);
  EXPECT_GE(most, 11u);
}

TEST(EventLog, GivesEveryCommandOneNumberWhoeverSendsItAtOnce) {
  const test::TemporaryFolder folder;
  const auto store = opened(folder.path());
  std::vector<std::thread> people;
  std::atomic<int> taken = 0, refused = 0;
  for (int p = 0; p < 4; ++p)
    people.emplace_back([&] {
      for (int i = 0; i < 25; ++i) {
        const auto seq = store->append(event("same-" + std::to_string(i)));
        ++(seq ? taken : refused);
        EXPECT_TRUE(seq || seq.error().code == Errc::kConflict);
      }
    });
  for (std::thread& person : people) person.join();
  EXPECT_EQ(taken, 25);
  EXPECT_EQ(refused, 75);
  const auto events = store->events(1, 100);
  ASSERT_EQ(events->size(), 25u);
  for (std::size_t i = 1; i < events->size(); ++i) EXPECT_GT((*events)[i].seq, (*events)[i - 1].seq);
}

TEST(EventLog, ComesBackInPagesOfAnySizeWithEveryByteOfItsTexts) {
  const test::TemporaryFolder folder;
  std::vector<Event> sent;
  std::mt19937_64 random(4);
  {
    const auto store = opened(folder.path());
    for (int i = 0; i < 23; ++i) {
      Event one = event("id-" + std::to_string(i));
      one.time_ms = static_cast<std::int64_t>(random() >> 1) * (i % 2 == 0 ? 1 : -1);
      one.who = {"d-" + std::to_string(i), "Zo\xc3\xab '; DROP TABLE events; --", static_cast<Role>(i % 3)};
      one.data = "{\"label\":\"" + std::string(uniform_index(random, 3000), 'x') + "\"}";
      ASSERT_THAT(store->append(one), test::IsOk());
      sent.push_back(one);
    }
  }
  const auto store = opened(folder.path());
  for (const int page : {1, 2, 7, 23, 100}) {
    std::vector<Event> got;
    for (std::int64_t from = 1;;) {
      const auto events = store->events(from, page);
      ASSERT_THAT(events, test::IsOk());
      ASSERT_LE(events->size(), static_cast<std::size_t>(page));
      if (events->empty()) break;
      got.insert(got.end(), events->begin(), events->end());
      from = got.back().seq + 1;
    }
    ASSERT_EQ(got.size(), sent.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      EXPECT_EQ(got[i].seq, static_cast<std::int64_t>(i) + 1);
      EXPECT_EQ(got[i].time_ms, sent[i].time_ms);
      EXPECT_EQ(got[i].who.name, sent[i].who.name);
      EXPECT_EQ(got[i].who.role, sent[i].who.role);
      EXPECT_EQ(got[i].data, sent[i].data);
    }
  }
  EXPECT_TRUE(store->events(1, 0)->empty());
  EXPECT_TRUE(store->events(1, -5)->empty());
  EXPECT_EQ(store->events(-100, 5)->size(), 5u);
}

TEST(EventLog, BeginsInAnEmptyFileThatACrashLeft) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() + "/smokemap.db").flush();
  EXPECT_EQ(*opened(folder.path())->append(event("a")), 1);
}

TEST(DevicesAndPictures, AreReplacedByTheirLaterWord) {
  const test::TemporaryFolder folder;
  const auto store = opened(folder.path());
  ASSERT_THAT(store->add_device({{"d-1", "Anna", Role::kFirefighter}, "hash", 5, false}), test::IsOk());
  ASSERT_THAT(store->add_device({{"d-1", "Anna", Role::kObserver}, "hash", 5, true}), test::IsOk());
  const auto devices = store->devices();
  ASSERT_EQ(devices->size(), 1u);
  EXPECT_TRUE((*devices)[0].revoked);
  EXPECT_EQ((*devices)[0].who.role, Role::kObserver);
  ASSERT_THAT(store->add_picture({"plan", "rectified", "one", "image/png", 3, 4, 10}), test::IsOk());
  ASSERT_THAT(store->add_picture({"plan", "rectified", "two", "image/png", 5, 6, 10}), test::IsOk());
  EXPECT_EQ((*store->picture("plan", "rectified"))->sha256, "two") << "in one millisecond: the later one";
  ASSERT_THAT(store->add_picture({"plan", "rectified", "one", "image/png", 3, 4, 10}), test::IsOk());
  EXPECT_EQ((*store->picture("plan", "rectified"))->sha256, "one") << "read anew with the earlier corners";
  EXPECT_FALSE(store->picture("plan", "rectified", "three")->has_value());
}

}  // namespace
}  // namespace smokemap::server
