// Echoes of smoke, told from walls: against what truly happened to every beam of simulated scans.
#include "slam/smoke.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "simulation/building.hpp"
#include "simulation/lidar.hpp"
#include "simulation/radar.hpp"

namespace smokemap {
namespace {

/// Beams by what ended them and what was made of it.
struct BeamTally {
  int smoke = 0, smoke_called_wall = 0, wall = 0, wall_called_smoke = 0;
};

/// Scans from places all over a building filled with smoke of one thickness.
/// @param near_m  walls are counted up to here, smoke at every range
BeamTally tally_in_smoke(double extinction_per_m, double near_m, LidarParams lidar = {}) {
  std::mt19937_64 random(11);
  const SegmentWorld walls = build_world(corridor_building());
  SmokeField smoke(walls, {});
  for (double x = walls.low().x() + 0.1; x < walls.high().x(); x += 0.25)
    for (double y = walls.low().y() + 0.1; y < walls.high().y(); y += 0.25)
      if (smoke.frame().contains(smoke.frame().cell_of({x, y}))) smoke.set_extinction({x, y}, extinction_per_m);
  BeamTally tally;
  for (int i = 0; i < 40;) {
    const Pose2 at(uniform(random, walls.low().x(), walls.high().x()),
                   uniform(random, walls.low().y(), walls.high().y()), uniform(random, -kPi, kPi));
    if (corridor_building().room_at(at.translation()) < 0 || walls.clearance_m(at.translation(), 1) < 0.3) continue;
    ++i;
    const RadarSweep sweep = simulate_sweep(walls, at, at, 0, {}, random);
    const SimulatedScan scan = simulate_scan(walls, smoke, at, at, 0, lidar, random);
    const std::vector<bool> flags = look_for_smoke(scan.scan, {}, sweep, {}, {}).beams;
    for (std::size_t b = 0; b < flags.size(); ++b) {
      if (scan.fate[b] == BeamFate::kSmoke) ++tally.smoke, tally.smoke_called_wall += !flags[b];
      if (scan.fate[b] != BeamFate::kWall || static_cast<double>(scan.scan.ranges_m[b]) > near_m) continue;
      ++tally.wall, tally.wall_called_smoke += flags[b];
    }
  }
  return tally;
}

TEST(SmokeBeams, AreNoWallsHoweverThickTheSmokeIs) {
  for (const double extinction : {0.05, 0.3, 1.0, 2.5, 5.0}) {
    const BeamTally tally = tally_in_smoke(extinction, 3.0);
    ASSERT_GT(tally.smoke, 20) << extinction;
    EXPECT_LE(tally.smoke_called_wall, 0.06 * tally.smoke) << extinction;
    if (extinction < 2) {
      EXPECT_LE(tally.wall_called_smoke, 0.01 * tally.wall) << extinction;
    }
  }
}

TEST(SmokeBeams, AreFewInClearAirAndNoneBeforeNearWalls) {
  const BeamTally clear = tally_in_smoke(0, 15.0), near = tally_in_smoke(0, 1.0);
  EXPECT_EQ(clear.smoke, 0);
  EXPECT_LE(clear.wall_called_smoke, 0.015 * clear.wall);
  EXPECT_LE(near.wall_called_smoke, 0.003 * near.wall) << "what the robot could run into";
}

TEST(SmokeBeams, AreToldFromWallsByAFinerLidarToo) {
  LidarParams lidar;
  lidar.beams = 1440;
  const BeamTally tally = tally_in_smoke(1.0, 3.0, lidar);
  EXPECT_LE(tally.smoke_called_wall, 0.10 * tally.smoke);
  EXPECT_LE(tally.wall_called_smoke, 0.01 * tally.wall);
}

TEST(SmokeBeams, RightBeforeTheRobotAreFoundThoughTheRadarIsBlindThere) {
  std::mt19937_64 random(12);
  const SegmentWorld walls = build_world(one_room_building());
  const Pose2 at(3, 2, 0.4);
  const RadarSweep sweep = simulate_sweep(walls, at, at, 0, {}, random);
  LaserScan scan = simulate_scan(walls, {}, at, at, 0, {}, random).scan;
  std::vector<bool> smoke(scan.ranges_m.size(), false);
  for (std::size_t i = 0; i < smoke.size(); ++i)
    if (uniform01(random) < 0.2) smoke[i] = true, scan.ranges_m[i] = static_cast<float>(uniform(random, 0.1, 0.45));
  const SmokeView view = look_for_smoke(scan, {}, sweep, {}, {});
  int found = 0, wrong = 0, all = 0;
  for (std::size_t i = 0; i < smoke.size(); ++i) {
    all += smoke[i];
    found += smoke[i] && view.beams[i];
    wrong += !smoke[i] && view.beams[i];
  }
  EXPECT_GE(found, 0.95 * all);
  EXPECT_LE(wrong, 3);
  EXPECT_NEAR(view.share, 0.2, 0.08) << "they count for what the lidar is worth";
}

TEST(SmokeBeams, ASmoothThingNearerThanTheRadarSeesIsNoSmoke) {
  std::mt19937_64 random(13);
  const SegmentWorld walls = build_world(one_room_building());
  const Pose2 at(3, 2, 0);
  const RadarSweep sweep = simulate_sweep(walls, at, at, 0, {}, random);
  LaserScan scan = simulate_scan(walls, {}, at, at, 0, {}, random).scan;
  for (std::size_t i = 170; i < 190; ++i)  // somebody's legs, or a box: a disc of 7 cm at 0.4 m
    scan.ranges_m[i] = static_cast<float>(
        0.4 - std::sqrt(std::max(0.0, 0.07 * 0.07 - std::pow(0.007 * (static_cast<double>(i) - 179.5), 2))) +
        normal(random, 0.01));
  const SmokeView view = look_for_smoke(scan, {}, sweep, {}, {});
  int lost = 0;
  for (std::size_t i = 170; i < 190; ++i) lost += view.beams[i];
  EXPECT_LE(lost, 4);
}

TEST(SmokeBeams, AreLookedForAcrossTheEndsOfAFullTurnOnly) {
  std::mt19937_64 random(14);
  const SegmentWorld walls = build_world(one_room_building());
  const Pose2 at(3, 2, 0);
  const RadarSweep sweep = simulate_sweep(walls, at, at, 0, {}, random);
  LidarParams half;
  half.beams = 181, half.angle_min_rad = -kPi / 2, half.field_of_view_rad = kPi;
  for (const LidarParams& lidar : {LidarParams{}, half}) {
    const LaserScan scan = simulate_scan(walls, {}, at, at, 0, lidar, random).scan;
    const std::vector<bool> flags = look_for_smoke(scan, {}, sweep, {}, {}).beams;
    ASSERT_EQ(flags.size(), scan.ranges_m.size());
    EXPECT_FALSE(flags.front() || flags[1] || flags.back()) << lidar.beams;
  }
}

/// One room, the robot standing; a lone echo is put before the wall at 3.4 m, of which the radar says nothing.
TEST(SmokeBeams, FartherAwayAreToldByTheScansBefore) {
  std::mt19937_64 random(16);
  const SegmentWorld walls = build_world(one_room_building());
  const Pose2 at(walls.low().x() + 0.8, 0.5 * (walls.low().y() + walls.high().y()), 0);
  RadarSweep sweep = simulate_sweep(walls, at, at, 0, {}, random);
  std::fill(sweep.power.begin(), sweep.power.end(), 0.0F);  // a radar that has nothing to say
  const LaserScan clear = simulate_scan(walls, {}, at, at, 0, {}, random).scan;
  const std::size_t beam = 181;
  ASSERT_GT(clear.ranges_m[beam], 3.7F);
  LaserScan scan = clear;
  scan.ranges_m[beam] = 3.4F;
  EXPECT_FALSE(look_for_smoke(scan, {}, sweep, {}, {}).beams[beam]) << "the scan alone cannot know";
  ScanMemory through, onto;
  for (int k = 0; k < 2; ++k) through.remember(clear, {}, {});
  EXPECT_FALSE(look_for_smoke(scan, {}, sweep, {}, {}, {&through, {}}).beams[beam]) << "two scans are too few";
  for (int k = 0; k < 2; ++k) through.remember(clear, {}, {}), onto.remember(scan, {}, {}), onto.remember(scan, {}, {});
  EXPECT_TRUE(look_for_smoke(scan, {}, sweep, {}, {}, {&through, {}}).beams[beam]) << "it was not there before";
  EXPECT_FALSE(look_for_smoke(scan, {}, sweep, {}, {}, {&onto, {}}).beams[beam]) << "a post stays";
}

TEST(SmokeView, OfAScanWithoutAnyEchoSaysNothingOfBeams) {
  std::mt19937_64 random(15);
  const SegmentWorld walls = build_world(one_room_building());
  const Pose2 at(3, 2, 0);
  const RadarSweep sweep = simulate_sweep(walls, at, at, 0, {}, random);
  LaserScan scan = simulate_scan(walls, {}, at, at, 0, {}, random).scan;
  scan.ranges_m.assign(scan.ranges_m.size(), std::numeric_limits<float>::quiet_NaN());
  const SmokeView view = look_for_smoke(scan, {}, sweep, {}, {});
  EXPECT_EQ(std::count(view.beams.begin(), view.beams.end(), true), 0);
  EXPECT_GT(view.share, 0.95);
}

}  // namespace
}  // namespace smokemap
