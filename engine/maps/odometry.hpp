#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// Where the robot thinks it is by its wheels: smooth, drifts.
struct Odometry {
  Stamp stamp = 0;
  std::string robot;
  Pose2 T_odom_robot;
  double speed_mps = 0;
  double turn_rate_radps = 0;
};

/// A pose at a time with what is known about its error.
struct StampedPose {
  Stamp stamp = 0;
  Pose2 T_map_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, heading; zero = not known
};

using Trajectory = std::vector<StampedPose>;

}  // namespace smokemap
