#include "recording/carmen_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

std::string flaser(const std::string& ranges, const std::string& laser, const std::string& robot, double t) {
  const auto beams = std::count(ranges.begin(), ranges.end(), ' ') + 1;
  return "FLASER " + std::to_string(beams) + " " + ranges + " " + laser + " " + robot + " " + std::to_string(t) +
         " host 9\n";
}

const LaserScan& scan_at(const SensorLog& log, std::size_t item) { return std::get<LaserScan>(log.items.at(item)); }

TEST(CarmenLog, GivesThePoseOfAScanAsOdometryJustBeforeIt) {
  const auto log =
      read_carmen("ODOM 1 2 0.5 0.3 0.1 0 10.5 host 1\n" + flaser("1 2 3 4", "1.1 2 0.5", "1 2 0.5", 11.25));
  ASSERT_THAT(log, test::IsOk());
  ASSERT_EQ(log->items.size(), 3u);
  const auto& first = std::get<Odometry>(log->items[0]);
  EXPECT_EQ(first.stamp, 10'500'000'000);
  EXPECT_DOUBLE_EQ(first.speed_mps, 0.3);
  EXPECT_THAT(std::get<Odometry>(log->items[1]).T_odom_robot, test::IsNear(Pose2(1, 2, 0.5), 1e-12, 1e-12));
  EXPECT_EQ(scan_at(*log, 2).stamp, 11'250'000'000);
  EXPECT_THAT(scan_at(*log, 2).ranges_m, testing::ElementsAre(1, 2, 3, 4));
}

TEST(CarmenLog, DividesTheFieldOfViewByAnEvenNumberOfBeamsAndPutsAnOddNumberOnBothEnds) {
  const auto even = read_carmen(flaser("1 2 3 4", "0 0 0", "0 0 0", 1));
  EXPECT_NEAR(scan_at(*even, 1).angle_min_rad, -kPi / 2, 1e-12);
  EXPECT_NEAR(scan_at(*even, 1).angle_increment_rad, kPi / 4, 1e-12);
  const auto odd = read_carmen("PARAM laser_front_laser_fov 90\n" + flaser("1 2 3", "0 0 0", "0 0 0", 1));
  EXPECT_NEAR(scan_at(*odd, 1).angle_min_rad, -kPi / 4, 1e-12);
  EXPECT_NEAR(scan_at(*odd, 1).angle_increment_rad, kPi / 4, 1e-12);
}

TEST(CarmenLog, KeepsFileOrderWhereStampsStepBack) {
  const auto log = read_carmen("ODOM 0 0 0 0 0 0 5 h 5\nODOM 1 0 0 0 0 0 4.5 h 5.1\nODOM 2 0 0 0 0 0 6 h 6\n");
  ASSERT_THAT(log, test::IsOk());
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(std::get<Odometry>(log->items[static_cast<std::size_t>(i)]).T_odom_robot.x(), i);
}

struct NoReturnCase {
  const char* params;
  const char* ranges;
  std::size_t hits;
};

/// What ctest calls the case.
void PrintTo(const NoReturnCase& c, std::ostream* out) { *out << c.params << c.ranges; }

class CarmenNoReturn : public testing::TestWithParam<NoReturnCase> {};

TEST_P(CarmenNoReturn, IsNeverAHit) {
  const auto log = read_carmen(GetParam().params + flaser(GetParam().ranges, "0 0 0", "0 0 0", 1));
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(hit_points(scan_at(*log, 1), {}).size(), GetParam().hits);
}

INSTANTIATE_TEST_SUITE_P(AsSensorsSayIt, CarmenNoReturn,
                         testing::Values(NoReturnCase{"", "1 2 79.5 81.83 81.91 80", 3},   // SICK LMS
                                         NoReturnCase{"", "1 2 49.91 50 51.15 51.16", 3},  // SICK PLS
                                         NoReturnCase{"", "1 2 3 7.25", 4},                // the longest was a wall
                                         NoReturnCase{"", "1 8 8 8 8 8 8 8 8 8 8 8", 1},   // the longest says nothing
                                         NoReturnCase{"PARAM robot_front_laser_max 5.5\n", "1 5.4 5.5 20", 2},
                                         NoReturnCase{"", "0 0 3", 1}));

TEST(CarmenLog, TakesTheLasersPlaceFromPosesThatAgree) {
  const Pose2 T_robot_laser(0.2, 0, 0);
  std::string text;
  for (int i = 0; i < 5; ++i) {
    const Pose2 robot(i, 0.5 * i, 0.3 * i), laser = robot * T_robot_laser;
    const auto words = [](const Pose2& p) {
      return std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.heading());
    };
    text += flaser("1 2", words(laser), words(robot), i);
  }
  const auto log = read_carmen(text);
  ASSERT_THAT(log, test::IsOk());
  EXPECT_THAT(scan_at(*log, 9).T_robot_laser, test::IsNear(T_robot_laser, 1e-4, 1e-4));
  EXPECT_TRUE(log->warnings.empty());
}

TEST(CarmenLog, SaysSoWhenThePosesDisagree) {
  const auto log = read_carmen(flaser("1 2", "0 0 0", "0 0 0", 1) + flaser("1 2", "5 1 0", "4 0 0", 2));
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(log->warnings.size(), 1u);
  EXPECT_THAT(scan_at(*log, 3).T_robot_laser, test::IsNear(Pose2(), 0, 0));
}

TEST(CarmenLog, ReadsRobotlaserWithItsOwnAngles) {
  const std::string robotlaser =
      "ROBOTLASER1 4 -1.5 3.0 1.0 30 0.1 0 3 1 2 40 0 1 2 0.1 1 2 0.1 0 0 0.3 0.3 1 12.5 host 3\n";
  const auto log = read_carmen("# CARMEN Logfile\n" + robotlaser);
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(scan_at(*log, 1).angle_min_rad, -1.5);
  EXPECT_EQ(scan_at(*log, 1).range_max_m, 30);
  EXPECT_EQ(scan_at(*log, 1).stamp, 12'500'000'000);
  const auto both = read_carmen(robotlaser + flaser("1 2", "0 0 0", "0 0 0", 2));
  EXPECT_EQ(both->scans(), 1u) << "a log that has both says every scan twice";
  EXPECT_EQ(both->dropped.at("ROBOTLASER1 beside FLASER"), 1u);
}

TEST(CarmenLog, CountsLinesThatAreDamagedAndGoesOn) {
  const auto log = read_carmen(
      "FLASER 4 1 2\nFLASER 1000000000 1\nODOM 1 2 x 0 0 0 1 h 1\nODOM nan 0 0 0 0 0 1 h 1\n"
      "ODOM 1 2 3 0 0 0 1 h 1\nTRUEPOS 1 2 3\n\n  \nFLASER\n");
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(log->items.size(), 1u);
  EXPECT_EQ(log->dropped.at("damaged FLASER"), 3u);
  EXPECT_EQ(log->dropped.at("damaged ODOM"), 2u);
  EXPECT_EQ(log->dropped.at("record not used: TRUEPOS"), 1u);
}

TEST(CarmenLog, HasNoAnswerWithoutASingleRecord) {
  EXPECT_THAT(read_carmen("# CARMEN Logfile\nPARAM a b\n"), test::Fails(Errc::kDegenerate));
  EXPECT_FALSE(looks_like_carmen("Dear all, please find attached"));
  EXPECT_TRUE(looks_like_carmen("# comment\n\nFLASER 1 2"));
}

}  // namespace
}  // namespace smokemap
