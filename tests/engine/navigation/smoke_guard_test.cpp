// What stops a robot in smoke: simulated lidar and radar, true walls.
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "navigation/follower.hpp"
#include "navigation/obstacle_watch.hpp"
#include "simulation/building.hpp"
#include "simulation/lidar.hpp"
#include "simulation/radar.hpp"

namespace smokemap {
namespace {

/// A robot in a room of 6 x 4 m filled with smoke, ten scans and two and a half radar turns a second.
struct InSmoke {
  InSmoke(double extinction_per_m, const Pose2& at, std::uint64_t seed) : pose(at), random(seed) {
    smoke = SmokeField(walls, {});
    for (double x = walls.low().x() + 0.1; x < walls.high().x(); x += 0.25)
      for (double y = walls.low().y() + 0.1; y < walls.high().y(); y += 0.25)
        smoke.set_extinction({x, y}, extinction_per_m);
    for (int i = 0; i < 20; ++i) look(0);
  }
  void look(double speed_mps) {
    const Pose2 before = pose;
    pose = pose * Pose2(0.1 * speed_mps, 0, 0);
    const Twist2 twist{{speed_mps, 0}, 0};
    if (++steps % 4 == 0)
      watch.add_sweep(simulate_sweep(walls, before, before, from_seconds(0.1 * steps), {}, random), before);
    watch.add_scan(simulate_scan(walls, smoke, before, pose, from_seconds(0.1 * steps), {}, random).scan, before,
                   twist);
  }
  SegmentWorld walls = build_world(one_room_building());
  SmokeField smoke;
  Pose2 pose;
  std::mt19937_64 random;
  ObstacleWatch watch;
  int steps = 0;
};

TEST(SmokeGuard, LetsTheRobotDriveInTheMiddleOfARoomHoweverThickTheSmokeIs) {
  for (const double extinction : {0.2, 1.0, 5.0}) {
    int clear = 0;
    constexpr int kRounds = 12;
    for (int i = 0; i < kRounds; ++i) {
      const InSmoke robot(extinction, Pose2(3, 2, 0.5 * i), 20U + static_cast<std::uint64_t>(i));
      clear += is_clear({0.3, 0}, robot.watch.obstacles_robot(robot.pose), {});
    }
    EXPECT_GE(clear, kRounds - 2) << extinction;
  }
}

TEST(SmokeGuard, StopsBeforeAWallThatTheLidarDoesNotSee) {
  for (const double extinction : {0.0, 1.0, 2.5, 5.0})
    for (const double heading : {0.0, 0.35, kPi / 2}) {
      InSmoke robot(extinction, Pose2(2.5, 1.8, heading), 40);
      int i = 0;
      for (; i < 400 && is_clear({0.25, 0}, robot.watch.obstacles_robot(robot.pose), {}); ++i) robot.look(0.25);
      const double left_m = robot.walls.clearance_m(robot.pose.translation(), 5);
      EXPECT_LT(i, 400);
      EXPECT_GT(left_m, 0.26) << extinction << " " << heading;
      EXPECT_LT(left_m, 0.80) << "no sooner than needed: " << extinction << " " << heading;
    }
}

TEST(SmokeGuard, KnowsHowMuchOfTheLidarSmokeSwallows) {
  EXPECT_LT(InSmoke(0, Pose2(3, 2, 0), 60).watch.smoke_share(), 0.2);
  EXPECT_GT(InSmoke(5, Pose2(3, 2, 0), 60).watch.smoke_share(), 0.7);
}

TEST(SmokeGuard, EchoesWithinTheRobotAreNoObstacles) {
  ObstacleWatch watch;
  LaserScan scan;
  scan.angle_min_rad = -kPi, scan.angle_increment_rad = kPi / 180, scan.range_max_m = 15;
  scan.ranges_m.assign(360, 0.15F);
  for (int i = 0; i < 6; ++i) scan.stamp = i, watch.add_scan(scan, Pose2());
  EXPECT_TRUE(watch.obstacles_robot(Pose2()).empty());
  scan.ranges_m.assign(360, 0.30F);
  for (int i = 6; i < 12; ++i) scan.stamp = i, watch.add_scan(scan, Pose2());
  EXPECT_FALSE(watch.obstacles_robot(Pose2()).empty());
}

}  // namespace
}  // namespace smokemap
