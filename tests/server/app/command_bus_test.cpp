// What people do: role, log, engine, answer; in this order, whatever fails on the way.

#include "server/app/command_bus.hpp"

#include <gtest/gtest.h>

#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/eventually.hpp"
#include "tests/support/failing_vfs.hpp"
#include "tests/support/fake_engine.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

const Identity kAnna{"d-anna", "Anna", Role::kCommander};
const Identity kBo{"d-bo", "Bo", Role::kFirefighter};

CommandMessage command_message(const std::string& id, const std::string& name, const std::string& data) {
  return {id, name, Json::parse(data), std::nullopt};
}
CommandMessage poi_message(const std::string& id) {
  return command_message(id, "place_poi", R"({"poi_id":")" + id + R"(","kind":"fire","frame":"map","p":[1,2]})");
}
CommandMessage stop_all(const std::string& id, bool engaged = true) {
  return command_message(id, "emergency_stop",
                         std::string(R"({"robot":"","engaged":)") + (engaged ? "true}" : "false}"));
}

/// A bus over a store of its own and an engine that remembers.
struct Site {
  explicit Site(std::unique_ptr<Store> opened, CommandBus::Limits limits = {}) : store(std::move(opened)) {
    bus = std::make_unique<CommandBus>(
        *store, engine, clock, [this](const ServerView& view) { views.put(view); }, limits);
  }
  /// Asks and waits for the answer.
  CommandReply ask(const Identity& who, CommandMessage message) const {
    std::promise<CommandReply> answered;
    bus->submit(who, std::move(message), [&answered](const CommandReply& reply) { answered.set_value(reply); });
    return answered.get_future().get();
  }
  std::vector<Event> log() const { return *store->events(1, 1000); }

  std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
  test::FakeEngine engine;
  test::Mailbox<ServerView> views;
  std::unique_ptr<Store> store;
  std::unique_ptr<CommandBus> bus;
};

TEST(CommandBus, StoresBeforeTheEngineHearsAndAnswersAfterwards) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()));
  site.bus->start();
  const CommandReply reply = site.ask(kAnna, poi_message("p1"));
  EXPECT_TRUE(reply.done());
  EXPECT_EQ(reply.seq, 1);
  ASSERT_EQ(site.log().size(), 1u);
  EXPECT_EQ(site.log()[0].outcome, "done");
  EXPECT_EQ(site.log()[0].who.name, "Anna");
  const auto applied = site.engine.applied();
  ASSERT_EQ(applied.size(), 1u);
  EXPECT_EQ(std::get<PlacePoi>(applied[0].first).poi.author, "Anna") << "the author is who holds the token";
}

TEST(CommandBus, GivesTheSameAnswerToTheSameCommandAgain) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()));
  site.bus->start();
  const CommandReply first = site.ask(kAnna, poi_message("p1")), again = site.ask(kAnna, poi_message("p1"));
  EXPECT_EQ(again.seq, first.seq);
  EXPECT_EQ(site.engine.count(), 1u);
  EXPECT_EQ(site.ask(kBo, poi_message("p1")).code, "conflict") << "another device";
  EXPECT_EQ(site.ask(kAnna, command_message("p1", "remove_poi", R"({"poi_id":"p1"})")).code, "conflict")
      << "another act";
  const std::string nobody = R"({"goal_id":"g","robot":"nobody","frame":"map","p":[1,2]})";
  const CommandReply refused = site.ask(kAnna, command_message("g1", "set_goal", nobody));
  const CommandReply refused_again = site.ask(kAnna, command_message("g1", "set_goal", nobody));
  EXPECT_EQ(refused.code, "not_found");
  EXPECT_EQ(refused_again.code, refused.code);
  EXPECT_EQ(refused_again.message, refused.message);
  EXPECT_EQ(refused_again.seq, refused.seq);
  EXPECT_EQ(site.log().size(), 2u);
}

TEST(CommandBus, StoresNothingOfWhatItRefusesItself) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()));
  site.bus->start();
  EXPECT_EQ(
      site.ask(kBo, command_message("a", "set_goal", R"({"goal_id":"g","robot":"r","frame":"map","p":[1,2]})")).code,
      "forbidden");
  EXPECT_EQ(site.ask(kAnna, command_message("b", "place_poi", R"({"poi_id":"p"})")).code, "invalid_argument");
  EXPECT_EQ(site.ask(kAnna, command_message("c", "dance", "{}")).code, "not_found");
  site.clock->advance(from_seconds(10));
  CommandMessage late = poi_message("d");
  late.expires_ms = 9'999;
  EXPECT_EQ(site.ask(kAnna, late).code, "cancelled");
  late.expires_ms = 10'000;
  EXPECT_TRUE(site.ask(kAnna, late).done()) << "just in time";
  EXPECT_EQ(site.log().size(), 1u);
  EXPECT_EQ(site.engine.count(), 1u);
}

