#include "maps/laser_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "core/random.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
const float kNan = std::nanf("");

LaserScan scan_of(std::vector<float> ranges_m) {
  LaserScan scan;
  scan.robot = "robot1";
  scan.angle_increment_rad = 2 * kPi / static_cast<double>(std::max<std::size_t>(1, ranges_m.size()));
  scan.range_min_m = 0.2;
  scan.range_max_m = 10;
  scan.ranges_m = std::move(ranges_m);
  return scan;
}

TEST(Classify, ReadsEveryConventionMetInRealBags) {
  const LaserScan scan = scan_of({1});
  const BeamConvention in_smoke{false, 0}, clear_air{true, 0};
  for (const float nothing : {kNan, 0.0f, -1.0f, -kInf, 0.1f})
    for (const BeamConvention& convention : {in_smoke, clear_air})
      EXPECT_EQ(classify(nothing, scan, convention), BeamKind::kUnknown) << nothing;
  for (const float far : {10.0f, 11.0f, 1e6f, kInf}) {
    EXPECT_EQ(classify(far, scan, in_smoke), BeamKind::kUnknown) << far << ": in smoke no echo clears nothing";
    EXPECT_EQ(classify(far, scan, clear_air), BeamKind::kFreeToMax) << far;
  }
  for (const float hit : {0.2f, 5.0f, 9.99f}) EXPECT_EQ(classify(hit, scan, in_smoke), BeamKind::kHit) << hit;
}

TEST(Classify, AShorterUsableRangeCutsHitsButNeverLengthensThem) {
  const LaserScan scan = scan_of({1});
  EXPECT_EQ(classify(6, scan, {true, 5}), BeamKind::kFreeToMax);
  EXPECT_EQ(classify(4, scan, {true, 5}), BeamKind::kHit);
  EXPECT_EQ(classify(12, scan, {true, 50}), BeamKind::kFreeToMax) << "the sensor's own maximum still holds";
}

TEST(CheckScan, AcceptsAScanFullOfNoReturns) {
  EXPECT_THAT(check(scan_of(std::vector<float>(360, kNan))), test::IsOk());
  EXPECT_THAT(check(scan_of({kInf, 0, 3})), test::IsOk());
}

