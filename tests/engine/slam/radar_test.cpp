#include <gtest/gtest.h>

#include <algorithm>

#include "slam/radar_points.hpp"
#include "slam/slam.hpp"
#include "slam/smoke.hpp"
#include "slam/trajectory_error.hpp"
#include "tests/engine/slam/toy_world.hpp"

namespace smokemap {
namespace {

/// A radar turn in the toy world: an echo of 25 dB at each wall with exponential speckle, receiver noise of mean 1.
RadarSweep sweep_at(const std::vector<Segment2>& walls, const Pose2& at, double seconds, std::mt19937_64& random) {
  RadarSweep sweep;
  sweep.stamp = from_seconds(seconds);
  sweep.robot = "robot";
  sweep.duration_s = 0;
  sweep.azimuths = 200;
  sweep.azimuth_increment_rad = 2 * kPi / 200;
  sweep.bins = 320;
  sweep.range_resolution_m = 0.0375;
  sweep.power.resize(200 * 320);
  for (float& p : sweep.power) p = static_cast<float>(exponential(random));
  for (std::size_t a = 0; a < 200; ++a) {
    const double r = test::cast(walls, at.translation(), at.heading() + 2 * kPi * static_cast<double>(a) / 200, 12);
    const auto bin = static_cast<std::size_t>(std::lround(r / sweep.range_resolution_m));
    if (bin + 1 < 320) sweep.power[a * 320 + bin] += static_cast<float>(300 * (0.2 + exponential(random)));
  }
  return sweep;
}

TEST(RadarEchoes, AreTheStrongestOfEachAzimuth) {
  std::mt19937_64 random(1);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(13, 1, 0.4);
  const RadarParams params;
  const auto echoes = strongest_echoes(sweep_at(walls, at, 0, random), {}, params);
  std::vector<int> per_azimuth(200, 0);
  int on_wall = 0;
  for (const RadarEcho& echo : echoes) {
    EXPECT_LE(++per_azimuth[static_cast<std::size_t>(echo.azimuth)], params.strongest);
    double best = 9;
    for (const Segment2& wall : walls) best = std::min(best, distance(wall, at * echo.p));
    on_wall += best < 0.06;
  }
  EXPECT_GT(echoes.size(), 150u);
  EXPECT_GT(on_wall, 0.97 * static_cast<double>(echoes.size()));
}

TEST(RadarPoints, LieOnWallsAndClearNothing) {
  std::mt19937_64 random(2);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(6, 1, 0);
  const ScanPoints points = surface_points(sweep_at(walls, at, 0, random), {}, {}, {});
  int oriented = 0, along_wall = 0;
  for (const SurfacePoint& point : points.surface) {
    if (!point.oriented()) continue;
    ++oriented;
    const Point2 n = at.rotation() * point.normal;
    along_wall += std::max(std::abs(n.x()), std::abs(n.y())) > 0.9;
  }
  EXPECT_GT(oriented, 30);
  EXPECT_GT(along_wall, 0.8 * oriented);
  EXPECT_TRUE(points.free_ends_robot->empty());
}

TEST(RadarSlam, ClosesTheLoopWithoutAnyLidar) {
  std::mt19937_64 random(3);
  const auto walls = test::ring_of_corridors();
  test::Wheels wheels(0.98, 0.004, 0.05, 3);
  Slam slam;
  Trajectory truth;
  double seconds = 0;
  for (const Pose2& at : test::rounds(2, 0.4)) {
    slam.add_odometry(wheels.read(at, seconds));
    ASSERT_TRUE(slam.add_sweep(sweep_at(walls, at, seconds, random)));
    truth.push_back({from_seconds(seconds), at, Eigen::Matrix3d::Zero()});
    seconds += 0.5;
  }
  slam.polish();
  const auto error = absolute_error(slam.trajectory(), truth);
  ASSERT_TRUE(error);
  EXPECT_LT(error->rmse_m, 0.15);
  EXPECT_GT(slam.counters().loops_closed, 0);
}

TEST(SmokeBeams, AreThoseTheRadarSeesThrough) {
  std::mt19937_64 random(4);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(13, 1, 0);
  const RadarSweep sweep = sweep_at(walls, at, 0, random);
  LaserScan clear = test::scan_at(walls, at, 0, random), smoky = clear;
  int in_smoke = 0;
  for (std::size_t i = 90; i < 180; ++i)
    if (clear.ranges_m[i] > 2.5f) {
      smoky.ranges_m[i] = static_cast<float>(uniform(random, 0.8, 1.6));
      ++in_smoke;
    }
  const auto flags = [&](const LaserScan& scan) {
    const auto smoke = look_for_smoke(scan, {}, sweep, {}, {}).beams;
    return std::count(smoke.begin(), smoke.end(), true);
  };
  EXPECT_LE(flags(clear), 4);
  ASSERT_GT(in_smoke, 5);
  EXPECT_GE(flags(smoky), 0.6 * in_smoke);
}

TEST(SmokeBeams, DrawNoWallsIntoTheMap) {
  std::mt19937_64 random(5);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(13, 1, 0);
  LaserScan scan = test::scan_at(walls, at, 10, random);
  Slam slam;
  ASSERT_TRUE(slam.add_scan(scan));
  ASSERT_TRUE(slam.add_sweep(sweep_at(walls, at, 10, random)));
  EXPECT_EQ(slam.trajectory().size(), 1u);  // the sweep is no pose of its own beside a lidar
  scan.stamp += from_seconds(0.1);
  for (std::size_t i = 90; i < 180; ++i)
    if (scan.ranges_m[i] > 2.5f) scan.ranges_m[i] = 1.2f;
  ASSERT_TRUE(slam.add_scan(scan));
  EXPECT_GT(slam.counters().smoke_beams, 0);
}

TEST(SmokeShare, IsSmallInClearAirAndAllWhereTheLidarSeesNothing) {
  std::mt19937_64 random(6);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(13, 1, 0.3);
  const RadarSweep sweep = sweep_at(walls, at, 0, random);
  LaserScan scan = test::scan_at(walls, at, 0, random);
  EXPECT_LT(look_for_smoke(scan, {}, sweep, {}, {}).share, 0.3);
  scan.ranges_m.assign(scan.ranges_m.size(), std::numeric_limits<float>::infinity());
  EXPECT_GT(look_for_smoke(scan, {}, sweep, {}, {}).share, 0.9);
}

/// One round with both sensors and bad wheels; the lidar sees nothing in the middle half.
double ate_through_smoke(bool with_radar) {
  std::mt19937_64 random(7);
  const auto walls = test::ring_of_corridors();
  test::Wheels wheels(0.85, 0.03, 0.05, 7);
  const std::vector<Pose2> way = test::rounds(1, 0.2);
  Slam slam;
  Trajectory truth;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double seconds = 0.4 * static_cast<double>(i);
    slam.add_odometry(wheels.read(way[i], seconds));
    const RadarSweep sweep = sweep_at(walls, way[i], seconds, random);
    if (with_radar) (void)slam.add_sweep(sweep).ok();
    LaserScan scan = test::scan_at(walls, way[i], seconds, random, 120);
    if (i > way.size() / 4 && i < 3 * way.size() / 4)
      for (float& range : scan.ranges_m)
        range = uniform01(random) < 0.3 ? static_cast<float>(uniform(random, 0.4, 1.0))
                                        : std::numeric_limits<float>::infinity();
    EXPECT_TRUE(slam.add_scan(scan));
    truth.push_back({scan.stamp, way[i], Eigen::Matrix3d::Zero()});
  }
  const auto error = absolute_error(slam.trajectory(), truth);
  return error ? error->rmse_m : 1e9;
}

TEST(SmokeShare, MovesTheWeightToTheRadarWhereTheLidarIsBlind) {
  const double alone = ate_through_smoke(false), together = ate_through_smoke(true);
  EXPECT_GT(alone, 0.3);
  EXPECT_LT(together, 0.15);
}

TEST(RadarEchoes, CountLessTheMoreStandsBeforeThem) {
  RadarSweep sweep;
  sweep.azimuths = 1;
  sweep.azimuth_increment_rad = 2 * kPi;
  sweep.bins = 200;
  sweep.range_resolution_m = 0.05;
  sweep.power.assign(200, 1.0F);
  for (const std::size_t bin : {40, 44, 100, 160}) sweep.power[bin] = 200.0F;  // 2.0 and 2.2 m: one surface
  const auto echoes = strongest_echoes(sweep, {}, {});
  ASSERT_EQ(echoes.size(), 4u);
  EXPECT_EQ(echoes[1].weight, echoes[0].weight);
  EXPECT_NEAR(echoes[2].weight, 0.5 * echoes[0].weight, 1e-9);
  EXPECT_NEAR(echoes[3].weight, 0.25 * echoes[0].weight, 1e-9);
}

TEST(RadarSweeps, ThatMakeNoSenseAreRefused) {
  RadarSweep sweep;
  Slam slam;
  EXPECT_FALSE(slam.add_sweep(sweep));
  EXPECT_EQ(slam.counters().malformed, 1);
}

}  // namespace
}  // namespace smokemap
