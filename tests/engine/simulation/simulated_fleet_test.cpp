#include "simulation/simulated_fleet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "simulation/path_driver.hpp"
#include "simulation/recorded_run.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// An empty hall of 12 x 8 m.
SimulatedWorld hall() {
  SimulatedWorld world;
  const Point2 a(0, 0), b(12, 0), c(12, 8), d(0, 8);
  world.walls = SegmentWorld({{{a, b}}, {{b, c}}, {{c, d}}, {{d, a}}});
  return world;
}

FleetMember member(int number, const Pose2& T_world_start) {
  FleetMember made;
  made.params.name = "robot" + std::to_string(number);
  made.params.index = static_cast<std::uint64_t>(number);
  made.params.with_radar = false;
  made.params.lidar.dropout = 0;
  made.params.lidar.sigma_range_m = 0;
  made.T_world_start = T_world_start;
  return made;
}

LaserScan first_scan(SimulatedFleet& fleet, std::size_t robot) {
  for (;;) {
    std::vector<RobotOutput> outputs = fleet.step();
    if (!outputs[robot].scans.empty()) return outputs[robot].scans.front();
  }
}

float range_towards(const LaserScan& scan, double angle_rad) {
  const auto beam = std::lround((angle_rad - scan.angle_min_rad) / scan.angle_increment_rad);
  return scan.ranges_m[static_cast<std::size_t>(beam) % scan.ranges_m.size()];
}

TEST(SimulatedFleet, ShowsEachRobotTheBodiesOfTheOthers) {
  SimulatedFleet pair(hall(), {member(1, Pose2(3, 4, 0)), member(2, Pose2(6, 4, 0))});
  const LaserScan seen = first_scan(pair, 0);
  EXPECT_NEAR(range_towards(seen, 0), 3 - 0.25, 0.01) << "the near side of a disc of 0.25 m";
  EXPECT_NEAR(range_towards(seen, std::atan2(0.2, 3)), 2.85, 0.06) << "still on it";
  EXPECT_NEAR(range_towards(seen, 0.2), 9 / std::cos(0.2), 0.1) << "past it, the wall";
  EXPECT_NEAR(range_towards(seen, kPi / 2), 4, 0.02);
  SimulatedFleet turned(hall(), {member(1, Pose2(3, 4, 0)), member(2, Pose2(6, 4, 0))});
  EXPECT_NEAR(range_towards(first_scan(turned, 1), -kPi), 3 - 0.25, 0.01);
}

TEST(SimulatedFleet, HidesABodyBehindAWallAndInThickSmoke) {
  SimulatedWorld divided = hall();
  std::vector<WorldSegment> walls = divided.walls.segments();
  walls.push_back({{{4.5, 0}, {4.5, 8}}});
  divided.walls = SegmentWorld(walls);
  SimulatedFleet parted(divided, {member(1, Pose2(3, 4, 0)), member(2, Pose2(6, 4, 0))});
  EXPECT_NEAR(range_towards(first_scan(parted, 0), 0), 1.5, 0.01);

  SimulatedWorld smoky = hall();
  smoky.smoke = SmokeField(smoky.walls, {});
  for (double x = 3.3; x < 5.7; x += 0.2)
    for (double y = 3; y < 5; y += 0.2) smoky.smoke.set_extinction({x, y}, 3.0);
  SimulatedFleet blind(smoky, {member(1, Pose2(3, 4, 0)), member(2, Pose2(6, 4, 0))}, false);
  const LaserScan scan = first_scan(blind, 0);
  EXPECT_GT(std::abs(range_towards(scan, 0) - 2.75f), 0.02) << "smoke hides it";
}

TEST(SimulatedFleet, LeavesTheNoiseOfARobotAloneWhenAnotherComes) {
  auto noisy = member(1, Pose2(3, 4, 0));
  noisy.params.lidar.sigma_range_m = 0.02;
  SimulatedFleet alone(hall(), {noisy}), pair(hall(), {noisy, member(2, Pose2(9, 7, 0))});
  for (int i = 0; i < 200; ++i) {
    alone.robot(0).command(0.3, 0.2);
    pair.robot(0).command(0.3, 0.2);
    const RobotOutput one = alone.step()[0], other = pair.step()[0];
    ASSERT_EQ(one.odometry.size(), other.odometry.size());
    for (std::size_t k = 0; k < one.odometry.size(); ++k)
      EXPECT_EQ(one.odometry[k].T_odom_robot.vector(), other.odometry[k].T_odom_robot.vector());
    ASSERT_EQ(one.scans.size(), other.scans.size());
    for (std::size_t k = 0; k < one.scans.size(); ++k) {
      int changed = 0;
      for (std::size_t beam = 0; beam < one.scans[k].ranges_m.size(); ++beam)
        changed += one.scans[k].ranges_m[beam] != other.scans[k].ranges_m[beam];
      EXPECT_LT(changed, 15) << "only beams that end at the other robot";
    }
  }
}

