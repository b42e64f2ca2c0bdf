// Scans that lie far apart, as in logs that a mapper has thinned.
#include <gtest/gtest.h>

#include <cmath>

#include "simulation/lidar.hpp"
#include "slam/slam.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/half_turn_lidar.hpp"

namespace smokemap {
namespace {

constexpr double kScansApart_m = 0.85;

/// A corridor, flat on one side, with pillars here and there on the other.
SegmentWorld corridor_with_pillars(std::mt19937_64& random) {
  std::vector<WorldSegment> walls;
  const auto wall = [&](const Point2& a, const Point2& b) { walls.push_back({{a, b}, Material::kBrick}); };
  wall({-1, 1.1}, {60, 1.1});
  wall({-1, -1.1}, {60, -1.1});
  wall({-1, -1.1}, {-1, 1.1});
  wall({60, -1.1}, {60, 1.1});
  for (double x = uniform(random, 1, 4); x < 58; x += uniform(random, 2, 6)) {
    const double front = uniform(random, 0.15, 0.35) - 1.1, end = x + uniform(random, 0.2, 0.5);
    wall({x, -1.1}, {x, front});
    wall({x, front}, {end, front});
    wall({end, front}, {end, -1.1});
  }
  return SegmentWorld(walls);
}

/// Error of the way after 42 m.
double off_m(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const SegmentWorld world = corridor_with_pillars(random);
  const LidarParams lidar = test::half_turn_lidar();
  test::Wheels wheels(1.0, 0, 0.02, seed);
  Slam slam(SlamParams{});
  double x = 0;
  for (int i = 0; i < 50; ++i) {
    x = i * kScansApart_m;
    const Pose2 at(x, 0, 0);
    slam.add_odometry(wheels.read(at, 2.0 * i));
    EXPECT_TRUE(slam.add_scan(simulate_scan(world, {}, at, at, from_seconds(2.0 * i), lidar, random).scan));
  }
  return std::abs(slam.latest_pose().T_map_robot.translation().x() - x);
}

TEST(SparseScans, DoNotSlipBackToWhatTheMapKnows) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_LT(off_m(seed), 0.25) << "seed " << seed
                                 << ": matching the part that is known better was worth more than the wheels";
}

/// Wheels that jolt: the next place is many sigmas from where they say, and the map knows better.
TEST(DenseScans, AreBelievedAgainstWheelsThatJolt) {
  std::mt19937_64 random(4);
  const auto walls = test::ring_of_corridors();
  Slam slam(SlamParams{});
  Pose2 T_odom, last;
  double seconds = 0;
  int scans = 0;
  for (const Pose2& at : test::rounds(1, 0.1)) {
    if (scans > 0) T_odom = T_odom * (last.inverse() * at);
    if (++scans % 25 == 0) T_odom = T_odom * Pose2(0, 0, scans % 2 == 0 ? 0.3 : -0.3);
    last = at;
    slam.add_odometry({from_seconds(seconds), "robot", T_odom, 0, 0});
    ASSERT_TRUE(slam.add_scan(test::scan_at(walls, at, seconds, random)));
    const Pose2 truth = Pose2(1, 1, 0).inverse() * at;
    const Pose2 off = truth.inverse() * slam.latest_pose().T_map_robot;
    ASSERT_LT(off.translation().norm(), 0.25) << "scan " << scans;
    ASSERT_LT(std::abs(off.heading()), 0.1) << "scan " << scans;
    seconds += 0.2;
  }
}

}  // namespace
}  // namespace smokemap
