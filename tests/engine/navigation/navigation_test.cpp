#include <gtest/gtest.h>

#include <queue>

#include "core/random.hpp"
#include "navigation/cost_map.hpp"
#include "navigation/frontier.hpp"
#include "navigation/pilot.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A floor as text, top row = highest y, a cell of 0.25 m: '#' blocked, '.' seen free, '~' planned, ' ' unknown.
CostMap floor_from(const std::vector<std::string>& rows, double radius_m = 0.1) {
  GridFrame frame;
  frame.resolution_m = 0.25;
  frame.width_cells = static_cast<int>(rows.front().size());
  frame.height_cells = static_cast<int>(rows.size());
  std::vector<Ground> ground(frame.cell_count(), Ground::kUnknown);
  for (int row = 0; row < frame.height_cells; ++row)
    for (int x = 0; x < frame.width_cells; ++x) {
      const char c = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(x)];
      Ground& g = ground[frame.index({x, frame.height_cells - 1 - row})];
      g = c == '#' ? Ground::kBlocked : c == '.' ? Ground::kFree : c == '~' ? Ground::kPlanned : Ground::kUnknown;
    }
  CostMapParams params;
  params.resolution_m = 0.25;
  params.robot_radius_m = radius_m;
  return CostMap(frame, std::move(ground), params);
}

Point2 at(const CostMap& map, int x, int row) { return map.frame().center_of({x, map.frame().height_cells - 1 - row}); }

const std::vector<std::string> kTwoRooms{"#############",  //
                                         "#.....#~~~~~#",  //
                                         "#.....#~~~~~#",  //
                                         "#......~~~~~#",  //
                                         "#.....#~~~~~#",  //
                                         "#############"};

TEST(PlanPath, GoesThroughTheDoorIntoARoomNobodySaw) {
  const CostMap map = floor_from(kTwoRooms);
  const auto path = plan_path(map, at(map, 1, 1), at(map, 11, 1), {});
  ASSERT_THAT(path, test::IsOk());
  EXPECT_GT(path->planned_m, 0.9);
  EXPECT_GT(path->length_m, (at(map, 1, 1) - at(map, 11, 1)).norm());
  EXPECT_THAT(path->points.back(), test::IsNearPoint(at(map, 11, 1), 1e-9));
}

TEST(PlanPath, SaysWhyThereIsNoWay) {
  std::vector<std::string> closed = kTwoRooms;
  closed[3][6] = '#';
  const CostMap map = floor_from(closed);
  PlannerParams exact;
  exact.goal_radius_m = 0;
  const auto no_way = plan_path(map, at(map, 1, 1), at(map, 11, 1), {});
  ASSERT_THAT(no_way, test::Fails(Errc::kDegenerate));
  EXPECT_EQ(no_way.error().message, "no way there is known");
  EXPECT_EQ(plan_path(map, at(map, 1, 1), at(map, 6, 1), exact).error().message,
            "the place is inside a wall or an obstacle");
  EXPECT_EQ(plan_path(map, at(map, 1, 1), {99, 99}, exact).error().message,
            "the place is neither on the plan nor seen by a robot");
}

/// Bellman-Ford-like relaxation until nothing changes: slow and surely right.
std::vector<double> brute_costs(const CostMap& map, Cell start) {
  const GridFrame& frame = map.frame();
  std::vector<double> cost(frame.cell_count(), 1e18);
  cost[frame.index(start)] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y < frame.height_cells; ++y)
      for (int x = 0; x < frame.width_cells; ++x)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const Cell from{x, y}, to{x + dx, y + dy};
            if ((dx == 0 && dy == 0) || !map.drivable(to) || cost[frame.index(from)] > 1e17) continue;
            if (dx != 0 && dy != 0 && !(map.drivable({x + dx, y}) && map.drivable({x, y + dy}))) continue;
            const double step = frame.resolution_m * std::hypot(dx, dy) * map.cost_per_metre(to);
            if (cost[frame.index(from)] + step < cost[frame.index(to)] - 1e-9)
              cost[frame.index(to)] = cost[frame.index(from)] + step, changed = true;
          }
  }
  return cost;
}

TEST(CostToCome, AgreesWithBruteForceOnRandomFloors) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::string> rows(14, std::string(17, '.'));
    for (auto& row : rows)
      for (char& c : row) c = uniform01(random) < 0.2 ? '#' : uniform01(random) < 0.3 ? '~' : '.';
    const CostMap map = floor_from(rows);
    const auto start = nearest_drivable(map, map.frame().center_of({8, 7}), 2);
    ASSERT_TRUE(start);
    const auto fast = cost_to_come(map, map.frame().center_of(*start), {});
    const auto slow = brute_costs(map, *start);
    for (std::size_t i = 0; i < fast.size(); ++i) {
      if (slow[i] > 1e17)
        EXPECT_TRUE(std::isinf(fast[i]));
      else
        EXPECT_NEAR(static_cast<double>(fast[i]), slow[i], 1e-3);
    }
  }
}