TEST(CommandBus, FinishesWhatWasStoredWhenTheProcessDiedBeforeTheAnswer) {
  const test::TemporaryFolder folder;
  {  // killed between the log and the answer: the event lies there, its outcome was never written
    const auto store = *Store::open(folder.path());
    const CommandMessage message = poi_message("p1");
    ASSERT_THAT(store->append({0, 5, kAnna, message.id, message.name, to_text(message.data), ""}), test::IsOk());
  }
  Site site(*Store::open(folder.path()));
  ASSERT_THAT(site.bus->replay(), test::IsOk());
  EXPECT_EQ(site.engine.count(), 1u) << "what lies in the log counts";
  site.bus->start();
  const CommandReply again = site.ask(kAnna, poi_message("p1"));  // the tablet, which heard nothing, asks again
  EXPECT_TRUE(again.done());
  EXPECT_EQ(again.seq, 1);
  EXPECT_EQ(site.engine.count(), 1u) << "and is not carried out twice";
}

TEST(CommandBus, AcknowledgesNothingThatTheDiskDidNotTake) {
  for (int nth = 1; nth < 40; ++nth) {
    const test::TemporaryFolder folder;
    ASSERT_THAT(Store::open(folder.path()), test::IsOk());  // made while the disk is well
    std::set<std::string> acknowledged;
    {
      const test::FailingVfs vfs(nth);
      auto store = Store::open(folder.path(), test::FailingVfs::kName);
      if (!store) continue;
      Site site(std::move(*store));
      site.bus->start();
      for (int i = 0; i < 3; ++i) {
        const std::string id = "p" + std::to_string(i);
        const std::size_t before = site.engine.count();
        const CommandReply reply = site.ask(kAnna, poi_message(id));
        if (reply.done()) acknowledged.insert(id);
        if (reply.done() || reply.seq) continue;
        EXPECT_EQ(reply.code, "io") << reply.message;
        EXPECT_EQ(site.engine.count(), before) << "the engine heard of what is not stored";
      }
    }
    const auto store = *Store::open(folder.path());
    for (const std::string& id : acknowledged) EXPECT_TRUE(store->find(id)->has_value()) << id << " after " << nth;
  }
}

TEST(CommandBus, StopsRobotsEvenWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  ASSERT_THAT(Store::open(folder.path()), test::IsOk());
  const test::FailingVfs vfs(8);
  auto store = Store::open(folder.path(), test::FailingVfs::kName);
  ASSERT_THAT(store, test::IsOk());
  Site site(std::move(*store));
  site.bus->start();
  while (site.ask(kAnna, poi_message("p" + std::to_string(site.engine.count()))).done()) {
  }
  const std::size_t before = site.engine.count();
  const CommandReply reply = site.ask(kBo, stop_all("s1"));
  EXPECT_TRUE(reply.done());
  EXPECT_EQ(reply.seq, 0) << "carried out, but not in the log";
  EXPECT_EQ(site.engine.count(), before + 1);
  EXPECT_EQ(site.ask(kAnna, stop_all("s2", false)).code, "io") << "a release waits for the log";
}

TEST(CommandBus, LetsAStopOvertakeEverythingThatWaits) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()));
  test::Mailbox<std::string> answered;
  const auto submit = [&](const CommandMessage& message) {
    site.bus->submit(kAnna, message, [&answered](const CommandReply& reply) { answered.put(reply.id); });
  };
  for (int i = 0; i < 20; ++i) submit(poi_message("p" + std::to_string(i)));
  submit(stop_all("stop"));
  site.bus->start();
  ASSERT_TRUE(answered.wait_for(21));
  EXPECT_EQ(answered.all()[0], "stop");
  for (int i = 0; i < 20; ++i) EXPECT_EQ(answered.all()[static_cast<std::size_t>(i + 1)], "p" + std::to_string(i));
}

