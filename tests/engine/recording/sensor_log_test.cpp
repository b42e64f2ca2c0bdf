#include "recording/sensor_log.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "recording/ros_messages.hpp"
#include "tests/engine/recording/bag_file.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

LaserScan some_scan(Stamp stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.angle_min_rad = -1.5f;
  scan.angle_increment_rad = 0.25f;
  scan.range_min_m = 0.125;
  scan.range_max_m = 12;
  scan.ranges_m = {1, 2, std::numeric_limits<float>::infinity(), 0, 24.8f};
  return scan;
}

Odometry some_odometry(Stamp stamp, double x) {
  Odometry odometry;
  odometry.stamp = stamp;
  odometry.T_odom_robot = Pose2(x, 2, 0.5);
  odometry.speed_mps = 0.2;
  odometry.turn_rate_radps = -0.1;
  return odometry;
}

RosTransform fixed(const std::string& parent, const std::string& child, const Eigen::Vector3d& at, double roll = 0,
                   double yaw = 0) {
  return {0, parent, child, at,
          Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
              Eigen::Quaterniond(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))};
}

/// Laser on a plate on the robot: two links, as real robots have it.
std::vector<std::uint8_t> mounts(double roll = 0) {
  return encode_transforms(
      std::vector{fixed("base_link", "plate", {0.1, 0, 0.2}), fixed("plate", "laser", {0.05, 0, 0}, roll, kPi / 2)});
}

const LaserScan* first_scan(const SensorLog& log) {
  for (const LogItem& item : log.items)
    if (const auto* scan = std::get_if<LaserScan>(&item)) return scan;
  return nullptr;
}

class Rosbag2 : public testing::TestWithParam<bool> {};

TEST_P(Rosbag2, GivesScansWithTheirMountAndOdometryInOrderOfRecording) {
  const test::ScratchFolder folder;
  {
    test::BagFile bag(folder / "run.db3", GetParam());
    bag.write("/tf_static", kTransformsType, 1, mounts());
    bag.write("/scan", kLaserScanType, 30, encode_scan(some_scan(100), "laser"));
    bag.write("/odom", kOdometryType, 20, encode_odometry(some_odometry(90, 1), "odom", "base_link"));
    bag.write("/chatter", "std_msgs/msg/String", 25, {0, 1, 0, 0});
  }
  const auto log = read_log(folder / "run.db3");
  ASSERT_THAT(log, test::IsOk());
  ASSERT_EQ(log->items.size(), 2u);
  const auto& odometry = std::get<Odometry>(log->items[0]);
  EXPECT_EQ(odometry.stamp, 90);
  EXPECT_THAT(odometry.T_odom_robot, test::IsNear(Pose2(1, 2, 0.5), 1e-12, 1e-12));
  EXPECT_EQ(odometry.turn_rate_radps, -0.1);
  const auto& scan = std::get<LaserScan>(log->items[1]);
  const LaserScan sent = some_scan(100);
  EXPECT_EQ(scan.ranges_m, sent.ranges_m);
  EXPECT_EQ(scan.angle_increment_rad, sent.angle_increment_rad);
  EXPECT_EQ(scan.range_max_m, 12);
  EXPECT_EQ(scan.robot, "robot");
  EXPECT_THAT(scan.T_robot_laser, test::IsNear(Pose2(0.15, 0, kPi / 2), 1e-9, 1e-9));
  EXPECT_TRUE(log->warnings.empty());
  EXPECT_EQ(log->dropped.at("type not used: std_msgs/msg/String"), 1u);
}

INSTANTIATE_TEST_SUITE_P(SchemaVersions, Rosbag2, testing::Bool());

