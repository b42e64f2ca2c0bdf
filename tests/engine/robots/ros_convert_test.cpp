// Between the structs that Cyclone decodes and our nouns: nothing a stranger writes into one may get past as a noun.

#include "robots/ros_convert.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "maps/radar_image.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

geometry_msgs_msg_dds__Quaternion_ yaw(double heading) { return {0, 0, std::sin(heading / 2), std::cos(heading / 2)}; }

RosOdometryMsg odometry_message(double x, double y, const geometry_msgs_msg_dds__Quaternion_& q) {
  RosOdometryMsg message{};
  message.pose.pose.position = {x, y, 0};
  message.pose.pose.orientation = q;
  return message;
}

TEST(RosTime, ComesBackForEveryMoment) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const auto stamp = static_cast<Stamp>(uniform(random, -2e9, 2e9) * 1e9);
    const RosTimeMsg time = to_ros_time(stamp);
    EXPECT_LT(time.nanosec, 1'000'000'000u);
    EXPECT_EQ(to_stamp(time), stamp);
  }
  EXPECT_EQ(to_ros_time(-1).sec, -1) << "before the epoch too";
  EXPECT_EQ(to_ros_time(-1).nanosec, 999'999'999u);
  EXPECT_EQ(to_stamp({7, 5}), 7'000'000'005);
}

TEST(RosText, OfNothingIsEmpty) {
  EXPECT_EQ(text_of(nullptr), "");
  EXPECT_EQ(text_of("laser"), "laser");
}

TEST(RosOdometry, KeepsPlanePosesOfTiltedAndUnnormalisedQuaternions) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose(uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -3.1, 3.1));
    auto q = yaw(pose.heading());
    const double scale = uniform(random, 0.5, 2);
    q.z *= scale, q.w *= scale;
    const auto odometry = to_odometry(odometry_message(pose.x(), pose.y(), q));
    ASSERT_THAT(odometry, test::IsOk());
    EXPECT_THAT(odometry->T_odom_robot, test::IsNear(pose, 1e-9, 1e-9));
  }
}

TEST(RosOdometry, IsRefusedWhereItSaysNoPlace) {
  for (const double bad : {kNan, kInf, -kInf}) {
    EXPECT_THAT(to_odometry(odometry_message(bad, 0, yaw(0))), test::Fails(Errc::kCorrupt));
    EXPECT_THAT(to_odometry(odometry_message(0, bad, yaw(0))), test::Fails(Errc::kCorrupt));
    EXPECT_THAT(to_odometry(odometry_message(0, 0, {0, 0, bad, 1})), test::Fails(Errc::kCorrupt));
    auto fast = odometry_message(0, 0, yaw(0));
    fast.twist.linear.x = bad;
    EXPECT_THAT(to_odometry(fast), test::Fails(Errc::kCorrupt));
    auto spinning = odometry_message(0, 0, yaw(0));
    spinning.twist.angular.z = bad;
    EXPECT_THAT(to_odometry(spinning), test::Fails(Errc::kCorrupt));
  }
  EXPECT_THAT(to_odometry(odometry_message(0, 0, {0, 0, 0, 0})), test::Fails(Errc::kCorrupt)) << "no turn at all";
}

TEST(RosTransforms, AreTakenOneByOneAndTheUnsoundCounted) {
  std::string odom = "odom", base = "base_link", laser = "laser";
  std::vector<RosTransformMsg> sent(4);
  for (RosTransformMsg& t : sent) t.transform.rotation = yaw(0);
  sent[0].header.frame_id = base.data(), sent[0].child_frame_id = laser.data(), sent[0].transform.translation.x = 0.2;
  sent[1].header.frame_id = nullptr, sent[1].child_frame_id = nullptr;
  sent[2].header.frame_id = base.data(), sent[2].child_frame_id = odom.data();
  sent[2].transform.translation.y = kNan;
  sent[3].header.frame_id = base.data(), sent[3].child_frame_id = odom.data();
  sent[3].transform.rotation = {0, 0, 0, 0};
  FrameTree tree;
  EXPECT_GE(add_transforms({{4, 4, sent.data(), false}}, tree), 2);
  const auto mount = tree.mount("base_link", "laser");
  ASSERT_TRUE(mount);
  EXPECT_NEAR(mount->T_robot_sensor.x(), 0.2, 1e-12);
  EXPECT_FALSE(tree.mount("base_link", "odom"));
  EXPECT_EQ(add_transforms({{0, 0, nullptr, false}}, tree), 0);
}

