#include "simulation/simulated_robot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "simulation/building.hpp"
#include "simulation/path_driver.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// FNV-1a over the bytes of everything a robot sent.
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      value_ = (value_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3u;
  }
  template <typename T>
  void add(const T& number) {
    add(&number, sizeof number);
  }
  void add(const RobotOutput& out) {
    for (const LaserScan& scan : out.scans) {
      add(scan.stamp);
      add(scan.ranges_m.data(), scan.ranges_m.size() * sizeof(float));
    }
    for (const RadarSweep& sweep : out.sweeps) {
      add(sweep.stamp);
      add(sweep.power.data(), sweep.power.size() * sizeof(float));
    }
    for (const Odometry& odometry : out.odometry) {
      const double numbers[] = {odometry.T_odom_robot.x(), odometry.T_odom_robot.y(), odometry.T_odom_robot.heading()};
      add(odometry.stamp);
      add(numbers, sizeof numbers);
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

SimulatedWorld smoky_corridor() {
  SimulatedWorld world;
  world.walls = build_world(corridor_building());
  world.smoke = SmokeField(world.walls, {}, {SmokeSource{{12, 2}}});
  world.smoke.advance(100);
  return world;
}

std::uint64_t digest_of_a_run(std::uint64_t seed, std::uint64_t index, bool company) {
  const SimulatedWorld world = smoky_corridor();
  SimulatedRobotParams params;
  params.seed = seed;
  params.index = index;
  SimulatedRobot robot(params, {1.5, 6, 0});
  params.index = 99;
  SimulatedRobot other(params, {3, 6, 0});
  Digest digest;
  for (int i = 0; i < 300; ++i) {
    robot.command(0.4, 0.1 * std::sin(i * 0.01));
    digest.add(robot.step(world));
    if (company) other.step(world);
  }
  return digest.value();
}

TEST(SimulatedRobot, SendsTheSameBytesInThreeRuns) {
  const std::uint64_t first = digest_of_a_run(1, 1, false);
  EXPECT_EQ(digest_of_a_run(1, 1, false), first);
  EXPECT_EQ(digest_of_a_run(1, 1, false), first);
}

TEST(SimulatedRobot, IsNotDisturbedByCompany) { EXPECT_EQ(digest_of_a_run(1, 1, true), digest_of_a_run(1, 1, false)); }

TEST(SimulatedRobot, DiffersForAnotherSeedOrIndex) {
  EXPECT_NE(digest_of_a_run(2, 1, false), digest_of_a_run(1, 1, false));
  EXPECT_NE(digest_of_a_run(1, 2, false), digest_of_a_run(1, 1, false));
}

TEST(SimulatedRobot, KeepsItsRates) {
  const SimulatedWorld world = smoky_corridor();
  SimulatedRobot robot({}, {3, 6, 0});
  std::size_t scans = 0, sweeps = 0, odometry = 0;
  Stamp last_scan = -1;
  for (int i = 0; i < 1000; ++i) {
    const RobotOutput out = robot.step(world);
    scans += out.scans.size();
    sweeps += out.sweeps.size();
    odometry += out.odometry.size();
    for (const LaserScan& scan : out.scans) {
      EXPECT_EQ(scan.robot, "robot1");
      EXPECT_EQ(scan.ranges_m.size(), 360u);
      EXPECT_LE(scan.stamp + from_seconds(0.1), robot.now()) << "no scan comes before its turn ends";
      if (last_scan >= 0) {
        EXPECT_EQ(scan.stamp - last_scan, from_seconds(0.1));
      }
      last_scan = scan.stamp;
    }
  }
  EXPECT_EQ(robot.now(), from_seconds(10));
  EXPECT_EQ(scans, 100u);
  EXPECT_EQ(sweeps, 25u);
  EXPECT_EQ(odometry, 200u);
}

TEST(SimulatedRobot, ScansFitTheWorldFromItsTruePose) {
  const SimulatedWorld world{build_world(corridor_building()), {}};
  SimulatedRobotParams params;
  params.with_radar = false;
  SimulatedRobot robot(params, {3, 6, 0.3});
  double worst_share = 1;
  for (int i = 0; i < 400; ++i) {
    robot.command(0.3, 0.3);
    const Pose2 pose = robot.true_pose();
    for (const LaserScan& scan : robot.step(world).scans) {
      int near = 0, hits = 0;
      for (const Point2& p : hit_points(scan, {})) {
        ++hits;
        near += world.walls.clearance_m(pose * p, 1) < 0.15;
      }
      ASSERT_GT(hits, 300);
      worst_share = std::min(worst_share, static_cast<double>(near) / hits);
    }
  }
  EXPECT_GT(worst_share, 0.93);
}

TEST(SimulatedRobot, VisitsEveryRoomWithThePathDriver) {
  const FloorPlan plan = corridor_building();
  const SimulatedWorld world{build_world(plan), {}};
  SimulatedRobotParams params;
  params.with_radar = params.with_lidar = false;
  SimulatedRobot robot(params, {1.5, 6, 0});
  PathDriver driver(world.walls);
  const auto tour = room_tour(plan, robot.true_pose().translation());
  EXPECT_EQ(tour.size(), 8u);
  EXPECT_EQ(driver.visit(robot.true_pose().translation(), tour), 8u);
  std::vector<bool> visited(plan.rooms.size(), false);
  int steps = 0;
  for (; !driver.done() && steps < 60'000; ++steps) {
    const VelocityCommand command = driver.drive(robot.true_pose());
    robot.command(command.speed_mps, command.turn_rate_radps);
    robot.step(world);
    const int room = plan.room_at(robot.true_pose().translation());
    if (room >= 0) visited[static_cast<std::size_t>(room)] = true;
  }
  EXPECT_TRUE(driver.done());
  EXPECT_EQ(robot.drive().bumps(), 0);
  for (const bool seen : visited) EXPECT_TRUE(seen);
}

TEST(SimulatedRobot, RefusesNonsense) {
  SimulatedRobotParams params;
  params.odometry_hz = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.name.clear();
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

TEST(PathDriver, SaysWhenThereIsNoWay) {
  const PathDriver driver(build_world(one_room_building()));
  EXPECT_THAT(driver.plan({3, 2}, {10, 2}), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(driver.plan({3, 2}, {0.2, 2}), test::Fails(Errc::kDegenerate));
  const auto way = driver.plan({1, 1}, {5, 3});
  ASSERT_THAT(way, test::IsOk());
  EXPECT_THAT(way->front(), test::IsNearPoint(Point2(1, 1), 1e-9));
  EXPECT_THAT(way->back(), test::IsNearPoint(Point2(5, 3), 1e-9));
}

TEST(PathDriver, KeepsItsDistanceFromWalls) {
  const SegmentWorld world = build_world(corridor_building());
  const PathDriver driver(world);
  const auto way = driver.plan({2, 2}, {12, 9});
  ASSERT_THAT(way, test::IsOk());
  for (const Point2& p : *way) EXPECT_GE(world.clearance_m(p, 1), 0.33 - 1e-6);
}

}  // namespace
}  // namespace smokemap