TEST(SensorLog, TurnsTheBeamsOfALaserThatHangsUpsideDown) {
  const test::ScratchFolder folder;
  {
    test::BagFile bag(folder / "run.db3");
    bag.write("/tf_static", kTransformsType, 1, mounts(kPi));
    bag.write("/scan", kLaserScanType, 2, encode_scan(some_scan(100), "laser"));
  }
  const auto log = read_log(folder / "run.db3");
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(first_scan(*log)->angle_min_rad, 1.5);
  EXPECT_EQ(first_scan(*log)->angle_increment_rad, -0.25);
}

TEST(SensorLog, SaysSoWhenNobodyToldWhereTheLaserSits) {
  const test::ScratchFolder folder;
  {
    test::BagFile bag(folder / "run.db3");
    bag.write("/scan", kLaserScanType, 2, encode_scan(some_scan(100), "laser"));
  }
  const auto log = read_log(folder / "run.db3");
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(log->warnings.size(), 1u);
  EXPECT_THAT(first_scan(*log)->T_robot_laser, test::IsNear(Pose2(), 0, 0));
}

TEST(SensorLog, TakesOdometryFromTransformsWhereThereIsNoTopic) {
  const test::ScratchFolder folder;
  {
    test::BagFile bag(folder / "run.db3");
    bag.write("/tf", kTransformsType, 1,
              encode_transforms(std::vector{fixed("odom", "base_link", {3, 4, 0}, 0, 0.25)}));
    bag.write("/scan", kLaserScanType, 2, encode_scan(some_scan(100), "laser"));
  }
  const auto log = read_log(folder / "run.db3");
  ASSERT_THAT(log, test::IsOk());
  ASSERT_EQ(log->odometry_readings(), 1u);
  EXPECT_THAT(std::get<Odometry>(log->items[0]).T_odom_robot, test::IsNear(Pose2(3, 4, 0.25), 1e-9, 1e-9));
}

TEST(SensorLog, KeepsTwoRobotsApartAndChoosesOneLaserForEach) {
  const test::ScratchFolder folder;
  {
    test::BagFile bag(folder / "run.db3");
    for (const std::string robot : {"/r1", "/r2"}) {
      bag.write(robot + "/odom", kOdometryType, 1,
                encode_odometry(some_odometry(1, robot == "/r1" ? 1 : 2), "odom", "base_link"));
      bag.write(robot + "/lidar/scan", kLaserScanType, 2, encode_scan(some_scan(2), "laser"));
      bag.write(robot + "/lidar/filtered", kLaserScanType, 3, encode_scan(some_scan(3), "laser"));
      bag.write(robot + "/lidar/filtered", kLaserScanType, 4, encode_scan(some_scan(4), "laser"));
    }
  }
  const auto log = read_log(folder / "run.db3");
  ASSERT_THAT(log, test::IsOk());
  std::map<std::string, int> scans, odometry;
  for (const LogItem& item : log->items) {
    if (const auto* scan = std::get_if<LaserScan>(&item)) ++scans[scan->robot];
    if (const auto* reading = std::get_if<Odometry>(&item)) {
      ++odometry[reading->robot];
      EXPECT_EQ(reading->T_odom_robot.x(), reading->robot == "r1" ? 1 : 2);
    }
  }
  EXPECT_THAT(scans, testing::ElementsAre(testing::Pair("r1", 1), testing::Pair("r2", 1)));
  EXPECT_THAT(odometry, testing::ElementsAre(testing::Pair("r1", 1), testing::Pair("r2", 1)));
}

