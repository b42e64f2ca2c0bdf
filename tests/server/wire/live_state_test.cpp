#include "server/wire/live_state.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "server/wire/role.hpp"
#include "tests/support/example_snapshot.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

/// A browser that looks now and then, and the tables it has drawn.
struct Onlooker {
  std::array<std::map<std::string, Json>, kPartCount> tables;
  std::array<std::uint64_t, kPartCount> revisions{};
  std::uint64_t seq = 0;
  std::map<TileKey, std::uint32_t> tiles;

  void look(const LiveState& state) {
    for (std::size_t i = 0; i < kPartCount; ++i) {
      for (const SharedBytes& text : state.deltas(static_cast<Part>(i), revisions[i])) {
        const Json delta = Json::parse(*text);
        if (delta["reset"].get<bool>()) tables[i].clear();
        for (const auto& [id, object] : delta["set"].items()) tables[i][id] = object;
        for (const Json& id : delta["del"]) tables[i].erase(id.get<std::string>());
      }
      revisions[i] = state.parts[i].state->revision;
    }
    for (const auto& [key, tile] : state.tiles)
      if (tile->version > seq) tiles[key] = tile->version;
    seq = state.seq;
  }
  bool has(const LiveState& state) const {
    for (std::size_t i = 0; i < kPartCount; ++i) {
      if (tables[i].size() != state.parts[i].state->objects.size()) return false;
      for (const auto& [id, object] : state.parts[i].state->objects)
        if (!tables[i].contains(id) || tables[i].at(id) != Json::parse(*object.json)) return false;
    }
    for (const auto& [key, tile] : state.tiles)
      if (!tiles.contains(key) || tiles.at(key) != tile->version) return false;
    return true;
  }
};

/// Something changes, as it may in a mission.
void change(Snapshot& snapshot, std::mt19937_64& random) {
  switch (uniform_index(random, 6)) {
    case 0:
      snapshot.robots[0].T_map_robot = Pose2(uniform(random, -9, 9), uniform(random, -9, 9), 0);
      break;
    case 1:
      if (snapshot.pois.size() > 1) snapshot.pois.pop_back();
      break;
    case 2: {
      PoiView poi = snapshot.pois[0];
      poi.poi.id = "p" + std::to_string(uniform_index(random, 9));
      std::erase_if(snapshot.pois, [&](const PoiView& p) { return p.poi.id == poi.poi.id; });
      snapshot.pois.push_back(poi);
      break;
    }
    case 3: {
      auto merged = std::make_shared<MergedMap>(*snapshot.merged);
      merged->walls[0].confidence = uniform(random, 0, 1);
      snapshot.merged = merged;
      break;
    }
    case 4: {
      auto grid = std::make_shared<OccupancyGrid>(*snapshot.sensed);
      grid->cells()[uniform_index(random, grid->cells().size())] = static_cast<std::int8_t>(uniform_index(random, 101));
      snapshot.sensed = grid;
      break;
    }
    default:
      snapshot.alerts.assign(uniform_index(random, 3), {"a", "text", false});
      break;
  }
}

TEST(LiveState, BringsEveryOnlookerUpToDateHoweverSeldomItLooks) {
  std::mt19937_64 random(11);
  LiveParams params;
  params.tile_period_ms = params.robot_period_ms = params.vector_period_ms = 0;
  LiveEncoder encoder(params, 5);
  Snapshot snapshot = test::example_snapshot();
  std::vector<Onlooker> onlookers(4);
  for (int step = 0; step < 250; ++step) {
    change(snapshot, random);
    (void)encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, step);
    for (std::size_t i = 0; i < onlookers.size(); ++i) {
      if (uniform_index(random, 1 + 10 * i) != 0) continue;  // the last looks seldom
      onlookers[i].look(*encoder.state());
      ASSERT_TRUE(onlookers[i].has(*encoder.state())) << "step " << step << ", onlooker " << i;
    }
  }
}

