#include "robots/ros_robot.hpp"

#include <cmath>
#include <map>
#include <mutex>
#include <vector>

#include "core/check.hpp"
#include "robots/dds_domain.hpp"
#include "robots/ros_convert.hpp"
#include "robots/ros_names.hpp"
#include "robots/ros_qos.hpp"
#include "robots/wait_thread.hpp"

namespace smokemap {
namespace {

constexpr const char* kOdomFrame = "odom";
constexpr const char* kBaseFrame = "base_link";
constexpr const char* kLaserFrame = "laser";
constexpr const char* kRadarFrame = "radar";
constexpr double kNodeTickSeconds = 1.0;

}  // namespace

Result<Ok> RosRobotParams::validate() const {
  return ParamCheck("RosRobotParams")
      .require("robot", is_robot_name(robot), "is no ROS name: letters, digits and underscores, not a digit first")
      .in_range("domain", domain, 0, 230)
      .result();
}

class RosRobotNode::Impl {
 public:
  Impl(RosRobotParams params, Callbacks callbacks, std::shared_ptr<DdsDomain> domain, DdsEntity participant)
      : params_(std::move(params)),
        callbacks_(std::move(callbacks)),
        domain_(std::move(domain)),
        participant_(std::move(participant)),
        thread_(participant_.get(), kNodeTickSeconds, [] {}) {
    offer(scan_, "scan", &sensor_msgs_msg_dds__LaserScan__desc, sensor_qos());
    offer(odometry_, "odom", &nav_msgs_msg_dds__Odometry__desc, state_qos(10));
    offer(moving_, "tf", &tf2_msgs_msg_dds__TFMessage__desc, state_qos(100));
    offer(fixed_, "tf_static", &tf2_msgs_msg_dds__TFMessage__desc, latched_qos(1));
    if (params_.with_radar) offer(radar_, "radar", &sensor_msgs_msg_dds__Image__desc, state_qos(2));
    if (params_.stamped_velocity)
      take<RosTwistStampedMsg>(velocity_, "cmd_vel", &geometry_msgs_msg_dds__TwistStamped__desc,
                               [this](const auto& m) { on_velocity(m.linear.x, m.angular.z); });
    else
      take<RosTwistMsg>(velocity_, "cmd_vel", &geometry_msgs_msg_dds__Twist__desc,
                        [this](const auto& m) { on_velocity(m.linear.x, m.angular.z); });
    take<RosPoseMsg>(goal_, "goal_pose", &geometry_msgs_msg_dds__PoseStamped__desc, [this](const RosPoseMsg& m) {
      if (const auto goal = to_pose(m); goal && callbacks_.on_goal)
        callbacks_.on_goal(*goal, text_of(m.header.frame_id));
    });
    thread_.start();
  }
  ~Impl() { thread_.stop(); }

  /// kIo if any of the topics could not be opened.
  Result<Ok> opened() const {
    for (const Topic* topic : {&scan_, &odometry_, &moving_, &fixed_, &velocity_, &goal_})
      if (!topic->endpoint)
        return fail(Errc::kIo, "a topic of " + params_.robot + " does not open: " + topic->endpoint.why());
    return Ok{};
  }

  void publish(const LaserScan& scan) {
    tell_mount(kLaserFrame, scan.stamp, scan.T_robot_laser);
    (void)write_scan(scan_.endpoint.get(), scan, kLaserFrame);
  }

  void publish(const Odometry& odometry) {
    (void)write_odometry(odometry_.endpoint.get(), odometry, kOdomFrame, kBaseFrame);
    (void)write_transforms(moving_.endpoint.get(), {{odometry.stamp, kOdomFrame, kBaseFrame, odometry.T_odom_robot}});
  }

  void publish(const RadarSweep& sweep) {
    if (!radar_.endpoint) return;
    tell_mount(kRadarFrame, sweep.stamp, sweep.T_robot_radar);
    (void)write_sweep(radar_.endpoint.get(), sweep, kRadarFrame);
  }

