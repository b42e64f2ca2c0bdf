// Where a robot may go, and how it gets there: the map, the way, the driver.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/random.hpp"
#include "navigation/cost_map.hpp"
#include "navigation/frontier.hpp"
#include "navigation/pilot.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// An empty floor of cells of 0.1 m, free or planned, with blocked border.
CostMap open_floor(int width, int height, Ground inside = Ground::kFree) {
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.width_cells = width;
  frame.height_cells = height;
  std::vector<Ground> ground(frame.cell_count(), inside);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (x == 0 || y == 0 || x == width - 1 || y == height - 1) ground[frame.index({x, y})] = Ground::kBlocked;
  return CostMap(frame, std::move(ground), {});
}

TEST(Clearance, IsTheDistanceToTheNearestBlockedCell) {
  std::mt19937_64 random(1);
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.width_cells = frame.height_cells = 30;
  std::vector<Ground> ground(frame.cell_count(), Ground::kFree);
  std::vector<Cell> blocked;
  for (int i = 0; i < 12; ++i) {
    blocked.push_back({static_cast<int>(uniform_index(random, 30)), static_cast<int>(uniform_index(random, 30))});
    ground[frame.index(blocked.back())] = Ground::kBlocked;
  }
  const CostMap map(frame, ground, {});
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) {
      double nearest = 1e9;
      for (const Cell& b : blocked) nearest = std::min(nearest, 0.1 * std::hypot(b.x - x, b.y - y));
      EXPECT_NEAR(map.clearance_m({x, y}), nearest, 0.002);
      EXPECT_EQ(map.drivable({x, y}), nearest >= map.params().robot_radius_m - 1e-3) << nearest;
    }
  EXPECT_FALSE(map.drivable({-1, 5}));
  EXPECT_EQ(map.ground({30, 5}), Ground::kUnknown);
}

TEST(CostPerMetre, GrowsTowardsWallsAndThroughRoomsNobodySaw) {
  const CostMap seen = open_floor(60, 60), planned = open_floor(60, 60, Ground::kPlanned);
  double before = 0;
  for (int x = 30; x > 3; --x) {
    const double cost = seen.cost_per_metre({x, 30});
    EXPECT_GE(cost, std::max(1.0, before));
    EXPECT_NEAR(planned.cost_per_metre({x, 30}), cost * seen.params().planned_penalty, 1e-9);
    before = cost;
  }
}

TEST(PlannedWays, AreNeverShorterThanTheStraightLineNorMuchLongerInTheOpen) {
  const CostMap map = open_floor(100, 80);
  std::mt19937_64 random(2);
  for (int i = 0; i < 60; ++i) {
    const Point2 a(uniform(random, 1, 9), uniform(random, 1, 7)), b(uniform(random, 1, 9), uniform(random, 1, 7));
    const auto path = plan_path(map, a, b, {});
    ASSERT_THAT(path, test::IsOk());
    EXPECT_GE(path->length_m, (a - b).norm() - 1e-9);
    EXPECT_LE(path->length_m, 1.1 * (a - b).norm() + 0.3) << "straightened";
    EXPECT_THAT(path->points.front(), test::IsNearPoint(a, 1e-12));
    EXPECT_THAT(path->points.back(), test::IsNearPoint(b, 1e-12));
    EXPECT_EQ(path->planned_m, 0);
  }
}

TEST(PlannedWays, AreTheSameEveryTime) {
  const CostMap map = open_floor(100, 80);
  const auto one = plan_path(map, {1, 1}, {8.7, 6.2}, {}), other = plan_path(map, {1, 1}, {8.7, 6.2}, {});
  EXPECT_EQ(one->points, other->points);
}

TEST(PlannedWays, LeaveATightPlaceAndEndBesideATightGoal) {
  const CostMap map = open_floor(60, 60);
  const auto path = plan_path(map, {0.15, 3}, {5.85, 3}, {});  // both nearer to a wall than the robot is wide
  ASSERT_THAT(path, test::IsOk());
  EXPECT_THAT(path->points.front(), test::IsNearPoint(Point2(0.15, 3), 1e-12));
  EXPECT_LT((path->points.back() - Point2(5.85, 3)).norm(), 0.5);
  EXPECT_GE(map.clearance_m(map.frame().cell_of(path->points.back())), map.params().robot_radius_m);
  PlannerParams strict;
  strict.leave_radius_m = 0;
  EXPECT_THAT(plan_path(map, {0.05, 3}, {3, 3}, strict), test::Fails(Errc::kDegenerate));
}

