#include "server/wire/parts.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "server/wire/live_state.hpp"
#include "tests/support/example_snapshot.hpp"

namespace smokemap::server {
namespace {

/// What a browser does with deltas.
struct Mirror {
  std::map<std::string, Json> objects;
  std::uint64_t revision = 0;
  void take(const std::string& text) {
    const Json delta = Json::parse(text);
    if (delta["reset"].get<bool>()) objects.clear();
    for (const auto& [id, object] : delta["set"].items()) objects[id] = object;
    for (const Json& id : delta["del"]) objects.erase(id.get<std::string>());
    revision = delta["rev"];
  }
  bool shows(const PartTable& table) const {
    if (objects.size() != table.size()) return false;
    for (const auto& [id, text] : table)
      if (!objects.contains(id) || objects.at(id) != Json::parse(text)) return false;
    return true;
  }
};

TEST(PartDeltas, BringEverybodyUpToDateFromWhereverTheyAre) {
  std::mt19937_64 random(3);
  PartTable table;
  std::shared_ptr<const PartState> state = std::make_shared<PartState>();
  std::vector<Mirror> mirrors(5);
  for (int step = 0; step < 300; ++step) {
    const std::string id = "o" + std::to_string(uniform_index(random, 12));
    if (uniform_index(random, 3) == 0)
      table.erase(id);
    else
      table[id] = "{\"v\":" + std::to_string(uniform_index(random, 4)) + "}";
    if (auto next = advance(*state, table)) state = next;
    Mirror& mirror = mirrors[uniform_index(random, mirrors.size())];  // others fall behind
    for (const std::string& text : delta_messages(Part::kPois, *state, mirror.revision, 40)) mirror.take(text);
    ASSERT_TRUE(mirror.shows(table)) << step;
    ASSERT_EQ(mirror.revision, state->revision);
  }
}

TEST(PartDeltas, SayNothingWhenNothingChanged) {
  const auto state = advance(PartState{}, {{"a", "{}"}});
  EXPECT_EQ(advance(*state, {{"a", "{}"}}), nullptr);
  EXPECT_TRUE(delta_messages(Part::kPois, *state, state->revision).empty());
}

TEST(PartDeltas, ResetOnlyInTheFirstOfSeveralMessages) {
  PartTable table;
  for (int i = 0; i < 50; ++i) table["id" + std::to_string(i)] = "{\"text\":\"" + std::string(100, 'x') + "\"}";
  const auto messages = delta_messages(Part::kWalls, *advance(PartState{}, table), 0, 1000);
  EXPECT_GT(messages.size(), 3u);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_LT(messages[i].size(), 1300u);
    EXPECT_EQ(Json::parse(messages[i])["reset"], i == 0);
  }
}

TEST(PartDeltas, QuoteIdsOfRobotsThatChoseThemBadly) {
  const auto messages = delta_messages(Part::kRobots, *advance(PartState{}, {{"a\"b\\\n", "{}"}}), 0);
  EXPECT_TRUE(Json::parse(messages.at(0))["set"].contains("a\"b\\\n"));
}

LiveEncoder::Input input_with(std::shared_ptr<const Snapshot> snapshot) { return {std::move(snapshot), {}, {}}; }

TEST(LiveEncoder, SendsRobotsMoreOftenThanWallsAndSaysWhenToComeBack) {
  LiveEncoder encoder({}, 1);
  auto snapshot = std::make_shared<Snapshot>(test::example_snapshot());
  const auto revision = [&](Part part) {
    return encoder.state()->parts[static_cast<std::size_t>(part)].state->revision;
  };
  EXPECT_NE(encoder.update(input_with(snapshot), 0), nullptr);
  EXPECT_EQ(revision(Part::kRobots), 1u);
  auto moved = std::make_shared<Snapshot>(*snapshot);
  moved->robots[0].speed_mps = 1;
  moved->pois.clear();
  EXPECT_EQ(encoder.update(input_with(moved), 50), nullptr);
  EXPECT_EQ(encoder.due_ms(), 100);
  EXPECT_NE(encoder.update(input_with(moved), 100), nullptr);
  EXPECT_EQ(revision(Part::kRobots), 2u);
  EXPECT_EQ(revision(Part::kPois), 1u);
  EXPECT_NE(encoder.update(input_with(moved), 200), nullptr);
  EXPECT_EQ(revision(Part::kPois), 2u);
}

TEST(LiveEncoder, SharesOneEncodingWithEverybodyWhoIsUpToDate) {
  LiveEncoder encoder({}, 1);
  auto snapshot = std::make_shared<Snapshot>(test::example_snapshot());
  encoder.update(input_with(snapshot), 0);
  auto next = std::make_shared<Snapshot>(*snapshot);
  next->robots[0].speed_mps = 1;
  const auto state = encoder.update(input_with(next), 1000);
  const auto one = state->deltas(Part::kRobots, 1), other = state->deltas(Part::kRobots, 1);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0], other[0]);
  EXPECT_TRUE(state->deltas(Part::kRobots, 2).empty());
  EXPECT_TRUE(Json::parse(*state->deltas(Part::kRobots, 0).at(0))["reset"].get<bool>());
}

TEST(LiveEncoder, ShowsWhoIsThereBeforeTheEngineHasAnything) {
  LiveEncoder encoder({}, 1);
  const auto state = encoder.update({nullptr, {}, {{"d1", {"Anna", "commander", "", std::nullopt, 5}}}}, 0);
  ASSERT_NE(state, nullptr);
  EXPECT_EQ(state->deltas(Part::kPeople, 0).size(), 1u);
}

TEST(PartTables, ShowAPlanWithoutASnapshotOfItsOwn) {
  Snapshot bare;
  for (std::size_t i = 0; i < kPartCount; ++i) (void)part_table(static_cast<Part>(i), bare, {});
  const Json floor = Json::parse(part_table(Part::kInfo, bare, {}).at("floor"));
  EXPECT_TRUE(floor["plan_id"].is_null());
  EXPECT_EQ(floor["fit"]["verdict"], "unknown");
}

TEST(PartTables, NeverShowARejectedPairAsTheRegionsPlace) {
  Snapshot snapshot = test::example_snapshot();
  auto match = std::make_shared<MatchView>(*snapshot.match);
  match->matching.pairs[0].verdict = Verdict::kRejected;
  snapshot.match = match;
  EXPECT_TRUE(Json::parse(part_table(Part::kSketchRegions, snapshot, {}).at("1"))["pair"].is_null());
}

}  // namespace
}  // namespace smokemap::server
