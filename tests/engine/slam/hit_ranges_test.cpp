// What a scanner hit a moment ago, asked for again from where the robot is now.
#include "slam/hit_ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "simulation/building.hpp"
#include "simulation/lidar.hpp"

namespace smokemap {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

LaserScan even_scan(std::size_t beams, double from_rad, double view_rad, float range_m) {
  LaserScan scan;
  scan.angle_min_rad = from_rad;
  scan.angle_increment_rad = view_rad / static_cast<double>(beams);
  scan.range_min_m = 0.05;
  scan.range_max_m = 20;
  scan.ranges_m.assign(beams, range_m);
  return scan;
}

Point2 along(double angle_rad, double range_m) { return range_m * Point2(std::cos(angle_rad), std::sin(angle_rad)); }

TEST(HitRanges, AreZeroWhereNothingWasHitAndGoOnAroundAFullTurnOnly) {
  LaserScan turn = even_scan(360, -kPi, 2 * kPi, 4), half = even_scan(181, -kPi / 2, kPi, 4);
  turn.ranges_m[7] = half.ranges_m[7] = kNothing;
  const HitRanges around(turn, {}), ahead(half, {});
  EXPECT_EQ(around.at(7), 0);
  EXPECT_EQ(ahead.at(7), 0);
  EXPECT_EQ(around.at(-1), 4);
  EXPECT_EQ(around.at(360 + 7), 0);
  EXPECT_EQ(ahead.at(-1), 0);
  EXPECT_EQ(ahead.at(181), 0);
}

TEST(HitRanges, FindTheBeamOfABearingAlsoBesideTheEnds) {
  const HitRanges ahead(even_scan(180, -kPi / 2, kPi, 4), {});
  EXPECT_EQ(ahead.beam_along(-kPi / 2 + 0.001), 0);
  EXPECT_EQ(ahead.beam_along(0.001), 90);
  EXPECT_EQ(ahead.beam_along(kPi / 2 + 0.02), 181);
  EXPECT_EQ(ahead.beam_along(-kPi / 2 - 0.02), -2);
  LaserScan reversed = even_scan(360, kPi, 2 * kPi, 4);
  reversed.angle_increment_rad *= -1;
  const HitRanges backwards(reversed, {});
  for (int i = 1; i < 359; ++i)
    EXPECT_EQ(backwards.beam_along(reversed.angle_min_rad + (i + 0.5) * reversed.angle_increment_rad), i);
}

TEST(ScanMemory, KnowsAPlaceAgainFromElsewhere) {
  ScanMemory memory;
  const Pose2 first(2, 1, 0.3), second(2.2, 1.1, 0.5);
  memory.remember(even_scan(360, -kPi, 2 * kPi, 3), {}, first);
  memory.remember(even_scan(360, -kPi, 2 * kPi, kNothing), {}, second);
  EXPECT_EQ(memory.scans(0), 2);
  EXPECT_EQ(memory.times_hit(first * along(1.0, 3.0), 0), 1);
  EXPECT_EQ(memory.times_hit(first * along(-2.5, 3.08), 0), 1);
  EXPECT_EQ(memory.times_hit(first * along(1.0, 3.4), 0), 0);
  EXPECT_EQ(memory.times_hit(first * along(1.0, 1.0), 0), 0);
}

TEST(ScanMemory, FollowsAGrazedWallBetweenItsBeamsButNoGapBetweenTwoSurfaces) {
  LaserScan scan = even_scan(360, -kPi, 2 * kPi, kNothing);
  const auto beam_at = [&](std::size_t i) {
    return scan.angle_min_rad + (static_cast<double>(i)) * scan.angle_increment_rad;
  };
  for (std::size_t i = 183; i < 190; ++i)  // a wall 0.5 m to the side: ranges of 9.6 m down to 2.9 m
    scan.ranges_m[i] = static_cast<float>(0.5 / std::sin(beam_at(i)));
  scan.ranges_m[100] = 2, scan.ranges_m[101] = 5;
  ScanMemory memory;
  memory.remember(scan, {}, {});
  EXPECT_EQ(memory.times_hit({0.5 * (scan.ranges_m[188] + scan.ranges_m[189]), 0.5}, 0), 1) << "0.4 m apart";
  EXPECT_EQ(memory.times_hit(along(0.5 * (beam_at(100) + beam_at(101)), 3.5), 0), 0) << "3 m apart";
  EXPECT_EQ(memory.times_hit(along(beam_at(100), 2.05), 0), 1);
}

TEST(ScanMemory, ForgetsAfterASecondAndKeepsTheLastScansOnly) {
  ScanMemory memory;
  for (int k = 0; k < 10; ++k) {
    LaserScan scan = even_scan(360, -kPi, 2 * kPi, static_cast<float>(1 + k));
    scan.stamp = from_seconds(0.1 * k);
    memory.remember(scan, {}, {});
  }
  EXPECT_EQ(memory.scans(from_seconds(1.0)), static_cast<int>(ScanMemory::kScans));
  EXPECT_EQ(memory.times_hit({10, 0}, from_seconds(1.0)), 1);
  EXPECT_EQ(memory.times_hit({3, 0}, from_seconds(1.0)), 0) << "the third of ten";
  EXPECT_EQ(memory.scans(from_seconds(1.75)), 2);
  EXPECT_EQ(memory.scans(from_seconds(5)), 0);
  EXPECT_EQ(memory.times_hit({10, 0}, from_seconds(5)), 0);
}

TEST(ScanMemory, HasSeenWallsBeforeAndSmokeNot) {
  std::mt19937_64 random(21);
  const SegmentWorld walls = build_world(corridor_building());
  SmokeField smoke(walls, {});
  for (double x = walls.low().x() + 0.1; x < walls.high().x(); x += 0.25)
    for (double y = walls.low().y() + 0.1; y < walls.high().y(); y += 0.25)
      if (smoke.frame().contains(smoke.frame().cell_of({x, y}))) smoke.set_extinction({x, y}, 0.15);
  int wall = 0, wall_stays = 0, echoes = 0, echo_stays = 0;
  for (int i = 0; i < 60;) {
    const Pose2 start(uniform(random, walls.low().x(), walls.high().x()),
                      uniform(random, walls.low().y(), walls.high().y()), uniform(random, -kPi, kPi));
    if (corridor_building().room_at(start.translation()) < 0 || walls.clearance_m(start.translation(), 1) < 0.5)
      continue;
    ++i;
    const Twist2 twist{{0.4, 0}, uniform(random, -0.4, 0.4)};
    ScanMemory memory;
    for (int k = 0; k < 5; ++k) {
      const Pose2 T_odom_robot = twist.after(0.1 * k);
      const SimulatedScan scan = simulate_scan(walls, smoke, start * T_odom_robot, start * twist.after(0.1 * (k + 1)),
                                               from_seconds(0.1 * k), {}, random);
      for (std::size_t b = 0; k == 4 && b < scan.fate.size(); ++b) {
        const auto range = static_cast<double>(scan.scan.ranges_m[b]);
        if (scan.fate[b] == BeamFate::kLost || range < 2) continue;
        const double angle = scan.scan.angle_min_rad + static_cast<double>(b) * scan.scan.angle_increment_rad;
        const bool stays = memory.times_hit(T_odom_robot * along(angle, range), scan.scan.stamp) >= 2;
        (scan.fate[b] == BeamFate::kWall ? wall : echoes) += 1;
        (scan.fate[b] == BeamFate::kWall ? wall_stays : echo_stays) += stays;
      }
      memory.remember(scan.scan, {}, T_odom_robot);
    }
  }
  ASSERT_GT(wall, 2000);
  ASSERT_GT(echoes, 20);
  EXPECT_GT(wall_stays, 0.98 * wall);
  EXPECT_LT(echo_stays, 0.15 * echoes);
}

}  // namespace
}  // namespace smokemap