TEST(CommandBus, RefusesWhatIsTooMuchButNeverAStop) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()), {3});
  std::map<std::string, int> codes;
  std::mutex mutex;
  const auto count = [&](const CommandReply& reply) {
    const std::lock_guard lock(mutex);
    ++codes[reply.code];
  };
  for (int i = 0; i < 10; ++i) site.bus->submit(kAnna, poi_message("p" + std::to_string(i)), count);
  for (int i = 0; i < 5; ++i) site.bus->submit(kAnna, stop_all("s" + std::to_string(i)), count);
  EXPECT_EQ(codes["busy"], 7);
  site.bus->start();
  ASSERT_TRUE(test::eventually([&] {
    const std::lock_guard lock(mutex);
    return codes[""] == 8;
  }));
}

TEST(CommandBus, AnswersWhatStillWaitsWhenItStops) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()));
  test::Mailbox<CommandReply> answers;
  for (int i = 0; i < 3; ++i)
    site.bus->submit(kAnna, poi_message("p" + std::to_string(i)),
                     [&answers](const CommandReply& r) { answers.put(r); });
  site.bus->stop();  // never started
  ASSERT_EQ(answers.size(), 3u);
  for (const CommandReply& reply : answers.all()) EXPECT_EQ(reply.code, "io");
  EXPECT_EQ(site.ask(kAnna, poi_message("late")).code, "busy");
  EXPECT_EQ(site.engine.count(), 0u);
}

TEST(Replay, PassesOverWhatWasRefusedAndWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  const auto store = *Store::open(folder.path());
  const auto add = [&](const CommandMessage& m, const std::string& outcome) {
    const auto seq = store->append({0, 5, kAnna, m.id, m.name, to_text(m.data), ""});
    ASSERT_THAT(seq, test::IsOk());
    if (!outcome.empty()) {
      ASSERT_THAT(store->set_outcome(*seq, outcome), test::IsOk());
    }
  };
  add(poi_message("p1"), "done");
  add(poi_message("p2"), "refused: conflict: there is one already");
  add(command_message("x", "a_command_of_tomorrow", "{}"), "done");
  add(command_message("y", "place_poi", R"({"poi_id":7})"), "done");
  add(command_message("a", "add_anchor", R"({"id":"a1","px":[1,2],"map":[3,4]})"), "done");
  add(poi_message("p3"), "done");
  test::FakeEngine whole, half;
  const auto all = replay_log(*store, whole, Origin::kHistory);
  ASSERT_THAT(all, test::IsOk());
  EXPECT_EQ(whole.count(), 3u);
  EXPECT_EQ(all->view().anchors.size(), 1u);
  ASSERT_THAT(replay_log(*store, half, Origin::kHistory, 2), test::IsOk());
  EXPECT_EQ(half.count(), 1u);
  for (const auto& [applied, origin] : whole.applied()) EXPECT_EQ(origin, Origin::kHistory);
}

TEST(Replay, GoesOverLogsOfManyPages) {
  const test::TemporaryFolder folder;
  const auto store = *Store::open(folder.path());
  for (int i = 0; i < 1203; ++i) {
    const CommandMessage m = poi_message("p" + std::to_string(i));
    ASSERT_THAT(store->append({0, i, kAnna, m.id, m.name, to_text(m.data), ""}), test::IsOk());
  }
  test::FakeEngine engine;
  ASSERT_THAT(replay_log(*store, engine, Origin::kHistory), test::IsOk());
  EXPECT_EQ(engine.count(), 1203u);
}

TEST(CommandBus, AReleaseThatWaitedUndidTheStopThatCameAfterIt) {
  const test::TemporaryFolder folder;
  Site site(*Store::open(folder.path()));
  std::vector<std::future<CommandReply>> answers;
  const auto submit = [&](CommandMessage message) {
    auto answered = std::make_shared<std::promise<CommandReply>>();
    answers.push_back(answered->get_future());
    site.bus->submit(kAnna, std::move(message), [answered](const CommandReply& reply) { answered->set_value(reply); });
  };
  submit(poi_message("p1"));
  submit(stop_all("release", false));
  submit(poi_message("p2"));
  submit(stop_all("stop", true));
  site.bus->start();  // all of them wait by now
  for (auto& answer : answers) EXPECT_TRUE(answer.get().done());
  std::vector<std::string> order;
  for (const auto& [command, origin] : site.engine.applied()) {
    if (const auto* stop = std::get_if<EmergencyStop>(&command)) order.push_back(stop->engaged ? "stop" : "release");
    if (const auto* place = std::get_if<PlacePoi>(&command)) order.push_back(place->poi.id);
  }
  EXPECT_EQ(order, (std::vector<std::string>{"release", "stop", "p1", "p2"}));
}

}  // namespace
}  // namespace smokemap::server
