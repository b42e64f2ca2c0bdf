// The main job from end to end without a browser: explore, correct the plan, reach a room that no robot has seen.
#include "tests/support/mission.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "simulation/path_driver.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

constexpr double kPole_m = 0.04;
constexpr double kPassed_m = 1.2;
constexpr double kRoomBeside_m = 0.7;  // enough for the robot to pass

/// Stands poles about the ways from the start to all rooms, metal, square, as thick as a
/// thumb, so that a lidar of one beam a degree meets them now and then only.
std::vector<Point2> stand_poles(DemoScenario& demo, int wanted) {
  auto random = random_stream(demo.seed, 77);
  const PathDriver driver(demo.world.walls);
  std::vector<WorldSegment> all(
      demo.world.walls.segments().begin(),
      demo.world.walls.segments().end() - static_cast<std::ptrdiff_t>(demo.world.walls.doors().size()));
  std::vector<Point2> poles;
  const auto stand = [&](const Point2& p) {
    const bool in_the_way =
        demo.world.walls.clearance_m(p, 1.0) < kRoomBeside_m || (p - demo.p_world_far_room).norm() < 1.0 ||
        (p - demo.T_world_start.translation()).norm() < 1.0 ||
        std::any_of(poles.begin(), poles.end(), [&](const Point2& q) { return (p - q).norm() < 2 * kRoomBeside_m; });
    if (in_the_way || static_cast<int>(poles.size()) >= wanted) return;
    poles.push_back(p);
    for (int side = 0; side < 4; ++side) {
      const Pose2 turned(p.x(), p.y(), side * kPi / 2);
      all.push_back(
          {{turned * Point2(kPole_m / 2, -kPole_m / 2), turned * Point2(kPole_m / 2, kPole_m / 2)}, Material::kMetal});
    }
  };
  for (std::size_t room = 0; room < demo.building.rooms.size(); ++room) {
    const Point2 inside = centroid(demo.building.outline(static_cast<int>(room)));
    const auto way = driver.plan(demo.T_world_start.translation(), inside);
    for (std::size_t i = 1; way && i + 1 < way->size(); ++i)
      stand((*way)[i] + Point2(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3)));
  }
  demo.world.walls = SegmentWorld(all, demo.world.walls.doors());
  return poles;
}

TEST(Mission, TheRobotReachesARoomNobodySawAndThePlanGetsBetter) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  const test::MissionResult r = test::run_mission(*demo, {});
  EXPECT_EQ(r.goal, GoalState::kArrived) << r.reason;
  EXPECT_LT(r.goal_error_m, 1.0) << "metres from the place meant, in truth";
  EXPECT_LT(r.after_seen_median_m, 0.5 * r.before_median_m);
  EXPECT_LT(r.after_median_m, r.before_median_m);
  EXPECT_LT(r.pose_error_m, 0.3);
  EXPECT_EQ(r.bumps, 0);
}

TEST(Mission, TouchesNoThinPoleThatALidarMeetsOnlyNowAndThen) {
  auto demo = make_demo(2);
  ASSERT_THAT(demo, test::IsOk());
  const std::vector<Point2> poles = stand_poles(*demo, 20);
  test::MissionParams params;
  params.explore_s = 60;
  const test::MissionResult r = test::run_mission(*demo, params);
  const auto passed = std::count_if(poles.begin(), poles.end(), [&](const Point2& pole) {
    return std::any_of(r.way_world.begin(), r.way_world.end(),
                       [&](const Point2& p) { return (p - pole).norm() < kPassed_m; });
  });
  EXPECT_GE(passed, 3) << "of " << poles.size() << " poles";
  EXPECT_EQ(r.bumps, 0);
  EXPECT_TRUE(r.goal == GoalState::kArrived || !r.reason.empty());
}

}  // namespace
}  // namespace smokemap
