#include "maps/frame_tree.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

/// ROS 1 habits survive: "/laser" and "laser" are one frame.
std::string frame_name(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

}  // namespace

bool FrameTree::set(const std::string& parent, const std::string& child, const Eigen::Vector3d& translation,
                    const Eigen::Quaterniond& rotation) {
  const double norm = rotation.norm();
  if (!translation.allFinite() || !std::isfinite(norm) || std::abs(norm - 1) > 0.01) return false;
  if (frame_name(parent) == frame_name(child) || frame_name(child).empty() || frame_name(parent).empty()) return false;
  Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
  T_parent_child.linear() = rotation.normalized().toRotationMatrix();
  T_parent_child.translation() = translation;
  links_[frame_name(child)] = {frame_name(parent), T_parent_child};
  return true;
}

std::optional<Eigen::Isometry3d> FrameTree::lookup(const std::string& base, const std::string& sensor) const {
  // Every ancestor of the sensor with T_ancestor_sensor, then the first ancestor of the base among them.
  std::map<std::string, Eigen::Isometry3d> above_sensor;
  std::string frame = frame_name(sensor);
  Eigen::Isometry3d T_frame_sensor = Eigen::Isometry3d::Identity();
  while (above_sensor.emplace(frame, T_frame_sensor).second) {
    const auto link = links_.find(frame);
    if (link == links_.end()) break;
    T_frame_sensor = link->second.T_parent_child * T_frame_sensor;
    frame = link->second.parent;
  }
  frame = frame_name(base);
  Eigen::Isometry3d T_frame_base = Eigen::Isometry3d::Identity();
  for (std::size_t steps = 0; steps <= links_.size(); ++steps) {
    if (const auto meeting = above_sensor.find(frame); meeting != above_sensor.end())
      return T_frame_base.inverse() * meeting->second;
    const auto link = links_.find(frame);
    if (link == links_.end()) break;
    T_frame_base = link->second.T_parent_child * T_frame_base;
    frame = link->second.parent;
  }
  return std::nullopt;
}

std::optional<SensorMount> FrameTree::mount(const std::string& base, const std::string& sensor) const {
  const auto T_base_sensor = lookup(base, sensor);
  if (!T_base_sensor) return std::nullopt;
  const Eigen::Matrix3d R = T_base_sensor->linear();
  SensorMount mount;
  mount.upside_down = R(2, 2) < 0;
  mount.tilt_rad = std::acos(std::clamp(std::abs(R(2, 2)), 0.0, 1.0));
  mount.T_robot_sensor = Pose2(Point2(T_base_sensor->translation().head<2>()), std::atan2(R(1, 0), R(0, 0)));
  return mount;
}

bool FrameTree::knows(const std::string& frame) const {
  const std::string name = frame_name(frame);
  if (links_.contains(name)) return true;
  for (const auto& [child, link] : links_)
    if (link.parent == name) return true;
  return false;
}

std::optional<double> heading_of(const Eigen::Quaterniond& q) {
  const double norm = q.norm();
  if (!std::isfinite(norm) || norm < 1e-6) return std::nullopt;
  return std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), q.w() * q.w() + q.x() * q.x() - q.y() * q.y() - q.z() * q.z());
}

}  // namespace smokemap