MergedWall planned_wall(Point2 a, Point2 b, WallState state, int index) {
  MergedWall wall;
  wall.layout_wall = index;
  wall.segment_map = {a, b};
  wall.state = state;
  return wall;
}

/// A room of 6 x 4 m on the plan, its fourth wall in this state.
MergedMap room_with(WallState state) {
  MergedMap merged;
  const Point2 a(0, 0), b(6, 0), c(6, 4), d(0, 4);
  merged.walls = {planned_wall(a, b, WallState::kConfirmed, 0), planned_wall(b, c, state, 1),
                  planned_wall(c, d, WallState::kConfirmed, 2), planned_wall(d, a, WallState::kConfirmed, 3)};
  return merged;
}

TEST(BuiltCostMap, BlocksWallsInEveryStateButMissing) {
  LayoutMap layout;
  layout.scale = LayoutScale{0.05, 0.02, true};
  for (const WallState state :
       {WallState::kConfirmed, WallState::kMoved, WallState::kUnseen, WallState::kNew, WallState::kMissing}) {
    const auto map = build_cost_map(room_with(state), OccupancyGrid(), &layout, {});
    ASSERT_THAT(map, test::IsOk());
    const Ground there = map->ground(map->frame().cell_of({6, 2}));
    EXPECT_EQ(there == Ground::kBlocked, state != WallState::kMissing) << to_string(state);
    EXPECT_EQ(map->ground(map->frame().cell_of({3, 2})), Ground::kPlanned);
    EXPECT_EQ(map->ground(map->frame().cell_of({8.5, 2})), Ground::kUnknown) << "outside of the building";
  }
}

TEST(BuiltCostMap, HasNoPlannedGroundWithoutAPlanOrItsScale) {
  const LayoutMap unscaled;
  for (const LayoutMap* layout : {static_cast<const LayoutMap*>(nullptr), &unscaled}) {
    const auto map = build_cost_map(room_with(WallState::kConfirmed), OccupancyGrid(), layout, {});
    ASSERT_THAT(map, test::IsOk());
    EXPECT_EQ(map->ground(map->frame().cell_of({3, 2})), Ground::kUnknown);
  }
}

TEST(BuiltCostMap, LeavesOutWallsThatAreNowhere) {
  MergedMap merged = room_with(WallState::kConfirmed);
  const auto before = build_cost_map(merged, OccupancyGrid(), nullptr, {});
  merged.walls.push_back(planned_wall({std::nan(""), 0}, {1, 1}, WallState::kNew, 4));
  merged.walls.push_back(planned_wall({0, 0}, {1, INFINITY}, WallState::kNew, 5));
  LayoutMap layout;
  layout.scale = LayoutScale{0.05, 0.02, true};
  ASSERT_THAT(build_cost_map(merged, OccupancyGrid(), &layout, {}), test::IsOk());
  const auto after = build_cost_map(merged, OccupancyGrid(), nullptr, {});
  ASSERT_THAT(after, test::IsOk());
  EXPECT_EQ(after->frame(), before->frame());
  for (int y = 0; y < after->frame().height_cells; ++y)
    for (int x = 0; x < after->frame().width_cells; ++x) EXPECT_EQ(after->ground({x, y}), before->ground({x, y}));
}

TEST(BuiltCostMap, RefusesMapsThatCannotBe) {
  MergedMap far = room_with(WallState::kConfirmed);
  far.walls[0].segment_map.b = {1e6, 0};
  EXPECT_THAT(build_cost_map(far, OccupancyGrid(), nullptr, {}), test::Fails(Errc::kTooLarge));
  CostMapParams params;
  params.resolution_m = 0;
  EXPECT_THAT(build_cost_map(room_with(WallState::kNew), OccupancyGrid(), nullptr, params),
              test::Fails(Errc::kInvalidArgument));
}