TEST(LiveState, SaysNothingWhenASnapshotSaysNothingNew) {
  LiveParams params;
  params.tile_period_ms = params.robot_period_ms = params.vector_period_ms = 0;
  LiveEncoder encoder(params, 5);
  const auto snapshot = std::make_shared<Snapshot>(test::example_snapshot());
  EXPECT_NE(encoder.update({snapshot, {}, {}}, 0), nullptr);
  for (int i = 1; i < 10; ++i) {
    auto same = std::make_shared<Snapshot>(*snapshot);
    same->revision += static_cast<std::uint64_t>(i);
    same->time += i;
    EXPECT_EQ(encoder.update({same, {}, {}}, i), nullptr);
  }
  EXPECT_EQ(encoder.state()->seq, 1u);
}

TEST(LiveState, RoundsAwayWhatNobodyCanSee) {
  LiveParams params;
  params.tile_period_ms = params.robot_period_ms = params.vector_period_ms = 0;
  LiveEncoder encoder(params, 5);
  Snapshot snapshot = test::example_snapshot();
  encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, 0);
  snapshot.robots[0].T_map_robot = snapshot.robots[0].T_map_robot * Pose2(1e-5, -1e-5, 1e-6);
  EXPECT_EQ(encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, 1), nullptr);
}

// The mesh of the plan, its walls and every link went out again with each merge: 50 kB/s after four minutes of driving.
TEST(LiveState, SendsNothingAgainForAMergeThatMovesThePlanByMillimetres) {
  LiveParams params;
  params.tile_period_ms = params.robot_period_ms = params.vector_period_ms = 0;
  LiveEncoder encoder(params, 5);
  Snapshot snapshot = test::example_snapshot();
  auto merged = std::make_shared<MergedMap>(*snapshot.merged);
  merged->links.clear();
  for (int i = 0; i < 500; ++i)
    merged->links.push_back({Point2(0.001 * (i % 20), 0.5 * (i % 5)), i % 3, LinkState::kKept});
  snapshot.merged = merged;
  encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, 0);
  EXPECT_EQ(encoder.state()->parts[static_cast<std::size_t>(Part::kLinks)].state->objects.size(), 15U);
  auto later = std::make_shared<MergedMap>(*merged);
  for (MergedWall& wall : later->walls) wall.segment_map.a += Point2(0.003, 0.002);
  later->links.insert(later->links.begin(), {Point2(0.004, 0.5), 1, LinkState::kKept});
  snapshot.merged = later;
  EXPECT_EQ(encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, 1), nullptr);
}

TEST(LiveState, KeepsWhatItPublishedUntouched) {
  LiveEncoder encoder({}, 5);
  Snapshot snapshot = test::example_snapshot();
  const auto first = encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, 0);
  ASSERT_NE(first, nullptr);
  const auto robots = first->parts[static_cast<std::size_t>(Part::kRobots)].state;
  const std::string before = *robots->objects.at("robot1").json;
  snapshot.robots[0].speed_mps = 9;
  ASSERT_NE(encoder.update({std::make_shared<Snapshot>(snapshot), {}, {}}, 1000), nullptr);
  EXPECT_EQ(*robots->objects.at("robot1").json, before) << "sessions may still be reading it";
  EXPECT_EQ(first->seq, 1u);
}

TEST(LiveParams, NameWhatIsOutOfRange) {
  LiveParams params;
  params.resolution_m = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.tile_period_ms = -1;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

TEST(Roles, HaveWordsThatComeBack) {
  for (const Role role : {Role::kObserver, Role::kFirefighter, Role::kCommander})
    EXPECT_EQ(role_of(to_string(role)), role);
  for (const char* word : {"", "Commander", "admin", "observer "}) EXPECT_EQ(role_of(word), std::nullopt);
  for (std::size_t i = 0; i < kPartCount; ++i)
    EXPECT_EQ(part_of(to_string(static_cast<Part>(i))), static_cast<Part>(i));
  EXPECT_EQ(part_of("nothing"), std::nullopt);
}

}  // namespace
}  // namespace smokemap::server
