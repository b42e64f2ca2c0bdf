#include "server/wire/parts.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "core/random.hpp"
#include "server/wire/live_state.hpp"
#include "tests/support/example_snapshot.hpp"
#include "tests/support/json_schema.hpp"

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

/// The link breaks after every message in turn; the browser comes back with the revision it was told last.
TEST(PartDeltas, ALinkThatBrokeBetweenTwoMessagesOfOneDeltaLostTheRestForEver) {
  PartTable table;
  for (int i = 0; i < 40; ++i) table["id" + std::to_string(i)] = "{\"v\":" + std::to_string(i) + "}";
  const auto first = advance(PartState{}, table);
  PartTable later = table;
  for (int i = 0; i < 40; i += 2) later["id" + std::to_string(i)] = "{\"v\":-1}";
  for (int i = 1; i < 40; i += 4) later.erase("id" + std::to_string(i));
  const auto second = advance(*first, later);
  for (const std::uint64_t held : {0, 1}) {
    const auto messages = delta_messages(Part::kPois, *second, held, 60);
    ASSERT_GT(messages.size(), 5u);
    for (std::size_t broken = 0; broken <= messages.size(); ++broken) {
      Mirror mirror;
      if (held == 1)
        for (const std::string& text : delta_messages(Part::kPois, *first, 0)) mirror.take(text);
      for (std::size_t i = 0; i < broken; ++i) mirror.take(messages[i]);
      for (const std::string& text : delta_messages(Part::kPois, *second, mirror.revision, 60)) mirror.take(text);
      EXPECT_TRUE(mirror.shows(later)) << "held " << held << ", broken after " << broken;
      EXPECT_EQ(mirror.revision, second->revision);
    }
  }
}

TEST(PartDeltas, StartAfreshForThoseWhoKnowAFutureOrAForgottenPast) {
  const auto first = advance(PartState{}, {{"a", "{}"}, {"b", "{}"}});
  const auto messages = delta_messages(Part::kPois, *first, 99);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_TRUE(Json::parse(messages[0])["reset"]) << "a revision that never was: of another run, or invented";
  PartTable many;
  for (int i = 0; i < 6000; ++i) many["id" + std::to_string(i)] = "{}";
  const auto full = advance(*first, many);
  const auto empty = advance(*full, {});  // so many deletions are not remembered one by one
  const auto reset = delta_messages(Part::kPois, *empty, first->revision);
  ASSERT_EQ(reset.size(), 1u);
  EXPECT_EQ(Json::parse(reset[0]), (Json{{"type", "delta"},
                                         {"part", "pois"},
                                         {"rev", empty->revision},
                                         {"reset", true},
                                         {"set", Json::object()},
                                         {"del", Json::array()}}));
}

/// What a broken solve or a hostile robot may put into a snapshot.
Snapshot snapshot_without_sense() {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Snapshot s = test::example_snapshot();
  RobotStatus& robot = s.robots[0];
  robot.T_map_robot = Pose2(nan, inf, nan);
  robot.sigma_m = inf, robot.sigma_rad = -inf, robot.speed_mps = 1e308;
  robot.path_map = {Point2(nan, 1), Point2(-1e308, inf)};
  robot.note = "\xff\xfe broken", robot.last_heard = std::numeric_limits<Stamp>::min();
  s.pois[0].in_map = {Point2(nan, nan), inf, nan, "\xc0"};
  s.pois[0].poi.label = "\x80", s.pois[0].poi.created = std::numeric_limits<Stamp>::max();
  s.goals[0].remaining_m = nan, s.goals[0].eta_s = inf, s.goals[0].goal.heading_rad = nan;
  auto merged = std::make_shared<MergedMap>(*s.merged);
  for (MergedWall& wall : merged->walls) {
    wall.segment_map = {Point2(nan, inf), Point2(1e308, -1e308)};
    wall.confidence = nan, wall.displacement_m = inf;
  }
  merged->fit = {nan, "unknown"};
  s.merged = merged;
  auto match = std::make_shared<MatchView>(*s.match);
  match->matching.pairs[0].confidence = nan, match->matching.margin = inf;
  s.match = match;
  auto sketch = std::make_shared<SketchView>(*s.sketch);
  sketch->sketch.strokes[0].width_px = nan, sketch->gaps[0].gap_px.a = Point2(inf, nan);
  s.sketch = sketch;
  return s;
}

TEST(PartTables, KeepTheirSchemasWhateverNumbersASnapshotHolds) {
  const test::Schema schema(std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/ws/parts.schema.json");
  const Snapshot snapshot = snapshot_without_sense();
  for (std::size_t i = 0; i < kPartCount; ++i) {
    const auto part = static_cast<Part>(i);
    const PartTable table = part_table(part, snapshot, {});
    for (const auto& [id, text] : table) {
      const Json object = Json::parse(text, nullptr, false);
      ASSERT_FALSE(object.is_discarded()) << to_string(part) << " " << text;
      const std::string definition = part == Part::kInfo ? "info." + id : to_string(part);
      EXPECT_EQ(schema.complaint(object, schema.def(definition)), "") << to_string(part) << " " << text;
    }
    const auto state = advance(PartState{}, table);
    if (!state) continue;  // an empty part is none
    for (const std::string& message : delta_messages(part, *state, 0))
      EXPECT_FALSE(Json::parse(message, nullptr, false).is_discarded()) << message;
  }
}

TEST(Anchors, TellWhatTheMergeMadeOfThem) {
  Snapshot snapshot;
  auto merged = std::make_shared<MergedMap>();
  merged->anchors = {{"kept", 0.031, false}, {"wrong", 1.62, true}, {"gone", 1, false}};
  merged->anchors.push_back({"odd", std::numeric_limits<double>::quiet_NaN(), true});
  snapshot.merged = merged;
  ServerView view;
  for (const char* id : {"kept", "wrong", "odd", "new"}) view.anchors[id] = {Point2(100, 500), Point2(-3.5, 0.25)};
  const PartTable table = part_table(Part::kAnchors, snapshot, view);
  ASSERT_EQ(table.size(), 4U);
  EXPECT_EQ(Json::parse(table.at("kept"))["outlier"], false);
  EXPECT_NEAR(Json::parse(table.at("kept"))["off_m"].get<double>(), 0.03, 0.006);
  EXPECT_EQ(Json::parse(table.at("wrong"))["outlier"], true);
  EXPECT_NEAR(Json::parse(table.at("wrong"))["off_m"].get<double>(), 1.62, 0.006);
  EXPECT_FALSE(Json::parse(table.at("new")).contains("outlier")) << "no merge has seen it yet";
  const test::Schema schema(std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/ws/parts.schema.json");
  for (const auto& [id, text] : table) EXPECT_EQ(schema.complaint(Json::parse(text), schema.def("anchors")), "") << id;
}

}  // namespace
}  // namespace smokemap::server