TEST(SimulatedFleet, LetsSmokeSpreadTheSameWayEveryTime) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  const auto members = demo_fleet(*demo, 1);
  ASSERT_THAT(members, test::IsOk());
  auto quiet = *members;
  quiet[0].params.with_lidar = quiet[0].params.with_radar = false;
  SimulatedFleet one(demo->world, quiet), other(demo->world, quiet), still(demo->world, quiet, false);
  for (int step = 0; step < 3000; ++step) one.step(), other.step(), still.step();
  EXPECT_EQ(one.world().smoke.extinction(), other.world().smoke.extinction());
  EXPECT_EQ(still.world().smoke.extinction(), demo->world.smoke.extinction());
  double before = 0, after = 0, higher = 0;
  for (std::size_t i = 0; i < one.world().smoke.extinction().size(); ++i) {
    const double was = demo->world.smoke.extinction()[i], is = one.world().smoke.extinction()[i];
    before += was > 0.1, after += is > 0.1, higher += is > was + 1e-6;
  }
  EXPECT_GE(after, before) << "cells in smoke after half a minute more";
  EXPECT_GT(higher, 0);
}

TEST(DemoFleet, QueuesBehindTheFirstRobotInFreeSpace) {
  for (const std::uint64_t seed : {kDemoSeed, std::uint64_t{1}, std::uint64_t{2}}) {
    const auto demo = make_demo(seed);
    ASSERT_THAT(demo, test::IsOk());
    const auto members = demo_fleet(*demo, 4);
    ASSERT_THAT(members, test::IsOk()) << seed;
    std::set<std::string> names;
    const PathDriver driver(demo->world.walls);
    for (const FleetMember& m : *members) {
      names.insert(m.params.name);
      EXPECT_GT(demo->world.walls.clearance_m(m.T_world_start.translation(), 1), m.params.drive.radius_m);
      EXPECT_THAT(driver.plan(m.T_world_start.translation(), demo->p_world_far_room), test::IsOk());
      const Point2 pointed = demo->plan.warp.inverse(demo->picture.to_plan(m.start.layout_px));
      EXPECT_LT((pointed - m.T_world_start.translation()).norm(), 1.0) << "a finger's error";
      for (const FleetMember& n : *members)
        if (&n != &m) {
          EXPECT_GT((n.T_world_start.translation() - m.T_world_start.translation()).norm(), 1.0);
        }
    }
    EXPECT_EQ(names.size(), 4u);
    EXPECT_EQ((*members)[0].start.layout_px, demo->start.layout_px);
  }
}

TEST(DemoFleet, RefusesSizesThatItCannotMake) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  EXPECT_THAT(demo_fleet(*demo, 0), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(demo_fleet(*demo, kMostRobots + 1), test::Fails(Errc::kInvalidArgument));
}

TEST(RoomTours, ShareEveryPlaceOutOnce) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  const Point2 here = demo->T_world_start.translation();
  const auto alone = room_tour(demo->building, here);
  const auto tours = room_tours(demo->building, {here, here + Point2(1, 0), here + Point2(2, 0)});
  std::vector<Point2> together;
  for (const auto& tour : tours) {
    together.insert(together.end(), tour.begin(), tour.end());
    EXPECT_LE(tour.size(), alone.size() / 3 + 1);
  }
  EXPECT_EQ(together.size(), alone.size());
  for (const Point2& place : alone) EXPECT_EQ(std::count(together.begin(), together.end(), place), 1);
}

TEST(RecordedFleetRun, HoldsEveryRobotWithItsTruth) {
  const auto demo = make_demo(1);
  ASSERT_THAT(demo, test::IsOk());
  RunParams params;
  params.max_duration_s = 12;
  params.with_radar = false;
  params.robots = 3;
  const auto run = record_run(*demo, params);
  ASSERT_THAT(run, test::IsOk());
  std::map<std::string, std::size_t> scans;
  for (const auto& item : run->items)
    if (const auto* scan = std::get_if<LaserScan>(&item)) ++scans[scan->robot];
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_EQ(scans.at("robot1"), run->truth.size());
  ASSERT_EQ(run->others.size(), 2u);
  for (const auto& [robot, truth] : run->others) EXPECT_EQ(scans.at(robot), truth.size());
  EXPECT_THAT(run->truth.front().T_map_robot, test::IsNear(Pose2(), 1e-12, 1e-12));
  EXPECT_GT(run->others.at("robot3").front().T_map_robot.translation().norm(), 1.0) << "one map for all";
  EXPECT_GT(run->way_m, 8) << "they drive side by side";
  EXPECT_EQ(run->bumps, 0);
  EXPECT_EQ(record_run(*demo, params)->truth.back().T_map_robot.vector(), run->truth.back().T_map_robot.vector());
}

}  // namespace
}  // namespace smokemap