/// Left half seen, right half planned.
CostMap half_seen() {
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.width_cells = 80;
  frame.height_cells = 60;
  std::vector<Ground> ground(frame.cell_count());
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      ground[frame.index({x, y})] = x == 0 || y == 0 || x == 79 || y == 59 ? Ground::kBlocked
                                    : x < 40                               ? Ground::kFree
                                                                           : Ground::kPlanned;
  return CostMap(frame, std::move(ground), {});
}

TEST(Frontiers, StandWhereSeenGroundEndsAndAreLeftOutWhenAvoided) {
  const CostMap map = half_seen();
  const auto frontier = best_frontier(map, {1, 3}, {}, {});
  ASSERT_TRUE(frontier);
  EXPECT_NEAR(frontier->target.x(), 3.95, 0.06);
  EXPECT_TRUE(map.drivable(map.frame().cell_of(frontier->target)));
  EXPECT_GT(frontier->size_m, 4);
  EXPECT_FALSE(best_frontier(map, {1, 3}, {frontier->target}, {})) << "it is the only one";
  FrontierParams picky;
  picky.min_size_m = 20;
  EXPECT_FALSE(best_frontier(map, {1, 3}, {}, picky));
  EXPECT_FALSE(best_frontier(open_floor(40, 40), {1, 1}, {}, {})) << "everything was seen";
}

/// Drives in a world where the robot does as it is told.
struct Drive {
  explicit Drive(const CostMap& map, const PilotParams& params = {}) : pilot(params) {
    pilot.set_map(std::make_shared<const CostMap>(map));
  }
  PilotOutput step(const std::vector<Point2>& obstacles = {}) {
    now += 100'000'000;
    const PilotOutput out = pilot.step(now, pose, obstacles);
    pose = pose * Pose2(out.twist.speed_mps * 0.1, 0, out.twist.turn_rate_radps * 0.1);
    return out;
  }
  Pilot pilot;
  Pose2 pose{1, 3, 0};
  Stamp now = 0;
};

TEST(Piloting, ArrivesWhereverThereIsAWay) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 12; ++round) {
    Drive drive(half_seen());
    const Point2 goal(uniform(random, 0.6, 7.4), uniform(random, 0.6, 5.4));
    drive.pilot.set_target(goal);
    PilotState state = PilotState::kIdle;
    for (int i = 0; i < 900 && state != PilotState::kArrived; ++i) state = drive.step().state;
    EXPECT_EQ(state, PilotState::kArrived);
    EXPECT_LT((drive.pose.translation() - goal).norm(), PilotParams{}.arrival_m + 0.01);
  }
}

TEST(Piloting, FollowsATargetThatTheMapMovesWithoutStartingAfresh) {
  Drive drive(half_seen());
  drive.pilot.set_target(Point2(7, 3));
  for (int i = 0; i < 50; ++i) drive.step();
  drive.pilot.move_target({7, 3.3});
  EXPECT_EQ(*drive.pilot.target(), Point2(7, 3.3));
  PilotState state = PilotState::kIdle;
  for (int i = 0; i < 600 && state != PilotState::kArrived; ++i) state = drive.step().state;
  EXPECT_EQ(state, PilotState::kArrived);
  EXPECT_LT((drive.pose.translation() - Point2(7, 3.3)).norm(), 0.31);
}

TEST(Piloting, BacksOffFromWhatStandsInTheWayAndGivesUpInTheEnd) {
  Drive drive(half_seen());
  drive.pilot.set_target(Point2(7, 3));
  const std::vector<Point2> before{{0.25, -0.1}, {0.25, 0}, {0.25, 0.1}, {0.25, 0.05}};
  bool backed = false, blocked = false;
  PilotState state = PilotState::kIdle;
  std::string reason;
  for (int i = 0; i < 700 && state != PilotState::kGivenUp; ++i) {
    const PilotOutput out = drive.step(before);
    state = out.state, reason = out.reason;
    backed = backed || out.twist.speed_mps < 0;
    blocked = blocked || state == PilotState::kBlocked;
  }
  EXPECT_TRUE(blocked);
  EXPECT_TRUE(backed);
  EXPECT_EQ(state, PilotState::kGivenUp);
  EXPECT_FALSE(reason.empty());
  EXPECT_EQ(drive.step().twist.speed_mps, 0) << "and stands until it gets another target";
  drive.pilot.set_target(Point2(2, 3));
  EXPECT_NE(drive.step().state, PilotState::kGivenUp);
}

