#include "maps/laser_scan.hpp"

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace smokemap