  int listeners() const {
    dds_publication_matched_status_t status{};
    (void)dds_get_publication_matched_status(scan_.endpoint.get(), &status);
    return static_cast<int>(status.current_count);
  }

 private:
  struct Topic {
    DdsEntity topic;
    DdsEntity endpoint;
  };

  void open_topic(Topic& topic, const char* name, const dds_topic_descriptor_t* type) {
    topic.topic =
        DdsEntity(dds_create_topic(participant_.get(), type, dds_topic(params_.robot, name).c_str(), nullptr, nullptr));
  }

  void offer(Topic& topic, const char* name, const dds_topic_descriptor_t* type, DdsQos qos) {
    open_topic(topic, name, type);
    topic.endpoint = DdsEntity(dds_create_writer(participant_.get(), topic.topic.get(), qos.get(), nullptr));
  }

  template <typename Message, typename Use>
  void take(Topic& topic, const char* name, const dds_topic_descriptor_t* type, Use use) {
    open_topic(topic, name, type);
    topic.endpoint = DdsEntity(dds_create_reader(participant_.get(), topic.topic.get(), state_qos(10).get(), nullptr));
    thread_.on_data(topic.endpoint.get(), [reader = topic.endpoint.get(), use] {
      take_all<Message>(reader, [&](const Message& message, const dds_sample_info_t&) { use(message); });
    });
  }

  /// One message holds all mounts: who comes late gets the last message only.
  void tell_mount(const char* frame, Stamp stamp, const Pose2& T_robot_sensor) {
    const std::lock_guard lock(mounts_mutex_);
    const auto known = mounts_.find(frame);
    if (known != mounts_.end() && known->second.T_parent_child.vector() == T_robot_sensor.vector()) return;
    mounts_[frame] = {stamp, kBaseFrame, frame, T_robot_sensor};
    std::vector<NamedTransform> all;
    for (const auto& [name, mount] : mounts_) all.push_back(mount);
    (void)write_transforms(fixed_.endpoint.get(), all);
  }

  void on_velocity(double speed_mps, double turn_rate_radps) {
    if (!std::isfinite(speed_mps) || !std::isfinite(turn_rate_radps))
      speed_mps = turn_rate_radps = 0;  // better to stand
    if (callbacks_.on_velocity) callbacks_.on_velocity(speed_mps, turn_rate_radps);
  }

  const RosRobotParams params_;
  const Callbacks callbacks_;
  const std::shared_ptr<DdsDomain> domain_;
  const DdsEntity participant_;
  Topic scan_, odometry_, moving_, fixed_, radar_, velocity_, goal_;
  std::mutex mounts_mutex_;
  std::map<std::string, NamedTransform> mounts_;  ///< by frame, as last told
  WaitThread thread_;
};

Result<std::unique_ptr<RosRobotNode>> RosRobotNode::open(const RosRobotParams& params, Callbacks callbacks) {
  if (auto sound = params.validate(); !sound) return sound.error();
  auto domain = DdsDomain::open(params.domain);
  if (!domain) return domain.error();
  auto participant = (*domain)->participant();
  if (!participant) return participant.error();
  auto impl = std::make_unique<Impl>(params, std::move(callbacks), std::move(*domain), std::move(*participant));
  if (auto opened = impl->opened(); !opened) return opened.error();
  return std::unique_ptr<RosRobotNode>(new RosRobotNode(std::move(impl)));
}

RosRobotNode::RosRobotNode(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RosRobotNode::~RosRobotNode() = default;
void RosRobotNode::publish(const LaserScan& scan) { impl_->publish(scan); }
void RosRobotNode::publish(const Odometry& odometry) { impl_->publish(odometry); }
void RosRobotNode::publish(const RadarSweep& sweep) { impl_->publish(sweep); }
int RosRobotNode::listeners() const { return impl_->listeners(); }

}  // namespace smokemap
