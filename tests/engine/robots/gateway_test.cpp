#include "robots/gateway.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "robots/dds_domain.hpp"
#include "robots/ros_convert.hpp"
#include "robots/ros_qos.hpp"
#include "robots/ros_robot.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/ros_domain.hpp"

namespace smokemap {
namespace {

using test::eventually;

LaserScan wire_scan(Stamp stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.angle_min_rad = -2.5f;
  scan.angle_increment_rad = 0.0078125f;
  scan.time_increment_s = 0.0001220703125f;
  scan.range_min_m = 0.125;
  scan.range_max_m = 12;
  for (int i = 0; i < 360; ++i) scan.ranges_m.push_back(0.5f + 0.01f * static_cast<float>(i));
  scan.ranges_m[7] = std::numeric_limits<float>::infinity();
  scan.ranges_m[9] = 0;
  scan.ranges_m[11] = 24.8f;
  scan.intensities.assign(360, 47.f);
  return scan;
}

RadarSweep wire_sweep(Stamp stamp) {
  RadarSweep sweep;
  sweep.stamp = stamp;
  sweep.duration_s = 0.4;
  sweep.azimuth_increment_rad = 2 * kPi / 64;
  sweep.range_min_m = 0.25;
  sweep.range_resolution_m = 0.0625;
  sweep.azimuths = 64;
  sweep.bins = 100;
  for (int i = 0; i < 6400; ++i) sweep.power.push_back(static_cast<float>(i % 97) * 0.5f);
  return sweep;
}

/// A gateway whose deliveries can be waited for.
struct Listening {
  explicit Listening(GatewayParams params = {}) {
    params.domain = test::ros_domain();
    auto opened = RobotGateway::open(
        params,
        {[this](const LaserScan& s) { scans.put(s); }, [this](const Odometry& o) { odometry.put(o); },
         [this](const RadarSweep& s) { sweeps.put(s); }, [this](const GatewayAlarm& a) { alarms.put(a); }},
        std::make_shared<SystemClock>());
    EXPECT_THAT(opened, test::IsOk());
    gateway = std::move(*opened);
  }
  RobotLink link(const std::string& robot) const {
    for (const RobotLink& link : gateway->robots())
      if (link.id == robot) return link;
    return {};
  }
  test::Mailbox<LaserScan> scans;
  test::Mailbox<Odometry> odometry;
  test::Mailbox<RadarSweep> sweeps;
  test::Mailbox<GatewayAlarm> alarms;
  std::unique_ptr<RobotGateway> gateway;
};

struct SentTwist {
  double speed, turn;
  bool operator==(const SentTwist&) const = default;
};

struct SimulatedRobot {
  explicit SimulatedRobot(RosRobotParams params = {}) {
    params.domain = test::ros_domain();
    auto opened = RosRobotNode::open(params, {[this](double v, double w) {
                                                velocities.put({v, w});
                                              },
                                              [this](const Pose2& goal, const std::string&) { goals.put(goal); }});
    EXPECT_THAT(opened, test::IsOk());
    node = std::move(*opened);
  }
  test::Mailbox<SentTwist> velocities;
  test::Mailbox<Pose2> goals;
  std::unique_ptr<RosRobotNode> node;
};

TEST(RobotGateway, DeliversEveryFieldOfAScanAsItWasSent) {
  Listening here;
  SimulatedRobot robot;
  LaserScan sent = wire_scan(1'700'000'000'123'456'789);
  sent.T_robot_laser = Pose2(0.25, -0.125, 1.5);
  ASSERT_TRUE(here.scans.wait_poking([&] { robot.node->publish(sent); }));
  const LaserScan got = here.scans.all()[0];
  EXPECT_EQ(got.robot, "robot");
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.angle_min_rad, sent.angle_min_rad);
  EXPECT_EQ(got.angle_increment_rad, sent.angle_increment_rad);
  EXPECT_EQ(got.time_increment_s, sent.time_increment_s);
  EXPECT_EQ(got.range_min_m, sent.range_min_m);
  EXPECT_EQ(got.range_max_m, sent.range_max_m);
  EXPECT_EQ(got.ranges_m, sent.ranges_m);
  EXPECT_EQ(got.intensities, sent.intensities);
  EXPECT_THAT(got.T_robot_laser, test::IsNear(sent.T_robot_laser, 1e-12, 1e-12));
}

TEST(RobotGateway, DeliversOdometryAndRadarSweeps) {
  RosRobotParams params;
  params.robot = "fox";
  Listening here;
  SimulatedRobot robot(params);
  const Odometry moved{42, "", Pose2(1, -2, 3), 0.5, -0.25};
  ASSERT_TRUE(here.odometry.wait_poking([&] {
    robot.node->publish(wire_scan(1));  // a robot is found by its scan
    robot.node->publish(moved);
  }));
  const Odometry odometry = here.odometry.all()[0];
  EXPECT_EQ(odometry.robot, "fox");
  EXPECT_EQ(odometry.stamp, 42);
  EXPECT_THAT(odometry.T_odom_robot, test::IsNear(moved.T_odom_robot, 1e-12, 1e-12));
  EXPECT_EQ(odometry.speed_mps, 0.5);
  EXPECT_EQ(odometry.turn_rate_radps, -0.25);

  RadarSweep sent = wire_sweep(77);
  sent.T_robot_radar = Pose2(0.5, 0, 0.25);
  ASSERT_TRUE(here.sweeps.wait_poking([&] { robot.node->publish(sent); }));
  const RadarSweep sweep = here.sweeps.all()[0];
  EXPECT_EQ(sweep.power, sent.power);
  EXPECT_EQ(sweep.stamp, 77);
  EXPECT_NEAR(sweep.duration_s, sent.duration_s, 1e-6);
  EXPECT_NEAR(sweep.azimuth_increment_rad, sent.azimuth_increment_rad, 1e-6);
  EXPECT_EQ(sweep.range_min_m, sent.range_min_m);
  EXPECT_EQ(sweep.range_resolution_m, sent.range_resolution_m);
  EXPECT_THAT(sweep.T_robot_radar, test::IsNear(sent.T_robot_radar, 1e-12, 1e-12));
  EXPECT_TRUE(eventually([&] { return here.link("fox").has_radar; }));
}

class VelocityKind : public testing::TestWithParam<bool> {};

TEST_P(VelocityKind, IsChosenByWhatTheRobotTakes) {
  RosRobotParams params;
  params.stamped_velocity = GetParam();
  Listening here;
  EXPECT_THAT(here.gateway->drive("robot", 1, 0), test::Fails(Errc::kNotFound));
  SimulatedRobot robot(params);
  ASSERT_TRUE(eventually([&] { return here.link("robot").takes_velocity; }));
  ASSERT_TRUE(
      robot.velocities.wait_poking([&] { EXPECT_THAT(here.gateway->drive("robot", 0.5, -0.75), test::IsOk()); }));
  EXPECT_EQ(robot.velocities.all()[0], (SentTwist{0.5, -0.75}));
  EXPECT_THAT(here.gateway->drive("robot", std::nan(""), 0), test::Fails(Errc::kInvalidArgument));
}

INSTANTIATE_TEST_SUITE_P(PlainOrStamped, VelocityKind, testing::Bool());

TEST(RobotGateway, SendsGoals) {
  Listening here;
  SimulatedRobot robot;
  ASSERT_TRUE(eventually([&] { return here.link("robot").takes_goals; }));
  const Pose2 goal(3, 4, -1.25);
  ASSERT_TRUE(robot.goals.wait_poking([&] { EXPECT_THAT(here.gateway->send_goal("robot", goal), test::IsOk()); }));
  EXPECT_THAT(robot.goals.all()[0], test::IsNear(goal, 1e-12, 1e-12));
  EXPECT_THAT(here.gateway->send_goal("nobody", goal), test::Fails(Errc::kNotFound));
}

TEST(RobotGateway, FindsRobotsByTheirTopicsAndKeepsThemApart) {
  Listening here;
  RosRobotParams red, blue;
  red.robot = "red";
  blue.robot = "blue";
  SimulatedRobot first(red), second(blue);
  ASSERT_TRUE(eventually([&] {
    first.node->publish(wire_scan(1));
    second.node->publish(wire_scan(2));
    return here.link("red").scans > 0 && here.link("blue").scans > 0;
  }));
  for (const LaserScan& scan : here.scans.all()) EXPECT_EQ(scan.stamp, scan.robot == "red" ? 1 : 2);
  EXPECT_EQ(here.link("red").link, LinkFreshness::kFresh);
}

TEST(RobotGateway, TakesNoCommandsForARobotThatHasGone) {
  Listening here;
  {
    SimulatedRobot robot;
    ASSERT_TRUE(eventually([&] { return here.link("robot").takes_velocity; }));
  }
  EXPECT_TRUE(eventually([&] { return !here.link("robot").takes_velocity; }));
  EXPECT_THAT(here.gateway->drive("robot", 0, 0), test::Fails(Errc::kNotFound));
  SimulatedRobot again;
  EXPECT_TRUE(here.scans.wait_poking([&] { again.node->publish(wire_scan(5)); })) << "a robot may come back";
}

TEST(RobotGateway, CountsScansThatNoLaterStageShouldSee) {
  Listening here;
  SimulatedRobot robot;
  LaserScan bad = wire_scan(1);
  bad.angle_increment_rad = std::nan("");
  ASSERT_TRUE(eventually([&] {
    robot.node->publish(bad);
    robot.node->publish(Odometry{1, "", Pose2(std::nan(""), 0, 0), 0, 0});
    const auto dropped = here.link("robot").dropped;
    return dropped.contains("scan without a usable angle increment") && dropped.contains("pose that is not finite");
  }));
  EXPECT_EQ(here.scans.size(), 0u);
  EXPECT_EQ(here.odometry.size(), 0u);
  EXPECT_TRUE(here.scans.wait_poking([&] { robot.node->publish(wire_scan(2)); })) << "a good scan still passes";
}

/// A participant that publishes what it likes.
struct Stranger {
  explicit Stranger(const std::string& topic_name, const DdsQos& qos, const dds_topic_descriptor_t* type)
      : domain(*DdsDomain::open(test::ros_domain())), participant(*domain->participant()) {
    topic = DdsEntity(dds_create_topic(participant.get(), type, topic_name.c_str(), nullptr, nullptr));
    writer = DdsEntity(dds_create_writer(participant.get(), topic.get(), qos.get(), nullptr));
    EXPECT_TRUE(static_cast<bool>(writer));
  }
  std::shared_ptr<DdsDomain> domain;
  DdsEntity participant, topic, writer;
};

TEST(RobotGateway, NeverMixesTwoSourcesOfOneTopic) {
  Listening here;
  SimulatedRobot robot;
  ASSERT_TRUE(here.scans.wait_poking([&] { robot.node->publish(wire_scan(1)); }));
  const Stranger twin("rt/scan", sensor_qos(), &sensor_msgs_msg_dds__LaserScan__desc);
  ASSERT_TRUE(here.alarms.wait_poking([&] {
    robot.node->publish(wire_scan(1));
    write_scan(twin.writer.get(), wire_scan(666), "laser");
  }));
  EXPECT_EQ(here.alarms.all()[0].id, "robot/sources:rt/scan");
  for (const LaserScan& scan : here.scans.all()) EXPECT_EQ(scan.stamp, 1);
}

TEST(RobotGateway, SaysWhenASensorsPlaceIsUnknownAndTakesOneGivenByHand) {
  GatewayParams params;
  params.mount_wait_s = 0.05;
  Listening here(params);
  const Stranger bare("rt/bare/scan", sensor_qos(), &sensor_msgs_msg_dds__LaserScan__desc);
  ASSERT_TRUE(here.alarms.wait_poking([&] { write_scan(bare.writer.get(), wire_scan(1), "rplidar"); }));
  EXPECT_EQ(here.alarms.all()[0].id, "bare/mount:rplidar");
  EXPECT_EQ(here.scans.size(), 0u);

  params.mounts["bare"] = Pose2(0.1, 0, 0);
  Listening told(params);
  ASSERT_TRUE(told.scans.wait_poking([&] { write_scan(bare.writer.get(), wire_scan(1), "rplidar"); }));
  EXPECT_THAT(told.scans.all()[0].T_robot_laser, test::IsNear(Pose2(0.1, 0, 0), 0, 0));
}

TEST(RobotGateway, ReadsATransformTreeThatIsPublishedVolatile) {
  Listening here;
  const Stranger scans("rt/old/scan", sensor_qos(), &sensor_msgs_msg_dds__LaserScan__desc);
  const Stranger frames("rt/old/tf_static", state_qos(10), &tf2_msgs_msg_dds__TFMessage__desc);
  ASSERT_TRUE(here.scans.wait_poking([&] {
    write_transforms(frames.writer.get(), {{0, "base_link", "laser", Pose2(0.2, 0.1, 0)}});
    write_scan(scans.writer.get(), wire_scan(1), "laser");
  }));
  EXPECT_THAT(here.scans.all()[0].T_robot_laser, test::IsNear(Pose2(0.2, 0.1, 0), 1e-12, 1e-12));
}

/// Writes any 48 bytes under the name of a laser scan: a twist whose type is called otherwise.
struct Forger {
  Forger() : type(geometry_msgs_msg_dds__Twist__desc) {
    type.m_typename = sensor_msgs_msg_dds__LaserScan__desc.m_typename;
    stranger.emplace("rt/scan", sensor_qos(), &type);
  }
  void write(const std::array<std::uint32_t, 12>& words) {
    RosTwistMsg bytes;
    static_assert(sizeof bytes == sizeof words);
    std::memcpy(&bytes, words.data(), sizeof bytes);
    EXPECT_EQ(dds_write(stranger->writer.get(), &bytes), DDS_RETCODE_OK);
  }
  dds_topic_descriptor_t type;
  std::optional<Stranger> stranger;
};

TEST(RobotGateway, DropsMessagesThatAreNoScanAndGoesOn) {
  Listening here;
  SimulatedRobot robot;
  Forger forger;
  const std::array<std::uint32_t, 12> endless_name{1, 2, 0x7FFFFFFF}, unended_name{1, 2, 4, 0x41414141},
      endless_ranges{1, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0xFFFFFFFF},
      random_words{7, 7, 6, 0x6573616C, 0x72, 9, 9, 9, 9, 9, 9, 3};
  ASSERT_TRUE(here.scans.wait_poking([&] {
    for (const auto& words : {endless_name, unended_name, endless_ranges, random_words}) forger.write(words);
    robot.node->publish(wire_scan(2));
  }));
  for (const LaserScan& scan : here.scans.all()) EXPECT_EQ(scan.stamp, 2);
}

TEST(RobotGateway, RefusesDomainsThatDoNotExist) {
  GatewayParams params;
  params.domain = 231;
  EXPECT_THAT(RobotGateway::open(params, {}, std::make_shared<SystemClock>()), test::Fails(Errc::kInvalidArgument));
  RosRobotParams robot;
  robot.robot = "7 of 9";
  EXPECT_THAT(RosRobotNode::open(robot, {}), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