TEST(PlanPath, NeverTouchesBlockedGround) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::string> rows(20, std::string(20, '.'));
    for (auto& row : rows)
      for (char& c : row) c = uniform01(random) < 0.15 ? '#' : '.';
    const CostMap map = floor_from(rows);
    const auto path = plan_path(map, {uniform(random, 0, 5), uniform(random, 0, 5)},
                                {uniform(random, 0, 5), uniform(random, 0, 5)}, {});
    if (!path) continue;
    for (std::size_t i = 2; i < path->points.size(); ++i)  // the first piece may leave a tight place
      for (int k = 0; k <= 50; ++k) {
        const Point2 p = path->points[i - 1] + k / 50.0 * (path->points[i] - path->points[i - 1]);
        EXPECT_NE(map.ground(map.frame().cell_of(p)), Ground::kBlocked);
      }
  }
}

MergedWall wall(Point2 a, Point2 b, WallState state) {
  MergedWall w;
  w.layout_wall = 0;
  w.segment_map = {a, b};
  w.state = state;
  return w;
}

TEST(CostMap, ASeenFreeCellBeatsAWallNobodySaw) {
  MergedMap merged;
  merged.walls = {wall({0, 0}, {4, 0}, WallState::kUnseen), wall({4, 0}, {4, 4}, WallState::kConfirmed),
                  wall({0, 2}, {4, 2}, WallState::kMissing)};
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.width_cells = frame.height_cells = 40;
  OccupancyGrid sensed(frame);
  for (int x = 10; x < 20; ++x)
    for (int y = 0; y < 5; ++y) sensed.at({x, y}) = 0;
  const auto map = build_cost_map(merged, sensed, nullptr, {});
  ASSERT_THAT(map, test::IsOk());
  EXPECT_EQ(map->ground(map->frame().cell_of({1.5, 0.01})), Ground::kFree);
  EXPECT_EQ(map->ground(map->frame().cell_of({3.0, 0.01})), Ground::kBlocked);
  EXPECT_NE(map->ground(map->frame().cell_of({3.0, 2.01})), Ground::kBlocked) << "a missing wall blocks nothing";
}

/// Smoke sent an echo into a doorway of .9 m: no way was known any more, and the robot stood before it until it gave
/// up.
TEST(CostMap, ALoneEchoClosesNoDoorButSeveralOrASureOneDo) {
  GridFrame frame;
  frame.resolution_m = 0.05;
  frame.width_cells = 80, frame.height_cells = 60;
  OccupancyGrid sensed(frame, 2);
  const auto set = [&](int x, int y, int percent) { sensed.at({x, y}) = static_cast<std::int8_t>(percent); };
  for (int y = 0; y < 60; ++y)
    if (y < 21 || y >= 39) set(40, y, 98);
  const auto goes_through = [&] {
    const auto map = build_cost_map(MergedMap{}, sensed, nullptr, CostMapParams{});
    return map.ok() && plan_path(*map, {0.8, 1.5}, {3.2, 1.5}, {}).ok();
  };
  EXPECT_TRUE(goes_through());
  set(40, 30, 85);
  EXPECT_TRUE(goes_through());
  set(44, 34, 70);  // another, 28 cm beside it
  EXPECT_TRUE(goes_through());
  set(40, 30, 95);
  EXPECT_FALSE(goes_through());
  set(40, 30, 70), set(41, 30, 70), set(40, 31, 70);
  EXPECT_FALSE(goes_through());
}

TEST(CostMap, AnExitThatTheReaderMissedDoesNotFloodTheCorridor) {
  // A room of 10 m x 6 m with a gap of 1.4 m in its outer wall that is no listed opening.
  LayoutMap layout;
  layout.width_px = layout.height_px = 200;
  layout.scale = LayoutScale{0.1, 0.02, true};
  MergedMap merged;
  merged.walls = {wall({0, 0}, {4, 0}, WallState::kUnseen), wall({5.4, 0}, {10, 0}, WallState::kUnseen),
                  wall({10, 0}, {10, 6}, WallState::kUnseen), wall({10, 6}, {0, 6}, WallState::kUnseen),
                  wall({0, 6}, {0, 0}, WallState::kUnseen)};
  const auto map = build_cost_map(merged, OccupancyGrid{}, &layout, {});
  ASSERT_THAT(map, test::IsOk());
  EXPECT_EQ(map->ground(map->frame().cell_of({5, 3})), Ground::kPlanned);
  EXPECT_EQ(map->ground(map->frame().cell_of({5, -1.5})), Ground::kUnknown);
  EXPECT_THAT(plan_path(*map, {1, 1}, {9, 5}, {}), test::IsOk());
}

