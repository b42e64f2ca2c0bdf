#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"

namespace smokemap {

struct RosRobotParams {
  std::string robot = "robot";  ///< namespace of its topics; "robot" has none, as most single robots
  int domain = 0;
  bool stamped_velocity = false;  ///< takes TwistStamped, as Nav2 does since Kilted, instead of Twist
  bool with_radar = true;
  Result<Ok> validate() const;
};

/// The robot's side of the wire: publishes what a robot measures as a ROS 2 robot would (topics, types and QoS of
/// rplidar and turtlebot4 drivers) and takes commands. Knows nothing of where the data come from.
class RosRobotNode {
 public:
  /// Called from the node's own thread; must be quick and must not throw.
  struct Callbacks {
    std::function<void(double speed_mps, double turn_rate_radps)> on_velocity;
    std::function<void(const Pose2& T_frame_goal, const std::string& frame_id)> on_goal;
  };

  static Result<std::unique_ptr<RosRobotNode>> open(const RosRobotParams& params, Callbacks callbacks);
  ~RosRobotNode();
  RosRobotNode(const RosRobotNode&) = delete;
  RosRobotNode& operator=(const RosRobotNode&) = delete;

  /// Thread-safe. A full or absent network costs the message, never the caller. Where a sensor sits on the robot goes
  /// out on tf_static before its first message, and again when it changes.
  void publish(const LaserScan& scan);
  void publish(const Odometry& odometry);  ///< odom, and odom -> base_link on tf
  void publish(const RadarSweep& sweep);

  /// How many gateways listen to the scans: lets a start wait until somebody is there.
  int listeners() const;

 private:
  class Impl;
  explicit RosRobotNode(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokemap
