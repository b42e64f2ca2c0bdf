#pragma once

#include <dds/dds.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "maps/frame_tree.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"
#include "ros2.h"

namespace smokemap {

/// Between the C structs that Cyclone decodes and our nouns. Names of the generated C types, shortened.
using RosTimeMsg = builtin_interfaces_msg_dds__Time_;
using RosHeaderMsg = std_msgs_msg_dds__Header_;
using RosScanMsg = sensor_msgs_msg_dds__LaserScan_;
using RosImageMsg = sensor_msgs_msg_dds__Image_;
using RosOdometryMsg = nav_msgs_msg_dds__Odometry_;
using RosTransformsMsg = tf2_msgs_msg_dds__TFMessage_;
using RosTransformMsg = geometry_msgs_msg_dds__TransformStamped_;
using RosPoseMsg = geometry_msgs_msg_dds__PoseStamped_;
using RosTwistMsg = geometry_msgs_msg_dds__Twist_;
using RosTwistStampedMsg = geometry_msgs_msg_dds__TwistStamped_;

Stamp to_stamp(const RosTimeMsg& time);
RosTimeMsg to_ros_time(Stamp stamp);
std::string text_of(const char* text);  ///< "" for null

/// Robot and mount are left to the caller.
LaserScan to_scan(const RosScanMsg& message);
/// kCorrupt for poses that are not finite or quaternions without a heading.
Result<Odometry> to_odometry(const RosOdometryMsg& message);
Result<RadarSweep> to_sweep(const RosImageMsg& message);
Result<Pose2> to_pose(const RosPoseMsg& message);
/// Adds every sound transform; returns how many were not.
int add_transforms(const RosTransformsMsg& message, FrameTree& tree);
/// A moving transform as odometry.
Result<Odometry> to_odometry(const RosTransformMsg& message);

/// The message borrows `frame`, which must outlive it.
RosPoseMsg ros_pose(const Pose2& T_frame_goal, const std::string& frame, Stamp stamp);

/// Writes one message. What the C struct points at lives in C++ values for the time of the call only.
bool write_scan(dds_entity_t writer, const LaserScan& scan, const std::string& frame);
bool write_odometry(dds_entity_t writer, const Odometry& odometry, const std::string& frame,
                    const std::string& child_frame);
bool write_sweep(dds_entity_t writer, const RadarSweep& sweep, const std::string& frame);
bool write_goal(dds_entity_t writer, const Pose2& T_frame_goal, const std::string& frame, Stamp stamp);
bool write_twist(dds_entity_t writer, double speed_mps, double turn_rate_radps);
bool write_twist_stamped(dds_entity_t writer, double speed_mps, double turn_rate_radps, Stamp stamp);

struct NamedTransform {
  Stamp stamp = 0;
  std::string parent, child;
  Pose2 T_parent_child;
};
bool write_transforms(dds_entity_t writer, const std::vector<NamedTransform>& transforms);

}  // namespace smokemap
