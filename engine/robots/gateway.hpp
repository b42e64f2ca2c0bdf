#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"
#include "robots/link.hpp"
#include "robots/navigation_report.hpp"

namespace smokemap {

/// How services look on the wire: as the vendor of the robot's DDS has it (ros_service.hpp), or as somebody says.
enum class ServiceFormat { kByVendor, kHeaded, kBare };

struct GatewayParams {
  int domain = 0;  ///< ROS_DOMAIN_ID, 0..230
  LinkParams link;
  double mount_wait_s = 0.5;            ///< scans wait this long for the transform of their sensor
  std::map<std::string, Pose2> mounts;  ///< T_robot_laser by robot, where a robot does not publish it
  ServiceFormat services = ServiceFormat::kByVendor;
  Result<Ok> validate() const;
};

/// Something people should know about a robot's connection.
struct GatewayAlarm {
  std::string robot;
  std::string id;    ///< stable: the same trouble has the same id
  std::string text;  ///< one line, for people
};

struct RobotLink {
  std::string id;  ///< the namespace of its topics; "robot" where there is none
  LinkFreshness link = LinkFreshness::kLost;
  Stamp last_heard = 0;  ///< our clock
  bool has_radar = false;
  bool takes_velocity = false;  ///< somebody subscribes its cmd_vel
  bool takes_goals = false;     ///< it offers NavigateToPose, or somebody subscribes its goal_pose
  bool navigates = false;       ///< it offers NavigateToPose: goals are followed to their end and can be called off
  std::string odom_frame;       ///< of its odometry; empty before it said anything
  Pose2 T_odom_robot;           ///< the latest
  std::size_t scans = 0, sweeps = 0, odometry_readings = 0;
  std::map<std::string, std::size_t> dropped;  ///< reason -> count
};

struct SentGoal {
  std::uint64_t number = 0;  ///< for telling reports apart
  bool followed = false;     ///< reports will come; false: it went to goal_pose, which says nothing back
};

/// Finds robots on a ROS 2 network by their topics, listens to them and drives them. Plain DDS: no ROS is needed here,
/// and no Smokemap there.
///
/// A robot is any namespace that publishes a sensor_msgs/LaserScan. Read: its laser scan, odometry, radar
/// (radar_image.hpp, docs/robots.md), tf and tf_static (its own and the shared ones). Written: cmd_vel (Twist or
/// TwistStamped, whichever its subscriber takes) and goals: by the action NavigateToPose where the robot offers it,
/// else to goal_pose; all only once somebody is there to take them. Messages that are not what they should be are
/// dropped and counted by reason; nothing a robot sends can stop the gateway.
class RobotGateway {
 public:
  /// Called from the gateway's own thread, one at a time; must be quick and must not throw. All are optional.
  struct Callbacks {
    std::function<void(const LaserScan&)> on_scan;  ///< checked; T_robot_laser set
    std::function<void(const Odometry&)> on_odometry;
    std::function<void(const RadarSweep&)> on_sweep;
    std::function<void(const GatewayAlarm&)> on_alarm;                ///< once for each new trouble
    std::function<void(const NavigationReport&)> on_navigation = {};  ///< each step of a goal
  };

  /// kIo when DDS cannot start: no free participant index, no such interface.
  /// Without CYCLONEDDS_URI in the environment it binds to loopback only (see dds_domain.hpp).
  static Result<std::unique_ptr<RobotGateway>> open(const GatewayParams& params, Callbacks callbacks,
                                                    std::shared_ptr<const Clock> clock);
  ~RobotGateway();
  RobotGateway(const RobotGateway&) = delete;
  RobotGateway& operator=(const RobotGateway&) = delete;

  /// Every robot that was ever heard, in order of id. Thread-safe, like the rest.
  std::vector<RobotLink> robots() const;
  /// Troubles that last: QoS that does not fit, two sources on one topic, sensors without a known place.
  std::vector<GatewayAlarm> alarms() const;

  /// kNotFound while nobody takes that robot's velocities / goals; kInvalidArgument for what is not finite.
  /// The robot's own watchdog must stop it when nothing comes for 0.5 s: call at 10 Hz or more, with zeros at the end.
  Result<Ok> drive(const std::string& robot, double speed_mps, double turn_rate_radps);
  /// Pose in the robot's frame `frame_id`. A robot that navigates gives up an earlier goal for it.
  Result<SentGoal> send_goal(const std::string& robot, const Pose2& T_frame_goal, const std::string& frame_id = "map");
  /// A place as seen from where the robot is now. Sent in the frame of its odometry, which every navigator can
  /// transform and which does not jump when a map is corrected. kNotFound before it published odometry.
  Result<SentGoal> send_goal_ahead(const std::string& robot, const Pose2& T_robot_goal);
  /// Emergency: zero velocity, and every goal of its navigator is called off, whoever sent it. kNotFound when there is
  /// neither to speak to.
  Result<Ok> stop(const std::string& robot);

 private:
  class Impl;
  explicit RobotGateway(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokemap
