#include "robots/robot_intake.hpp"

#include <utility>

#include "maps/radar_image.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kMostWaiting = 32;

}  // namespace

RobotIntake::RobotIntake(std::string robot, const GatewayParams& params, const RobotGateway::Callbacks& callbacks,
                         Alarm alarm)
    : robot_(std::move(robot)), params_(params), callbacks_(callbacks), alarm_(std::move(alarm)) {
  link_.id = robot_;
}

void RobotIntake::scan(LaserScan scan, const std::string& frame, Stamp now) {
  link_.last_heard = now;
  scan.robot = robot_;
  if (const auto sound = check(scan); !sound) return drop(sound.error().message);
  place_or_wait({std::move(scan), frame, now});
}

void RobotIntake::sweep(RadarSweep sweep, const std::string& frame, Stamp now) {
  link_.last_heard = now;
  link_.has_radar = true;
  sweep.robot = robot_;
  if (const auto sound = check(sweep); !sound) return drop(sound.error().message);
  place_or_wait({std::move(sweep), frame, now});
}

void RobotIntake::odometry(Odometry odometry, const std::string& odom_frame, const std::string& base_frame, Stamp now) {
  link_.last_heard = now;
  odometry.robot = robot_;
  base_frame_ = base_frame;
  link_.odom_frame = odom_frame;
  link_.T_odom_robot = odometry.T_odom_robot;
  ++link_.odometry_readings;
  if (callbacks_.on_odometry) callbacks_.on_odometry(odometry);
}

std::optional<SensorMount> RobotIntake::mount(const std::string& frame) const {
  if (const auto by_hand = params_.mounts.find(robot_); by_hand != params_.mounts.end())
    return SensorMount{by_hand->second, false, 0};
  for (const std::string& base : {base_frame_, std::string("base_link"), std::string("base_footprint")}) {
    if (base.empty()) continue;
    if (const auto own = own_frames_.mount(base, frame)) return own;
    if (const auto shared = shared_frames_.mount(base, frame)) return shared;
  }
  return std::nullopt;
}

bool RobotIntake::deliver(Waiting& waiting) {
  const auto found = mount(waiting.frame);
  if (!found) return false;
  if (auto* scan = std::get_if<LaserScan>(&waiting.data)) {
    scan->T_robot_laser = found->T_robot_sensor;
    if (found->upside_down) scan->angle_min_rad *= -1, scan->angle_increment_rad *= -1;
    ++link_.scans;
    if (callbacks_.on_scan) callbacks_.on_scan(*scan);
  } else if (auto* sweep = std::get_if<RadarSweep>(&waiting.data)) {
    sweep->T_robot_radar = found->T_robot_sensor;
    if (found->upside_down) sweep->azimuth_min_rad *= -1, sweep->azimuth_increment_rad *= -1;
    ++link_.sweeps;
    if (callbacks_.on_sweep) callbacks_.on_sweep(*sweep);
  }
  return true;
}

void RobotIntake::place_or_wait(Waiting waiting) {
  if (waiting_.empty() && deliver(waiting)) return;
  if (waiting_.size() == kMostWaiting) {
    waiting_.pop_front();
    drop("place of the sensor unknown");
  }
  waiting_.push_back(std::move(waiting));
}

void RobotIntake::frames_changed(const FrameTree& shared, Stamp now) {
  shared_frames_ = shared;
  tick(now);
}

void RobotIntake::tick(Stamp now) {
  while (!waiting_.empty()) {
    Waiting& first = waiting_.front();
    if (!deliver(first)) {
      if (to_seconds(now - first.since) < params_.mount_wait_s) return;
      drop("place of the sensor unknown");
      alarm_("mount:" + first.frame, robot_ + " does not say where its sensor " + first.frame +
                                         " sits (no transform on tf_static): its data are left out");
    }
    waiting_.pop_front();
  }
}

}  // namespace smokemap