TEST(CostMap, NothingKnownIsAClearAnswer) {
  EXPECT_THAT(build_cost_map(MergedMap{}, OccupancyGrid{}, nullptr, {}), test::Fails(Errc::kDegenerate));
  CostMapParams bad;
  bad.resolution_m = 0;
  EXPECT_THAT(build_cost_map(MergedMap{}, OccupancyGrid{}, nullptr, bad), test::Fails(Errc::kInvalidArgument));
}

TEST(Frontier, LooksIntoTheRoomNobodySaw) {
  const CostMap map = floor_from(kTwoRooms);
  FrontierParams params;
  params.min_size_m = 0.2;
  const auto frontier = best_frontier(map, at(map, 1, 1), {}, params);
  ASSERT_TRUE(frontier);
  EXPECT_LT((frontier->target - at(map, 6, 3)).norm(), 0.6);
  EXPECT_FALSE(best_frontier(map, at(map, 1, 1), {frontier->target}, params)) << "a place that failed is left alone";
}

TEST(Follower, StopsForEchoesAheadButNotBeside) {
  const FollowerParams params;
  const Twist on{0.5, 0};
  EXPECT_FALSE(is_clear(on, {{0.4, 0}, {0.4, 0.05}, {0.4, -0.05}}, params));
  EXPECT_TRUE(is_clear(on, {{0.4, 0}, {0.4, 0.05}}, params)) << "two echoes are noise";
  EXPECT_TRUE(is_clear(on, {{0.4, 0.5}, {0.4, 0.55}, {0.4, -0.5}}, params));
  EXPECT_TRUE(is_clear(on, {{-0.4, 0}, {-0.4, 0.05}, {-0.4, -0.05}}, params));
}

/// Drives a point robot along whatever the pilot says, 20 Hz.
PilotOutput drive(Pilot& pilot, Pose2& pose, double seconds, const std::vector<Point2>& obstacles = {}) {
  PilotOutput out;
  for (int i = 0; i < seconds * 20; ++i) {
    out = pilot.step(from_seconds(i * 0.05), pose, obstacles);
    if (out.state == PilotState::kArrived || out.state == PilotState::kGivenUp) break;
    pose = pose * Pose2(out.twist.speed_mps * 0.05, 0, out.twist.turn_rate_radps * 0.05);
  }
  return out;
}

TEST(Pilot, ArrivesWithTheHeadingAskedFor) {
  const auto map = std::make_shared<CostMap>(floor_from(kTwoRooms));
  Pilot pilot{PilotParams{}};
  pilot.set_map(map);
  pilot.set_target(at(*map, 11, 1), kPi / 2);
  Pose2 pose(at(*map, 1, 1), 3.0);
  EXPECT_EQ(drive(pilot, pose, 60).state, PilotState::kArrived);
  EXPECT_THAT(pose, test::IsNear(Pose2(at(*map, 11, 1), kPi / 2), 0.31, 0.21));
}

TEST(Pilot, GivesUpWithAReason) {
  std::vector<std::string> closed = kTwoRooms;
  closed[3][6] = '#';
  const auto map = std::make_shared<CostMap>(floor_from(closed));
  Pilot pilot{PilotParams{}};
  pilot.set_map(map);
  pilot.set_target(at(*map, 11, 1));
  Pose2 pose(at(*map, 1, 1), 0);
  const PilotOutput out = drive(pilot, pose, 60);
  EXPECT_EQ(out.state, PilotState::kGivenUp);
  EXPECT_EQ(out.reason, "no way there is known");
}

TEST(Pilot, StandsBeforeAnObstacleItsMapDoesNotKnow) {
  const auto map = std::make_shared<CostMap>(floor_from(kTwoRooms));
  Pilot pilot{PilotParams{}};
  pilot.set_map(map);
  pilot.set_target(at(*map, 5, 1));
  const std::vector<Point2> wall_ahead{{0.25, 0},  {0.25, 0.05},  {0.25, -0.05},
                                       {-0.25, 0}, {-0.25, 0.05}, {-0.25, -0.05}};
  for (int i = 0; i < 200; ++i)
    EXPECT_LE(pilot.step(from_seconds(i * 0.05), Pose2(at(*map, 1, 1), 0), wall_ahead).twist.speed_mps, 0);
}

TEST(Pilot, IdlesWithoutATargetAndWithoutAMap) {
  Pilot pilot{PilotParams{}};
  EXPECT_EQ(pilot.step(0, Pose2(), {}).state, PilotState::kIdle);
  pilot.set_target(Point2(1, 1));
  const PilotOutput out = pilot.step(0, Pose2(), {});
  EXPECT_EQ(out.state, PilotState::kBlocked);
  EXPECT_EQ(out.reason, "there is no map yet");
}

}  // namespace
}  // namespace smokemap