/// A picture of a sweep as a robot sends it, and what may be wrong with it.
struct RadarPicture {
  RadarPicture() {
    RadarSweep sweep;
    sweep.duration_s = 0.4;
    sweep.azimuth_increment_rad = 2 * kPi / 8;
    sweep.range_min_m = 0.5;
    sweep.range_resolution_m = 0.25;
    sweep.azimuths = 8;
    sweep.bins = 10;
    sweep.power.assign(80, 2.f);
    rows = to_radar_rows(sweep);
    message.height = 8;
    message.width = static_cast<std::uint32_t>(10 + kRadarRowHeader);
    message.encoding = encoding.data();
    message.step = message.width * 4;
    message.header.stamp = {3, 0};
    borrow();
  }
  void borrow() {
    const auto bytes = static_cast<std::uint32_t>(rows.size() * sizeof(float));
    message.data = {bytes, bytes, reinterpret_cast<std::uint8_t*>(rows.data()), false};
  }
  std::string encoding = "32FC1";
  std::vector<float> rows;
  RosImageMsg message{};
};

TEST(RosRadar, IsReadFromItsPicture) {
  RadarPicture picture;
  const auto sweep = to_sweep(picture.message);
  ASSERT_THAT(sweep, test::IsOk());
  EXPECT_EQ(sweep->azimuths, 8);
  EXPECT_EQ(sweep->bins, 10);
  EXPECT_EQ(sweep->stamp, 3'000'000'000);
  EXPECT_NEAR(sweep->range_resolution_m, 0.25, 1e-6);
}

TEST(RosRadar, IsRefusedWhenThePictureLies) {
  const auto refused = [](auto&& spoil) {
    RadarPicture picture;
    spoil(picture);
    return !to_sweep(picture.message).ok();
  };
  EXPECT_TRUE(refused([](RadarPicture& p) { p.encoding = "mono8", p.message.encoding = p.encoding.data(); }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.encoding = nullptr; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.is_bigendian = 1; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.height = 9; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.height = 0xFFFFFFFF; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.width = 0xFFFFFFFF; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.step += 4; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.data._length -= 4; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.message.height = p.message.width = p.message.step = 0; }));
  EXPECT_TRUE(refused([](RadarPicture& p) { p.rows[0] = std::numeric_limits<float>::quiet_NaN(); }));
}

TEST(RosRadar, SurvivesAnyFloatsInItsRows) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    RadarPicture picture;
    for (std::uint64_t n = 1 + uniform_index(random, 4); n > 0; --n) {
      const auto bits = static_cast<std::uint32_t>(random());
      std::memcpy(&picture.rows[uniform_index(random, picture.rows.size())], &bits, sizeof bits);
    }
    const auto sweep = to_sweep(picture.message);
    EXPECT_TRUE(!sweep || sweep->power.size() == 80u);
  }
}

TEST(RosGoals, ComeBackAsTheyWereSent) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 50; ++i) {
    const Pose2 goal(uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -3.1, 3.1));
    const std::string frame = "map";
    const RosPoseMsg message = ros_pose(goal, frame, 5);
    const auto back = to_pose(message);
    ASSERT_THAT(back, test::IsOk());
    EXPECT_THAT(*back, test::IsNear(goal, 1e-12, 1e-12));
    EXPECT_EQ(text_of(message.header.frame_id), "map");
    EXPECT_EQ(to_stamp(message.header.stamp), 5);
  }
}

}  // namespace
}  // namespace smokemap
