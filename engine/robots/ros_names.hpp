#pragma once

#include <optional>
#include <string>

namespace smokemap {

/// ROS 2 names as DDS sees them: the topic /robot1/scan is "rt/robot1/scan".
inline constexpr const char* kScanTypeName = "sensor_msgs::msg::dds_::LaserScan_";
inline constexpr const char* kImageTypeName = "sensor_msgs::msg::dds_::Image_";
inline constexpr const char* kOdometryTypeName = "nav_msgs::msg::dds_::Odometry_";
inline constexpr const char* kTransformsTypeName = "tf2_msgs::msg::dds_::TFMessage_";
inline constexpr const char* kTwistTypeName = "geometry_msgs::msg::dds_::Twist_";
inline constexpr const char* kTwistStampedTypeName = "geometry_msgs::msg::dds_::TwistStamped_";
inline constexpr const char* kPoseTypeName = "geometry_msgs::msg::dds_::PoseStamped_";

inline constexpr const char* kSendGoalTypeName = "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_";

/// A robot without a namespace is called this.
inline constexpr const char* kLoneRobot = "robot";

/// ("robot1", "scan") -> "rt/robot1/scan"; the lone robot's topics have no namespace.
std::string dds_topic(const std::string& robot, const std::string& name);

struct RosName {
  std::string robot;      ///< first word of the namespace, kLoneRobot without one
  std::string last_word;  ///< "scan"
};
/// "rt/robot1/laser/scan" -> {"robot1", "scan"}; nothing for services, actions and what is not ROS.
std::optional<RosName> parse_dds_topic(const std::string& dds_topic);

/// A server of NavigateToPose by the topic it reads goals from:
/// "rq/fox/navigate_to_pose/_action/send_goalRequest" -> {"fox", "fox/navigate_to_pose"}.
struct ActionName {
  std::string robot;
  std::string action;
};
std::optional<ActionName> parse_navigation_server(const std::string& dds_topic);

/// Does a name fit ROS's rules for one word of a namespace (letters, digits, underscores, not a digit first)?
bool is_robot_name(const std::string& name);

}  // namespace smokemap
