#include "slam/reading_poses.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/random.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

Reading odometry_at(double seconds, const Pose2& T_odom_robot) {
  return {from_seconds(seconds), T_odom_robot, std::nullopt};
}

Reading scan_at_pose(double seconds, const Pose2& T_odom_robot, std::size_t scan) {
  return {from_seconds(seconds), T_odom_robot, scan};
}

StampedPose posed(double seconds, const Pose2& T_map_robot) {
  return {from_seconds(seconds), T_map_robot, Eigen::Matrix3d::Zero()};
}

TEST(PosesOfReadings, AreThoseOfTheScansWhereOdometryIsOnlyAnotherFrame) {
  std::mt19937_64 random(1);
  const Pose2 T_map_odom(3, -2, 1.1);
  std::vector<Reading> readings;
  Trajectory scans;
  Pose2 at;
  for (int i = 0; i < 200; ++i) {
    at = at * Pose2(uniform(random, 0, 0.1), 0, uniform(random, -0.2, 0.2));
    const double seconds = 0.1 * i;
    if (i % 5 == 0) {
      readings.push_back(scan_at_pose(seconds, at, scans.size()));
      scans.push_back(posed(seconds, T_map_odom * at));
    } else {
      readings.push_back(odometry_at(seconds, at));
    }
  }
  const Trajectory poses = poses_of_readings(readings, scans);
  ASSERT_EQ(poses.size(), readings.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].stamp, readings[i].stamp);
    EXPECT_THAT(poses[i].T_map_robot, IsNear(T_map_odom * *readings[i].T_odom_robot, 1e-9, 1e-9));
  }
}

TEST(PosesOfReadings, BlendWhatTheScanBeforeAndTheOneAfterSay) {
  // Odometry says 3 m, the scans say 3.3 m: a third of the way there a third of the difference.
  const std::vector<Reading> readings{scan_at_pose(0, {0, 0, 0}, 0), odometry_at(1, {1, 0, 0}),
                                      odometry_at(2, {2, 0, 0}), scan_at_pose(3, {3, 0, 0}, 1)};
  const Trajectory poses = poses_of_readings(readings, {posed(0, {0, 0, 0}), posed(3, {3.3, 0, 0})});
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_NEAR(poses[1].T_map_robot.x(), 1.1, 1e-12);
  EXPECT_NEAR(poses[2].T_map_robot.x(), 2.2, 1e-12);
  EXPECT_NEAR(poses[3].T_map_robot.x(), 3.3, 1e-12);
}

TEST(PosesOfReadings, FollowOdometryAfterTheLastScanAndSayNothingBeforeTheFirst) {
  const std::vector<Reading> readings{odometry_at(0, {0, 0, 0}), scan_at_pose(1, {1, 0, 0}, 0),
                                      odometry_at(2, {1.5, 0, 0})};
  const Trajectory poses = poses_of_readings(readings, {posed(1, {7, 7, kPi / 2})});
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].stamp, from_seconds(1));
  EXPECT_THAT(poses[1].T_map_robot, IsNear(Pose2(7, 7.5, kPi / 2), 1e-12, 1e-12));
}

TEST(PosesOfReadings, AreTheScansAloneWithoutOdometry) {
  std::vector<Reading> readings;
  Trajectory scans;
  for (std::size_t i = 0; i < 5; ++i) {
    readings.push_back({from_seconds(0.1 * static_cast<double>(i)), std::nullopt, i});
    scans.push_back(posed(0.1 * static_cast<double>(i), {static_cast<double>(i), 0, 0}));
  }
  const Trajectory poses = poses_of_readings(readings, scans);
  ASSERT_EQ(poses.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(poses[i].T_map_robot.x(), static_cast<double>(i));
}

/// A burst written after a pause: three readings within three milliseconds, 0.1 m apart each.
TEST(PosesOfReadings, GiveOneMomentOnePose) {
  const std::vector<Reading> readings{scan_at_pose(10, {0, 0, 0.1}, 0), odometry_at(12.003, {0.1, 0, 0.1}),
                                      odometry_at(12, {0.2, 0, 0.2}), scan_at_pose(12, {0.3, 0, 0.3}, 1),
                                      odometry_at(12.5, {0.4, 0, 0.3})};
  const Trajectory scans{posed(10, {0, 0, 0.1}), posed(12, {0.3, 0, 0.3})};
  const Trajectory poses = poses_of_readings(readings, scans);
  std::set<Stamp> stamps;
  for (const StampedPose& pose : poses) EXPECT_TRUE(stamps.insert(pose.stamp).second) << "a stamp twice";
  ASSERT_EQ(poses.size(), 4u);  // 10, 12.003, 12, 12.5
  EXPECT_THAT(poses[1].T_map_robot, IsNear(Pose2(0.2, 0, 0.2), 0.02, 1e-9));
  EXPECT_THAT(poses[2].T_map_robot, IsNear(poses[1].T_map_robot, 1e-12, 1e-12));
  EXPECT_NEAR(poses[3].T_map_robot.x(), 0.4, 0.01);
}

TEST(PosesOfReadings, MeanHeadingsAcrossTheSeam) {
  const std::vector<Reading> readings{scan_at_pose(1, {0, 0, kPi - 0.1}, 0),
                                      scan_at_pose(1.001, {0, 0, -kPi + 0.1}, 1)};
  const Trajectory poses = poses_of_readings(readings, {posed(1, {0, 0, kPi - 0.1}), posed(1.001, {0, 0, -kPi + 0.1})});
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_NEAR(std::abs(wrap_angle(poses[0].T_map_robot.heading() - kPi)), 0, 1e-9);
}

TEST(PosesOfReadings, KeepApartWhatAFastSensorKeepsApart) {
  std::vector<Reading> readings;
  Trajectory scans;
  for (std::size_t i = 0; i < 50; ++i) {  // 100 scans a second
    const Pose2 at(0.02 * static_cast<double>(i), 0, 0);
    readings.push_back(scan_at_pose(0.01 * static_cast<double>(i), at, i));
    scans.push_back(posed(0.01 * static_cast<double>(i), at));
  }
  const Trajectory poses = poses_of_readings(readings, scans);
  ASSERT_EQ(poses.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(poses[i].T_map_robot.x(), scans[i].T_map_robot.x());
}

}  // namespace
}  // namespace smokemap
