#include "simulation/demo_scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "simulation/path_driver.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

TEST(DemoScenario, KeepsItsPromisesForManySeeds) {
  for (std::uint64_t seed : {kDemoSeed, std::uint64_t{1}, std::uint64_t{2}}) {
    const auto demo = make_demo(seed);
    ASSERT_THAT(demo, test::IsOk()) << seed;
    EXPECT_EQ(demo->plan.missing.size(), 1u);
    EXPECT_EQ(std::count(demo->plan.wall_source.begin(), demo->plan.wall_source.end(), -1), 1);
    for (std::size_t i = 0; i < demo->building.doors.size(); ++i)
      EXPECT_GE(demo->building.door_gap(static_cast<int>(i)).length(), 0.9 - 1e-9);
    EXPECT_GT(demo->world.walls.clearance_m(demo->T_world_start.translation(), 1), 0.3) << "the start is free";
    EXPECT_FALSE(demo->world.walls.sees(demo->T_world_start.translation(), demo->p_world_far_room));
    const PathDriver driver(demo->world.walls);
    EXPECT_THAT(driver.plan(demo->T_world_start.translation(), demo->p_world_far_room), test::IsOk());
  }
}

TEST(DemoScenario, BurnsInOneRoomAndLeavesTheEntranceClear) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  const SmokeField& smoke = demo->world.smoke;
  EXPECT_GT(smoke.extinction_at(demo->p_world_fire), 2);
  EXPECT_LT(smoke.extinction_at(demo->T_world_start.translation()), 0.05);
  EXPECT_LT(smoke.extinction_at(demo->p_world_far_room), 0.5);
}

TEST(DemoScenario, TellsTheStartWithinAFingersError) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const auto demo = make_demo(seed);
    ASSERT_THAT(demo, test::IsOk());
    const double off_m = (demo->start.layout_px - demo->true_start.layout_px).norm() * demo->picture.metres_per_pixel;
    EXPECT_LT(off_m, 0.8);
    EXPECT_LT(std::abs(wrap_angle(demo->start.heading_rad - demo->true_start.heading_rad)), 0.25);
    EXPECT_THAT(demo->plan.warp.inverse(demo->picture.to_plan(demo->true_start.layout_px)),
                test::IsNearPoint(demo->T_world_start.translation(), 1e-9));
  }
}

TEST(DemoScenario, HasItsMapAtTheRobotsFirstPose) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  EXPECT_THAT(demo->to_map(demo->T_world_start.translation()), test::IsNearPoint(Point2(0, 0), 1e-12));
  EXPECT_THAT(demo->to_map(demo->T_world_start * Point2(1, 0)), test::IsNearPoint(Point2(1, 0), 1e-12));
}

TEST(DemoScenario, IsTheSameByteForByte) {
  const auto one = make_demo(3), other = make_demo(3);
  EXPECT_EQ(one->building.corners, other->building.corners);
  EXPECT_EQ(one->plan.drawn.corners, other->plan.drawn.corners);
  EXPECT_EQ(one->world.smoke.extinction(), other->world.smoke.extinction());
  EXPECT_EQ(cv::norm(one->picture.sheet, other->picture.sheet, cv::NORM_INF), 0);
  EXPECT_EQ(one->start.layout_px, other->start.layout_px);
}

TEST(DemoScenario, HasARobotThatCanBeDriven) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  SimulatedRobot robot(demo_robot_params(*demo), demo->T_world_start);
  PathDriver driver(demo->world.walls);
  ASSERT_EQ(driver.visit(demo->T_world_start.translation(), {demo->p_world_far_room}), 1u);
  std::size_t scans = 0;
  for (int step = 0; step < 20'000 && !driver.done(); ++step) {
    const VelocityCommand command = driver.drive(robot.true_pose());
    robot.command(command.speed_mps, command.turn_rate_radps);
    scans += robot.step(demo->world).scans.size();
  }
  EXPECT_TRUE(driver.done());
  EXPECT_LT((robot.true_pose().translation() - demo->p_world_far_room).norm(), 0.2);
  EXPECT_EQ(robot.drive().bumps(), 0);
  EXPECT_GT(scans, 100u);
}

}  // namespace
}  // namespace smokemap