TEST(CheckScan, RefusesWhatNoLaterStageShouldSee) {
  EXPECT_THAT(check(scan_of({})), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(check(scan_of(std::vector<float>(20'001, 1))), test::Fails(Errc::kTooLarge));
  const auto with = [](auto change) {
    LaserScan scan = scan_of({1, 2, 3});
    change(scan);
    return check(scan);
  };
  const double nan = std::nan("");
  EXPECT_THAT(with([](LaserScan& s) { s.angle_increment_rad = 0; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([&](LaserScan& s) { s.angle_increment_rad = nan; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([&](LaserScan& s) { s.angle_min_rad = nan; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([](LaserScan& s) { s.range_max_m = 0; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([&](LaserScan& s) { s.range_min_m = nan; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([](LaserScan& s) { s.range_min_m = -1; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([&](LaserScan& s) { s.time_increment_s = nan; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([&](LaserScan& s) { s.T_robot_laser = Pose2(nan, 0, 0); }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([](LaserScan& s) { s.intensities = {1, 2}; }), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(with([](LaserScan& s) { s.intensities = {1, 2, 3}; }), test::IsOk());
}

TEST(DistinctBeams, AFullTurnMayRepeatItsFirstBeam) {
  LaserScan scan = scan_of(std::vector<float>(361, 1));
  scan.angle_increment_rad = 2 * kPi / 360;
  EXPECT_EQ(distinct_beams(scan), 360u);
  scan.ranges_m.resize(360);
  EXPECT_EQ(distinct_beams(scan), 360u);
  scan.ranges_m.resize(181);
  EXPECT_EQ(distinct_beams(scan), 181u) << "half a turn repeats nothing";
  scan.angle_increment_rad = -2 * kPi / 180;
  EXPECT_EQ(distinct_beams(scan), 180u) << "lidars that turn the other way too";
  scan.ranges_m.clear();
  EXPECT_EQ(distinct_beams(scan), 0u);
}

TEST(HitPoints, LieAtTheirRangeAndBearing) {
  auto random = random_stream(4, 2);
  for (int round = 0; round < 50; ++round) {
    LaserScan scan = scan_of(std::vector<float>(90));
    scan.angle_min_rad = uniform(random, -kPi, kPi);
    scan.angle_increment_rad = uniform(random, -0.03, 0.03);
    for (float& r : scan.ranges_m) r = static_cast<float>(uniform(random, 0.3, 9.5));
    const auto points = hit_points(scan, {});
    ASSERT_EQ(points.size(), 90u);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(points[i].norm(), scan.ranges_m[i], 1e-5);
      const double bearing = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
      EXPECT_NEAR(wrap_angle(std::atan2(points[i].y(), points[i].x()) - bearing), 0, 1e-9);
    }
  }
}

TEST(HitPoints, LeaveOutWhatIsNoHit) {
  const auto points = hit_points(scan_of({1, kNan, 0, kInf, 2, 10, -3}), {});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_THAT(points[0], test::IsNearPoint(Point2(1, 0), 1e-6));
}

TEST(Classify, AReadingOfExactlyTheMaximumWasAWallWhereFloatRoundsDown) {
  // 5.6 as a float is less than 5.6: a log's "nothing up to 5.6 m" became a wall all around the robot.
  for (const double max_m : {5.6, 7.9, 8.1, 10.0, 29.9, 30.0, 81.83, 81.91}) {
    LaserScan scan = scan_of({1});
    scan.range_max_m = max_m;
    const auto reading = static_cast<float>(max_m);
    EXPECT_EQ(classify(reading, scan, {}), BeamKind::kUnknown) << max_m;
    EXPECT_EQ(classify(reading, scan, {true, 0}), BeamKind::kFreeToMax) << max_m;
    EXPECT_EQ(classify(reading, scan, {true, 2 * max_m}), BeamKind::kFreeToMax) << max_m;
    EXPECT_EQ(classify(std::nextafter(reading, 0.0f), scan, {}), BeamKind::kHit) << max_m;
  }
}

TEST(Classify, AReadingOfExactlyTheMinimumIsAHit) {
  for (const double min_m : {0.1, 0.12, 0.15, 0.2, 0.45, 0.7}) {
    LaserScan scan = scan_of({1});
    scan.range_min_m = min_m;
    EXPECT_EQ(classify(static_cast<float>(min_m), scan, {}), BeamKind::kHit) << min_m;
    EXPECT_EQ(classify(std::nextafter(static_cast<float>(min_m), 0.0f), scan, {}), BeamKind::kUnknown) << min_m;
  }
}

/// The whole rule in one line per case, for any reading and any sensor.
BeamKind by_the_book(float range_m, const LaserScan& scan, const BeamConvention& convention) {
  double limit_m = scan.range_max_m;
  if (convention.usable_range_m > 0) limit_m = std::min(limit_m, convention.usable_range_m);
  const bool too_near = !(range_m > 0) || range_m < scan.range_min_m;  // NaN is nowhere
  if (too_near) return BeamKind::kUnknown;
  if (range_m < limit_m) return BeamKind::kHit;
  return convention.no_return_is_free ? BeamKind::kFreeToMax : BeamKind::kUnknown;
}

TEST(Classify, AgreesWithTheBookForRandomSensorsAndReadings) {
  auto random = random_stream(4, 7);
  for (int i = 0; i < 5000; ++i) {
    LaserScan scan = scan_of({1});
    scan.range_min_m = uniform(random, 0, 1);
    scan.range_max_m = uniform(random, 1.1, 40);
    const BeamConvention convention{uniform01(random) < 0.5, uniform01(random) < 0.5 ? 0 : uniform(random, 0.1, 60)};
    auto reading = static_cast<float>(uniform(random, -2, 50));
    if (uniform01(random) < 0.1) reading = uniform01(random) < 0.5 ? kNan : kInf;
    EXPECT_EQ(classify(reading, scan, convention), by_the_book(reading, scan, convention)) << reading;
  }
}

TEST(CheckScan, RefusesEveryFieldThatIsNoNumberWhichOnlySomeWere) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const std::vector<std::function<void(LaserScan&, double)>> fields{
      [](LaserScan& s, double v) { s.angle_min_rad = v; },
      [](LaserScan& s, double v) { s.range_min_m = v; },
      [](LaserScan& s, double v) { s.angle_increment_rad = v; },
      [](LaserScan& s, double v) { s.range_max_m = v; },
      [](LaserScan& s, double v) { s.time_increment_s = v; },
      [](LaserScan& s, double v) {
        s.T_robot_laser = {v, 0, 0};
      },
      [](LaserScan& s, double v) {
        s.T_robot_laser = {0, v, 0};
      },
      [](LaserScan& s, double v) {
        s.T_robot_laser = {0, 0, v};
      }};
  for (std::size_t i = 0; i < fields.size(); ++i)
    for (const double bad : {std::nan(""), kInfinite, -kInfinite}) {
      LaserScan scan = scan_of({1, 2, 3});
      fields[i](scan, bad);
      EXPECT_THAT(check(scan), test::Fails(Errc::kCorrupt)) << "field " << i << " = " << bad;
    }
}

TEST(CheckScan, AnglesInDegreesGaveHitsAtRandom) {
  LaserScan degrees = scan_of(std::vector<float>(360, 1));
  degrees.angle_min_rad = -180;
  degrees.angle_increment_rad = 1;
  EXPECT_THAT(check(degrees), test::Fails(Errc::kCorrupt));
  LaserScan huge = scan_of({1, 1, 1});
  huge.angle_increment_rad = 1e308;  // the second beam's angle is infinite, its cosine no number
  EXPECT_THAT(check(huge), test::Fails(Errc::kCorrupt));
  LaserScan turned = scan_of(std::vector<float>(720, 1));
  turned.angle_min_rad = -2 * kPi;
  turned.angle_increment_rad = -2 * kPi / 720;
  EXPECT_THAT(check(turned), test::IsOk()) << "lidars that begin anywhere and turn the other way";
}

TEST(CheckScan, NeedsARangeBetweenItsLimits) {
  LaserScan scan = scan_of({1});
  scan.range_min_m = scan.range_max_m;
  EXPECT_THAT(check(scan), test::Fails(Errc::kCorrupt)) << "no reading could be a hit";
  scan.range_min_m = 0;
  EXPECT_THAT(check(scan), test::IsOk());
  scan.ranges_m.assign(20'000, 1);
  scan.angle_increment_rad = 2 * kPi / 20'000;
  EXPECT_THAT(check(scan), test::IsOk()) << "the most that is taken";
}

TEST(DistinctBeams, AreTheDirectionsThatNoEarlierBeamLookedIn) {
  auto random = random_stream(4, 9);
  for (int round = 0; round < 300; ++round) {
    const int in_a_turn = 1 + static_cast<int>(uniform_index(random, 400));
    const auto beams = 1 + uniform_index(random, 2 * static_cast<std::uint64_t>(in_a_turn));
    LaserScan scan = scan_of(std::vector<float>(beams, 1));
    scan.angle_increment_rad = (uniform01(random) < 0.5 ? -2 : 2) * kPi / in_a_turn;
    std::set<std::size_t> directions;
    for (std::size_t i = 0; i < beams; ++i) directions.insert(i % static_cast<std::size_t>(in_a_turn));
    EXPECT_EQ(distinct_beams(scan), directions.size()) << beams << " of " << in_a_turn;
    EXPECT_EQ(hit_points(scan, {}).size(), directions.size());
  }
}

TEST(HitPoints, TurnWithTheFirstAngle) {
  auto random = random_stream(4, 11);
  LaserScan scan = scan_of(std::vector<float>(50));
  for (float& r : scan.ranges_m) r = static_cast<float>(uniform(random, 0.3, 9));
  const auto before = hit_points(scan, {});
  const double turn = 0.7;
  scan.angle_min_rad += turn;
  const auto after = hit_points(scan, {});
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_THAT(after[i], test::IsNearPoint(Pose2(0, 0, turn) * before[i], 1e-9));
}

}  // namespace
}  // namespace smokemap
