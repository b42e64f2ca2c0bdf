#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"

namespace smokemap {

/// The ROS 2 messages of a log, decoded from CDR straight into our nouns. What the nouns have no word for (frames)
/// stays beside them. A decoder gives nothing when the bytes end early, a length lies, or a string is not terminated.

inline constexpr const char* kLaserScanType = "sensor_msgs/msg/LaserScan";
inline constexpr const char* kOdometryType = "nav_msgs/msg/Odometry";
inline constexpr const char* kTransformsType = "tf2_msgs/msg/TFMessage";
inline constexpr const char* kImageType = "sensor_msgs/msg/Image";
inline constexpr const char* kPoseType = "geometry_msgs/msg/PoseStamped";
inline constexpr const char* kStringType = "std_msgs/msg/String";

struct RosScan {
  std::string frame;
  LaserScan scan;  ///< robot and T_robot_laser not set
};
struct RosOdometry {
  std::string frame;
  std::string child_frame;
  Odometry odometry;  ///< robot not set
};
struct RosTransform {
  Stamp stamp = 0;
  std::string parent;
  std::string child;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
struct RosRadar {
  std::string frame;
  RadarSweep sweep;  ///< robot and T_robot_radar not set
};

std::optional<RosScan> decode_scan(std::span<const std::uint8_t> bytes);
std::optional<RosOdometry> decode_odometry(std::span<const std::uint8_t> bytes);
std::optional<std::vector<RosTransform>> decode_transforms(std::span<const std::uint8_t> bytes);
/// Nothing also for a picture that is no radar sweep (radar_image.hpp).
std::optional<RosRadar> decode_radar(std::span<const std::uint8_t> bytes);

std::vector<std::uint8_t> encode_scan(const LaserScan& scan, const std::string& frame);
std::vector<std::uint8_t> encode_odometry(const Odometry& odometry, const std::string& frame,
                                          const std::string& child_frame);
std::vector<std::uint8_t> encode_transforms(std::span<const RosTransform> transforms);
std::vector<std::uint8_t> encode_radar(const RadarSweep& sweep, const std::string& frame);
std::vector<std::uint8_t> encode_pose(const Pose2& pose, const std::string& frame, Stamp stamp);
std::vector<std::uint8_t> encode_string(const std::string& text);

}  // namespace smokemap
