#include "robots/robot_intake.hpp"

#include <gtest/gtest.h>

#include "tests/support/near.hpp"

namespace smokemap {
namespace {

Eigen::Quaterniond turned(double yaw, double roll = 0) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::Quaterniond(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
}

LaserScan plain_scan(Stamp stamp) { return {stamp, "", -1, 0.5, 0, 0, 10, {1, 2, 3}, {}, {}}; }

class Intake : public testing::Test {
 protected:
  std::vector<LaserScan> scans;
  std::vector<std::string> alarms;
  GatewayParams params;
  RobotGateway::Callbacks callbacks{[this](const LaserScan& scan) { scans.push_back(scan); }, {}, {}, {}};
  RobotIntake intake{"fox", params, callbacks,
                     [this](const std::string& id, const std::string&) { alarms.push_back(id); }};
  static constexpr Stamp kNow = 1'000'000'000;
};

TEST_F(Intake, HoldsScansUntilTheirPlaceIsKnownAndKeepsTheirOrder) {
  for (Stamp stamp = 1; stamp <= 3; ++stamp) intake.scan(plain_scan(stamp), "laser", kNow);
  EXPECT_TRUE(scans.empty());
  intake.own_frames().set("base_link", "laser", {0.1, 0.2, 0.3}, turned(0.5));
  intake.frames_changed({}, kNow + from_seconds(0.1));
  ASSERT_EQ(scans.size(), 3u);
  for (Stamp i = 0; i < 3; ++i) EXPECT_EQ(scans[static_cast<std::size_t>(i)].stamp, i + 1);
  EXPECT_THAT(scans[0].T_robot_laser, test::IsNear(Pose2(0.1, 0.2, 0.5), 1e-12, 1e-12));
  EXPECT_EQ(scans[0].robot, "fox");
}

TEST_F(Intake, GivesUpAfterAWhileAndSaysSo) {
  intake.scan(plain_scan(1), "laser", kNow);
  intake.tick(kNow + from_seconds(0.4));
  EXPECT_TRUE(alarms.empty());
  intake.tick(kNow + from_seconds(0.6));
  EXPECT_EQ(alarms, std::vector<std::string>{"mount:laser"});
  EXPECT_EQ(intake.link().dropped.at("place of the sensor unknown"), 1u);
}

TEST_F(Intake, NeverHoldsMoreThanItsShare) {
  for (Stamp stamp = 0; stamp < 100; ++stamp) intake.scan(plain_scan(stamp), "laser", kNow);
  EXPECT_EQ(intake.link().dropped.at("place of the sensor unknown"), 68u);
  intake.own_frames().set("base_link", "laser", {0, 0, 0}, turned(0));
  intake.frames_changed({}, kNow);
  ASSERT_EQ(scans.size(), 32u);
  EXPECT_EQ(scans[0].stamp, 68) << "the newest stay";
}

TEST_F(Intake, TurnsTheBeamsOfALaserThatHangsUpsideDown) {
  intake.own_frames().set("base_link", "laser", {0, 0, 0}, turned(0.25, kPi));
  intake.scan(plain_scan(1), "laser", kNow);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].angle_min_rad, 1);
  EXPECT_EQ(scans[0].angle_increment_rad, -0.5);
  EXPECT_NEAR(scans[0].T_robot_laser.heading(), 0.25, 1e-12);
}

TEST_F(Intake, MeasuresFromTheFrameThatOdometryMoves) {
  FrameTree shared;
  shared.set("footprint", "base_link", {0, 0, 0.1}, turned(0));
  shared.set("base_link", "laser", {0.3, 0, 0}, turned(0));
  shared.set("footprint", "elsewhere", {5, 5, 0}, turned(0));
  intake.odometry({1, "", Pose2(), 0, 0}, "odom", "elsewhere", kNow);
  intake.frames_changed(shared, kNow);
  intake.scan(plain_scan(1), "laser", kNow);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_THAT(scans[0].T_robot_laser, test::IsNear(Pose2(-4.7, -5, 0), 1e-12, 1e-12));
}

TEST_F(Intake, CountsWhatItLeavesOut) {
  LaserScan empty = plain_scan(1);
  empty.ranges_m.clear();
  intake.scan(empty, "laser", kNow);
  intake.sweep({}, "radar", kNow);
  EXPECT_EQ(intake.link().dropped.at("scan without ranges"), 1u);
  EXPECT_EQ(intake.link().dropped.at("radar sweep without usable size"), 1u);
  EXPECT_EQ(intake.link().last_heard, kNow) << "heard it was";
}

}  // namespace
}  // namespace smokemap