/// Seconds until the pilot gives up before something that never goes away.
double seconds_until_given_up(Drive& drive, const std::vector<Point2>& before) {
  for (int i = 0; i < 1200; ++i)
    if (drive.step(before).state == PilotState::kGivenUp) return 0.1 * i;
  return 1e9;
}

TEST(Piloting, SaysWithinAMinuteThatItCannotGetOnThoughItBacksOffAndPlansAgain) {
  const std::vector<Point2> before{{0.35, -0.1}, {0.35, 0}, {0.35, 0.1}, {0.35, 0.05}};
  Drive standing(half_seen());
  standing.pilot.set_target(Point2(7, 3));
  EXPECT_LT(seconds_until_given_up(standing, before), 60);
}

TEST(Piloting, AGoalThatMovesWithTheMapDoesNotMakeItWaitForEver) {
  const std::vector<Point2> before{{0.35, -0.1}, {0.35, 0}, {0.35, 0.1}, {0.35, 0.05}};
  Drive drive(half_seen());
  drive.pilot.set_target(Point2(7, 3));
  PilotState state = PilotState::kIdle;
  int i = 0;
  for (; i < 1200 && state != PilotState::kGivenUp; ++i) {
    if (i % 10 == 0) drive.pilot.move_target(Point2(7, i % 20 == 0 ? 3.06 : 3.0));
    state = drive.step(before).state;
  }
  EXPECT_EQ(state, PilotState::kGivenUp);
}

TEST(Piloting, GoesRoundWhatItMetAndItsMapDoesNotShow) {
  Drive drive(half_seen());
  drive.pilot.set_target(Point2(7, 3));
  std::vector<Point2> fence_map;  // across the straight way, open at one end
  for (double y = 0.1; y < 4.2; y += 0.03) fence_map.emplace_back(2.6, y);
  PilotState state = PilotState::kIdle;
  double nearest = 1e9;
  for (int i = 0; i < 1500 && state != PilotState::kArrived; ++i) {
    std::vector<Point2> seen;
    for (const Point2& p : fence_map) {
      nearest = std::min(nearest, (p - drive.pose.translation()).norm());
      if (const Point2 p_robot = drive.pose.inverse() * p; p_robot.norm() < 1.2) seen.push_back(p_robot);
    }
    state = drive.step(seen).state;
    if (state == PilotState::kGivenUp) break;
  }
  EXPECT_EQ(state, PilotState::kArrived);
  EXPECT_GT(nearest, 0.25);
}

TEST(Piloting, DrivesSlowlyWhereTheLidarIsBlind) {
  for (const double share : {0.0, 0.5, 1.0}) {
    Pilot pilot{PilotParams{}};
    pilot.set_map(std::make_shared<const CostMap>(open_floor(100, 60)));
    pilot.set_target(Point2(8, 3));
    const double speed = pilot.step(0, Pose2(1, 3, 0), {}, share).twist.speed_mps;
    if (share == 0) {
      EXPECT_NEAR(speed, 0.5, 0.01);
    } else {
      EXPECT_LT(speed, 0.45) << share;
    }
    EXPECT_GE(speed, 0.25 - 1e-9) << "slow, but on";
  }
}

TEST(MapsWithWhatWasMet, BlockItAndNothingElse) {
  const CostMap map = open_floor(60, 60);
  const CostMap with = map.with_blocked({{3.05, 3.05}, {1e6, 0}, {-5, 2}});
  EXPECT_EQ(with.ground({30, 30}), Ground::kBlocked);
  EXPECT_EQ(with.clearance_m({30, 30}), 0);
  EXPECT_NEAR(with.clearance_m({34, 30}), 0.4, 1e-6);
  int changed = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) changed += with.ground({x, y}) != map.ground({x, y});
  EXPECT_EQ(changed, 1);
}

TEST(Piloting, ParametersNameWhatIsOutOfRange) {
  PilotParams params;
  params.back_up_speed_mps = -1;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.follower.lookahead_m = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.planner.goal_radius_m = 100;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
