#include "recording/log_writer.hpp"

#include <algorithm>
#include <array>

#include "recording/ros_messages.hpp"

namespace smokemap {
namespace {

RosTransform planar_transform(Stamp stamp, const char* parent, const char* child, const Pose2& pose) {
  return {stamp,
          parent,
          child,
          {pose.x(), pose.y(), 0},
          Eigen::Quaterniond(Eigen::AngleAxisd(pose.heading(), Eigen::Vector3d::UnitZ()))};
}

}  // namespace

void LogWriter::add(const LogItem& item) {
  if (const auto* scan = std::get_if<LaserScan>(&item)) {
    write_mount(scan->robot, "laser", scan->stamp, scan->T_robot_laser);
    write(scan->robot, "scan", kLaserScanType, scan->stamp, encode_scan(*scan, "laser"));
  } else if (const auto* sweep = std::get_if<RadarSweep>(&item)) {
    write_mount(sweep->robot, "radar", sweep->stamp, sweep->T_robot_radar);
    write(sweep->robot, "radar", kImageType, sweep->stamp, encode_radar(*sweep, "radar"));
  } else if (const auto* odometry = std::get_if<Odometry>(&item)) {
    write_odometry(*odometry);
  }
}

void LogWriter::add(const LogItem& item, Stamp now) {
  heard_at_ = now;
  add(item);
  heard_at_.reset();
}

void LogWriter::add_goal(const std::string& robot, const Pose2& T_map_goal, Stamp now) {
  write(robot, "goal_pose", kPoseType, now, encode_pose(T_map_goal, "map", now));
}

void LogWriter::add_event(const std::string& text, Stamp now) {
  write("smokemap", "events", kStringType, now, encode_string(text));
}

void LogWriter::write_odometry(const Odometry& odometry) {
  const std::array transform{planar_transform(odometry.stamp, "odom", "base_link", odometry.T_odom_robot)};
  write(odometry.robot, "odom", kOdometryType, odometry.stamp, encode_odometry(odometry, "odom", "base_link"));
  write(odometry.robot, "tf", kTransformsType, odometry.stamp, encode_transforms(transform));
}

void LogWriter::write_mount(const std::string& robot, const char* frame, Stamp stamp, const Pose2& T_robot_sensor) {
  const auto [known, is_new] = mounts_.try_emplace(robot + "/" + frame, T_robot_sensor);
  if (!is_new && known->second.vector() == T_robot_sensor.vector()) return;
  known->second = T_robot_sensor;
  const std::array transform{planar_transform(stamp, "base_link", frame, T_robot_sensor)};
  write(robot, "tf_static", kTransformsType, stamp, encode_transforms(transform));
}

void LogWriter::write(const std::string& robot, const char* name, const char* type, Stamp stamp,
                      std::span<const std::uint8_t> cdr) {
  last_time_ = std::max(last_time_, heard_at_.value_or(stamp));
  const std::string topic = (robot == "robot" || robot.empty() ? "/" : "/" + robot + "/") + name;
  mcap_.write(mcap_.channel(topic, type), last_time_, cdr);
}

}  // namespace smokemap