TEST(SensorLog, CountsWhatNoLaterStageShouldSee) {
  const test::ScratchFolder folder;
  {
    test::BagFile bag(folder / "run.db3");
    LaserScan empty = some_scan(1), still = some_scan(2), lost = some_scan(3);
    empty.ranges_m.clear();
    still.angle_increment_rad = 0;
    bag.write("/scan", kLaserScanType, 1, encode_scan(empty, "laser"));
    bag.write("/scan", kLaserScanType, 2, encode_scan(still, "laser"));
    auto cut = encode_scan(lost, "laser");
    cut.resize(40);
    bag.write("/scan", kLaserScanType, 3, cut);
    bag.write("/scan", kLaserScanType, 4, encode_scan(some_scan(4), "laser"));
    Odometry nowhere = some_odometry(5, std::nan(""));
    bag.write("/odom", kOdometryType, 5, encode_odometry(nowhere, "odom", "base_link"));
  }
  const auto log = read_log(folder / "run.db3");
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(log->scans(), 1u);
  EXPECT_EQ(log->dropped.at("scan without ranges"), 1u);
  EXPECT_EQ(log->dropped.at("scan without a usable angle increment"), 1u);
  EXPECT_EQ(log->dropped.at("damaged message of /scan"), 1u);
  EXPECT_EQ(log->dropped.at("odometry that is not finite"), 1u);
}

TEST(SensorLog, ReadsAFolderOfSplitBagsInTheOrderOfTheirNumbers) {
  const test::ScratchFolder folder;
  for (const int part : {0, 2, 10}) {
    test::BagFile bag(folder / ("run_" + std::to_string(part) + ".db3"));
    bag.write("/scan", kLaserScanType, 1, encode_scan(some_scan(part), "laser"));
  }
  const auto log = read_log(folder.path());
  ASSERT_THAT(log, test::IsOk());
  ASSERT_EQ(log->items.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(std::get<LaserScan>(log->items[i]).stamp, (std::array{0, 2, 10}[i]));
}

TEST(SensorLog, ReadsCarmenPlainAndPacked) {
  const test::ScratchFolder folder;
  const std::string text = "# log\nODOM 1 2 0.5 0 0 0 10.5 host 1\nFLASER 2 1 2 0 0 0 0 0 0 11 host 2\n";
  std::ofstream(folder / "plain.clf") << text;
  gzFile packed = gzopen((folder / "packed.log.gz").c_str(), "wb");
  gzwrite(packed, text.data(), static_cast<unsigned>(text.size()));
  gzclose(packed);
  for (const char* name : {"plain.clf", "packed.log.gz"}) {
    const auto log = read_log(folder / name);
    ASSERT_THAT(log, test::IsOk()) << name;
    EXPECT_EQ(log->format, "carmen");
    EXPECT_EQ(log->items.size(), 3u);
  }
}

TEST(SensorLog, SaysInOneLineWhyThereIsNoLog) {
  const test::ScratchFolder folder;
  EXPECT_THAT(read_log(folder / "nothing.db3"), test::Fails(Errc::kIo));
  EXPECT_THAT(read_log(folder.path()), test::Fails(Errc::kUnsupported));
  std::ofstream(folder / "letter.log") << "Dear all\n";
  EXPECT_THAT(read_log(folder / "letter.log"), test::Fails(Errc::kUnsupported));
  std::ofstream(folder / "broken.db3") << std::string("SQLite format 3\0", 16) << "and nothing else";
  EXPECT_THAT(read_log(folder / "broken.db3"), test::Fails(Errc::kCorrupt));
  { const test::BagFile empty(folder / "empty.db3"); }
  EXPECT_THAT(read_log(folder / "empty.db3"), test::Fails(Errc::kDegenerate));
}

TEST(Rosbag2, ReadingABagLaidTwoFilesBesideIt) {
  const test::ScratchFolder folder;
  const auto path = folder / "50% #1 of what?.db3";
  {
    test::BagFile bag(path, true, true);
    bag.write("/tf_static", kTransformsType, 1, mounts());
    bag.write("/scan", kLaserScanType, 2, encode_scan(some_scan(100), "laser"));
  }
  const auto log = read_log(path);
  ASSERT_THAT(log, test::IsOk());
  EXPECT_EQ(log->items.size(), 1u);
  const std::filesystem::directory_iterator files(path.parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "a log of its own, or a lock";
}

}  // namespace
}  // namespace smokemap
