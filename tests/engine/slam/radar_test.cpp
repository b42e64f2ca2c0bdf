#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "slam/radar_points.hpp"
#include "slam/slam.hpp"
#include "slam/smoke.hpp"
#include "slam/trajectory_error.hpp"
#include "tests/engine/slam/toy_world.hpp"

namespace smokemap {
namespace {

TEST(RadarEchoes, AreTheStrongestOfEachAzimuth) {
  std::mt19937_64 random(1);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(13, 1, 0.4);
  const RadarParams params;
  const auto echoes = strongest_echoes(test::sweep_at(walls, at, 0, random), {}, params);
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
  const ScanPoints points = surface_points(test::sweep_at(walls, at, 0, random), {}, {}, {});
  int oriented = 0, along_wall = 0;
  for (const SurfacePoint& point : points.surface) {
    if (!point.oriented()) continue;
    ++oriented;
    const Point2 n = at.rotation() * point.normal;
    along_wall += std::max(std::abs(n.x()), std::abs(n.y())) > 0.9;
  }
  EXPECT_GT(oriented, 40);
  EXPECT_GT(along_wall, 0.8 * oriented);
  EXPECT_TRUE(points.free_ends_robot->empty());
}

TEST(RadarPoints, OfTheNearestSurfacesAreAScan) {
  std::mt19937_64 random(7);
  const auto walls = test::ring_of_corridors();
  const Pose2 at(6, 1, 0.3);
  const LaserScan scan = nearest_surfaces(test::sweep_at(walls, at, 0, random), {});
  ASSERT_EQ(scan.ranges_m.size(), 200u);
  int told = 0, right = 0;
  for (std::size_t a = 0; a < scan.ranges_m.size(); ++a) {
    const double angle = scan.angle_min_rad + static_cast<double>(a) * scan.angle_increment_rad;
    const double truth = test::cast(walls, at.translation(), at.heading() + angle, 12);
    if (!std::isfinite(scan.ranges_m[a])) continue;
    ++told;
    right += std::abs(static_cast<double>(scan.ranges_m[a]) - truth) < 0.06;
  }
  EXPECT_GT(told, 100);
  EXPECT_GT(right, 0.97 * told);
}

TEST(RadarPoints, LeaveOutWhatIsToBeLeftOut) {
  std::mt19937_64 random(8);
  const auto walls = test::ring_of_corridors();
  const RadarSweep sweep = test::sweep_at(walls, Pose2(6, 1, 0), 0, random);
  const LaserScan nearest = nearest_surfaces(sweep, {});
  std::vector<double> left_out_m(200, 0);
  for (std::size_t a = 30; a < 70; ++a)  // a near wall
    if (std::isfinite(nearest.ranges_m[a])) left_out_m[a] = static_cast<double>(nearest.ranges_m[a]);
  const auto in_sector = [](const ScanPoints& points) {
    return std::count_if(points.surface.begin(), points.surface.end(), [](const SurfacePoint& point) {
      const double angle = std::atan2(point.p.y(), point.p.x());
      return angle > 31 * 2 * kPi / 200 && angle < 69 * 2 * kPi / 200;
    });
  };
  const ScanPoints all = surface_points(sweep, {}, {}, {}), left = surface_points(sweep, {}, {}, {}, left_out_m);
  EXPECT_GE(in_sector(all), 3);
  EXPECT_EQ(in_sector(left), 0);
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
    ASSERT_TRUE(slam.add_sweep(test::sweep_at(walls, at, seconds, random)));
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
  const RadarSweep sweep = test::sweep_at(walls, at, 0, random);
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
  ASSERT_TRUE(slam.add_sweep(test::sweep_at(walls, at, 10, random)));
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
  const RadarSweep sweep = test::sweep_at(walls, at, 0, random);
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
    const RadarSweep sweep = test::sweep_at(walls, way[i], seconds, random);
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

/// One round; `sees(i)` says which sensors work at pose i: first the lidar, second the radar.
struct SensorRound {
  std::vector<Pose2> way = test::rounds(1, 0.25);
  Slam slam;
  Trajectory truth;

  explicit SensorRound(const std::function<std::pair<bool, bool>(std::size_t)>& sees) {
    std::mt19937_64 random(8);
    const auto walls = test::ring_of_corridors();
    test::Wheels wheels(0.98, 0.004, 0.05, 8);
    for (std::size_t i = 0; i < way.size(); ++i) {
      const double seconds = 0.5 * static_cast<double>(i);
      slam.add_odometry(wheels.read(way[i], seconds));
      const auto [lidar, radar] = sees(i);
      if (radar) (void)slam.add_sweep(test::sweep_at(walls, way[i], seconds, random)).ok();
      if (lidar) (void)slam.add_scan(test::scan_at(walls, way[i], seconds, random)).ok();
      truth.push_back({from_seconds(seconds), way[i], Eigen::Matrix3d::Zero()});
    }
    slam.polish();
  }
  double ate_m(std::size_t from, std::size_t to) const {
    Trajectory part;
    for (const StampedPose& pose : slam.trajectory())
      if (pose.stamp >= truth[from].stamp && pose.stamp < truth[to].stamp) part.push_back(pose);
    const auto error = absolute_error(part, truth);
    return error ? error->rmse_m : 1e9;
  }
};

/// What the newest steps between nodes claim to know.
double information_of_last_steps(const PoseGraph& graph) {
  double sum = 0;
  const std::size_t steps = graph.nodes.size() - 1;
  for (std::size_t e = steps - 15; e < steps; ++e) sum += graph.edges[e].sqrt_information.topLeftCorner<2, 2>().norm();
  return sum / 15;
}

/// A robot whose first item was a sweep kept the radar's wide gates and large sigmas for ever.
TEST(RadarSlam, ALidarThatComesLaterIsMatchedAsALidar) {
  const SensorRound late([](std::size_t i) { return std::pair(i >= 40, true); });
  const SensorRound lidar([](std::size_t) { return std::pair(true, false); });
  const SensorRound radar([](std::size_t) { return std::pair(false, true); });
  const std::size_t end = late.way.size() - 1;
  EXPECT_EQ(late.slam.counters().lost, 0);
  EXPECT_LT(late.ate_m(50, end), 0.015);
  EXPECT_LT(late.ate_m(0, end), 0.05);  // in one piece with what the radar made before
  const double as_lidar = information_of_last_steps(lidar.slam.graph());
  EXPECT_GT(information_of_last_steps(late.slam.graph()), 0.8 * as_lidar);
  EXPECT_LT(information_of_last_steps(radar.slam.graph()), 0.6 * as_lidar);
}

TEST(RadarSlam, CarriesOnAloneWhenTheLidarFallsSilent) {
  const SensorRound run([](std::size_t i) { return std::pair(i < 40 || i > 110, true); });
  EXPECT_EQ(run.slam.counters().lost, 0);
  const std::size_t end = run.way.size() - 1;
  EXPECT_LT(run.ate_m(0, end), 0.10);
  EXPECT_GT(run.slam.trajectory().size(), run.way.size() - 8);  // only the first two seconds are waited for
}

TEST(RadarGhosts, ThatMoveWithTheRobotAreNotDrawn) {
  std::mt19937_64 random(9);
  const auto walls = test::ring_of_corridors();
  test::Wheels wheels(0.98, 0.004, 0.05, 9);
  const std::vector<Pose2> way = test::rounds(1, 0.35);
  Slam slam;
  int ghosts_seen = 0;
  const auto off_wall = [&](const Point2& p_world) {
    return std::none_of(walls.begin(), walls.end(),
                        [&](const Segment2& wall) { return distance(wall, p_world) < 0.35; });
  };
  for (std::size_t i = 0; i < way.size(); ++i) {
    RadarSweep sweep = test::sweep_at(walls, way[i], 0.5 * static_cast<double>(i), random);
    // A wall met flat shows another one instead, through it: a patch of azimuths at a range that changes.
    const std::size_t from = uniform_index(random, 190), bin = 120 + uniform_index(random, 150);
    for (std::size_t a = from; a < from + 10; ++a) {
      std::fill_n(sweep.power.begin() + static_cast<std::ptrdiff_t>(a * 320), 320, 1.0F);
      sweep.power[a * 320 + bin] = 200.0F;
    }
    const ScanPoints points = surface_points(sweep, {}, {}, {});
    for (const Point2& p : *points.hits_robot) ghosts_seen += off_wall(way[i] * p);
    slam.add_odometry(wheels.read(way[i], 0.5 * static_cast<double>(i)));
    ASSERT_TRUE(slam.add_sweep(sweep));
  }
  int drawn = 0, ghosts_drawn = 0;
  for (const PoseNode& node : slam.graph().nodes)
    for (const Point2& p : *node.hits_robot) {
      ++drawn;
      ghosts_drawn += off_wall(way.front() * (node.T_map_robot * p));
    }
  ASSERT_GT(ghosts_seen, 300);
  EXPECT_LT(ghosts_drawn, 0.25 * ghosts_seen);
  EXPECT_GT(drawn, 100 * static_cast<int>(slam.graph().nodes.size()));  // of at most 200 a turn: walls stay
}

TEST(RadarSweeps, ThatMakeNoSenseAreRefused) {
  RadarSweep sweep;
  Slam slam;
  EXPECT_FALSE(slam.add_sweep(sweep));
  EXPECT_EQ(slam.counters().malformed, 1);
}

}  // namespace
}  // namespace smokemap
