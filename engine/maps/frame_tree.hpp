#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>

#include "geometry/pose2.hpp"

namespace smokemap {

/// How a planar sensor sits on its robot. A sensor hung upside down turns the other way round: its angles change sign.
struct SensorMount {
  Pose2 T_robot_sensor;
  bool upside_down = false;
  double tilt_rad = 0;  ///< between the sensor's plane and the floor: above a few degrees a planar scan is not planar
};

/// The fixed transforms of a robot as ROS publishes them on tf_static: each frame has one parent.
class FrameTree {
 public:
  /// Adds or replaces the pose of `child` in `parent`. Ignored (false) unless finite with a unit-length rotation
  /// (within 1 %), and for frames without a name or that are their own parent.
  bool set(const std::string& parent, const std::string& child, const Eigen::Vector3d& translation,
           const Eigen::Quaterniond& rotation);

  /// T_base_sensor over the common ancestor; nothing where the two are not connected (or in a loop).
  std::optional<Eigen::Isometry3d> lookup(const std::string& base, const std::string& sensor) const;

  /// The same, laid onto the floor.
  std::optional<SensorMount> mount(const std::string& base, const std::string& sensor) const;

  bool knows(const std::string& frame) const;
  bool empty() const { return links_.empty(); }

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;
  };
  std::map<std::string, Link> links_;  ///< by child
};

/// Heading of a rotation about z, as REP 103 has it. Zero-length or non-finite quaternions give nothing.
std::optional<double> heading_of(const Eigen::Quaterniond& q);

}  // namespace smokemap
