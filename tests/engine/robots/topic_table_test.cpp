#include "robots/topic_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robots/link.hpp"
#include "robots/ros_names.hpp"

namespace smokemap {
namespace {

/// Endpoints with numbers for names.
struct Network {
  void writes(const std::string& topic, const char* type, std::uint8_t participant = 1, OfferedQos offer = {}) {
    table.add_writer(next_id(), {topic, type, offer, guid(participant)});
  }
  void reads(const std::string& topic, const char* type) { table.add_reader(next_id(), {topic, type, {}, guid(1)}); }
  static DdsGuid guid(std::uint8_t number) {
    DdsGuid id{};
    id[0] = number;
    return id;
  }
  DdsGuid next_id() { return guid(++last); }
  TopicTable table;
  std::uint8_t last = 100;
};

TEST(TopicTable, MakesARobotOfEveryNamespaceWithAScan) {
  Network net;
  net.writes("rt/red/scan", kScanTypeName);
  net.writes("rt/red/odom", kOdometryTypeName);
  net.writes("rt/red/tf_static", kTransformsTypeName);
  net.writes("rt/red/radar", kImageTypeName);
  net.reads("rt/red/cmd_vel", kTwistTypeName);
  net.reads("rt/red/goal_pose", kPoseTypeName);
  net.writes("rt/blue/laser/scan", kScanTypeName);
  net.writes("rt/camera/odom", kOdometryTypeName);
  net.writes("rt/tf_static", kTransformsTypeName);
  const auto robots = net.table.robots();
  ASSERT_EQ(robots.size(), 2u) << "what has no scan is no robot";
  EXPECT_EQ(robots[0].robot, "blue");
  EXPECT_EQ(robots[0].scan, "rt/blue/laser/scan");
  EXPECT_THAT(robots[0].fixed_transforms, testing::ElementsAre("rt/tf_static"));
  EXPECT_EQ(robots[0].odometry, "");
  const RobotTopics red{"red",
                        "rt/red/scan",
                        "rt/red/odom",
                        "rt/red/radar",
                        "",
                        {"rt/red/tf_static", "rt/tf_static"},
                        "rt/red/cmd_vel",
                        "rt/red/goal_pose",
                        false,
                        "",
                        true};
  EXPECT_EQ(robots[1], red);
}

TEST(TopicTable, GivesALoneRobotTheTopicsWithoutANamespace) {
  Network net;
  net.writes("rt/lidar/scan", kScanTypeName);
  net.writes("rt/odom", kOdometryTypeName);
  net.reads("rt/cmd_vel", kTwistTypeName);
  auto robots = net.table.robots();
  ASSERT_EQ(robots.size(), 1u);
  EXPECT_EQ(robots[0].odometry, "rt/odom");
  EXPECT_EQ(robots[0].velocity, "rt/cmd_vel");
  net.writes("rt/scan", kScanTypeName);  // now they belong to somebody
  robots = net.table.robots();
  ASSERT_EQ(robots.size(), 2u);
  EXPECT_EQ(robots[0].robot, "lidar");
  EXPECT_EQ(robots[0].odometry, "");
  EXPECT_EQ(robots[1].robot, kLoneRobot);
  EXPECT_EQ(robots[1].odometry, "rt/odom");
}

TEST(TopicTable, PrefersTheUsualNamesAndStampedVelocities) {
  Network net;
  net.writes("rt/a_scan_filtered", kScanTypeName);
  net.writes("rt/scan", kScanTypeName);
  net.writes("rt/a_odom", kOdometryTypeName);
  net.writes("rt/odom", kOdometryTypeName);
  net.reads("rt/cmd_vel", kTwistTypeName);
  net.reads("rt/cmd_vel", kTwistStampedTypeName);
  const auto robots = net.table.robots();
  ASSERT_EQ(robots.size(), 1u);
  EXPECT_EQ(robots[0].scan, "rt/scan");
  EXPECT_EQ(robots[0].odometry, "rt/odom");
  EXPECT_TRUE(robots[0].stamped_velocity);
}

TEST(TopicTable, ForgetsWhoLeaves) {
  Network net;
  net.writes("rt/scan", kScanTypeName, 3);
  EXPECT_TRUE(net.table.writes(Network::guid(3), "rt/scan"));
  EXPECT_FALSE(net.table.writes(Network::guid(3), "rt/odom"));
  net.table.remove(Network::guid(net.last));
  EXPECT_FALSE(net.table.writes(Network::guid(3), "rt/scan"));
  EXPECT_TRUE(net.table.robots().empty());
}

TEST(TopicTable, OffersWhatTheWeakestWriterOffers) {
  Network net;
  net.writes("rt/tf_static", kTransformsTypeName, 1, {true, true});
  EXPECT_TRUE(net.table.offer("rt/tf_static").transient_local);
  net.writes("rt/tf_static", kTransformsTypeName, 2, {true, false});
  EXPECT_FALSE(net.table.offer("rt/tf_static").transient_local);
  EXPECT_TRUE(net.table.offer("rt/tf_static").reliable);
  EXPECT_FALSE(net.table.offer("rt/nobody").reliable);
}

/// The identifier of an endpoint that the DDS of this maker made.
DdsGuid made_by(std::uint8_t vendor, std::uint8_t number) {
  DdsGuid id{};
  id[0] = 1, id[1] = vendor, id[2] = number;
  return id;
}
constexpr std::uint8_t kCycloneVendor = 0x10, kFastVendor = 0x0f, kConnextVendor = 0x01;

TEST(TopicTable, FindsNavigatorsAndHowTheySpeak) {
  Network net;
  for (const char* robot : {"cat", "dog", "fox"}) net.writes("rt/" + std::string(robot) + "/scan", kScanTypeName);
  const auto serves = [&](const std::string& topic, std::uint8_t vendor, const char* type = kSendGoalTypeName) {
    net.table.add_reader(made_by(vendor, ++net.last), {topic, type, {}, {}});
  };
  serves("rq/cat/navigate_to_pose/_action/send_goalRequest", kCycloneVendor);
  serves("rq/dog/navigate_to_pose/_action/send_goalRequest", kFastVendor);
  serves("rq/fox/navigate_to_pose/_action/send_goalRequest", kConnextVendor);
  serves("rq/fox/spin/_action/send_goalRequest", kCycloneVendor);
  serves("rq/fox/navigate_to_pose/_action/send_goalRequest", kCycloneVendor, kPoseTypeName);
  const auto robots = net.table.robots();
  ASSERT_EQ(robots.size(), 3u);
  EXPECT_EQ(robots[0].navigation, "cat/navigate_to_pose");
  EXPECT_TRUE(robots[0].headed_services);
  EXPECT_EQ(robots[1].navigation, "dog/navigate_to_pose");
  EXPECT_FALSE(robots[1].headed_services);
  EXPECT_EQ(robots[2].navigation, "") << "a vendor whose services are not known, another action, another type";
  net.table.remove(made_by(kCycloneVendor, 104));
  EXPECT_EQ(net.table.robots()[0].navigation, "");
}

TEST(TopicTable, GivesALoneRobotTheNavigatorWithoutANamespace) {
  Network net;
  net.writes("rt/scan", kScanTypeName);
  net.table.add_reader(made_by(kFastVendor, 9),
                       {"rq/navigate_to_pose/_action/send_goalRequest", kSendGoalTypeName, {}, {}});
  ASSERT_EQ(net.table.robots().size(), 1u);
  EXPECT_EQ(net.table.robots()[0].navigation, "navigate_to_pose");
}

TEST(RosNames, OfNavigatorsAreTakenApart) {
  const auto fox = parse_navigation_server("rq/fox/navigate_to_pose/_action/send_goalRequest");
  ASSERT_TRUE(fox);
  EXPECT_EQ(fox->robot, "fox");
  EXPECT_EQ(fox->action, "fox/navigate_to_pose");
  EXPECT_EQ(parse_navigation_server("rq/navigate_to_pose/_action/send_goalRequest")->robot, kLoneRobot);
  EXPECT_EQ(parse_navigation_server("rq/fox/base/navigate_to_pose/_action/send_goalRequest")->robot, "fox");
  for (const char* other :
       {"", "rq/", "rq//_action/send_goalRequest", "rq/_action/send_goalRequest", "rt/fox/navigate_to_pose",
        "rq/fox/navigate_to_pose/_action/cancel_goalRequest", "rq//navigate_to_pose/_action/send_goalRequest",
        "rq/fox/navigate_to_poses/_action/send_goalRequest", "rr/fox/navigate_to_pose/_action/send_goalReply"})
    EXPECT_FALSE(parse_navigation_server(other)) << other;
}

TEST(RosNames, GoThereAndBack) {
  EXPECT_EQ(dds_topic("robot", "scan"), "rt/scan");
  EXPECT_EQ(dds_topic("fox", "scan"), "rt/fox/scan");
  EXPECT_EQ(parse_dds_topic("rt/scan")->robot, "robot");
  EXPECT_EQ(parse_dds_topic("rt/fox/front/scan")->robot, "fox");
  EXPECT_EQ(parse_dds_topic("rt/fox/front/scan")->last_word, "scan");
  for (const char* other : {"rq/fox/goRequest", "rr/fox/goReply", "ros_discovery_info", "rt/", "rt//scan", "rt/fox/",
                            "", "rt/navigate/_action/status"})
    EXPECT_FALSE(parse_dds_topic(other)) << other;
}

TEST(RosNames, KnowWhatMayNameARobot) {
  for (const char* good : {"robot", "Fox_2", "_x"}) EXPECT_TRUE(is_robot_name(good));
  for (const char* bad : {"", "2fox", "fox/2", "fox 2", "f\xC3\xB6x"}) EXPECT_FALSE(is_robot_name(bad));
}

TEST(LinkFreshness, AgesFromFreshOverStaleToLost) {
  const LinkParams params{1.0, 5.0};
  EXPECT_EQ(link_state(0, from_seconds(0.99), params), LinkFreshness::kFresh);
  EXPECT_EQ(link_state(0, from_seconds(1.01), params), LinkFreshness::kStale);
  EXPECT_EQ(link_state(0, from_seconds(5.01), params), LinkFreshness::kLost);
  EXPECT_EQ(link_state(from_seconds(10), from_seconds(9), params), LinkFreshness::kFresh)
      << "a clock that stepped back";
  EXPECT_STREQ(to_string(LinkFreshness::kStale), "stale");
}

}  // namespace
}  // namespace smokemap
