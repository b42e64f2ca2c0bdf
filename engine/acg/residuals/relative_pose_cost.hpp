#pragma once

#include <ceres/autodiff_cost_function.h>

#include <Eigen/Core>

#include "geometry/pose2.hpp"

namespace smokemap {

/// Odometry, scan matches and loop closures, as SLAM measured them.
///   r = sqrt_info * [ R(h_from)^T (t_to - t_from) - z_t ;  wrap(h_to - h_from - z_h) ],  poses (x, y, heading) in map.
class RelativePoseCost {
 public:
  RelativePoseCost(const Pose2& z_from_to, const Eigen::Matrix3d& sqrt_info) : z_(z_from_to), sqrt_info_(sqrt_info) {}

  template <typename T>
  bool operator()(const T* from, const T* to, T* residual) const {
    using std::cos;
    using std::sin;
    const T c = cos(from[2]), s = sin(from[2]);
    const T dx = to[0] - from[0], dy = to[1] - from[1];
    const T turn = to[2] - from[2] - T(z_.heading());
    // The angle of (sin, cos) is its own wrap, smooth everywhere but at half a turn.
    const Eigen::Matrix<T, 3, 1> error(c * dx + s * dy - T(z_.x()), -s * dx + c * dy - T(z_.y()), atan2_of(turn));
    Eigen::Map<Eigen::Matrix<T, 3, 1>> r(residual);
    r = sqrt_info_.cast<T>() * error;
    return true;
  }
  static ceres::CostFunction* Create(const Pose2& z_from_to, const Eigen::Matrix3d& sqrt_info) {
    return new ceres::AutoDiffCostFunction<RelativePoseCost, 3, 3, 3>(new RelativePoseCost(z_from_to, sqrt_info));
  }

 private:
  template <typename T>
  static T atan2_of(const T& angle) {
    using std::atan2;
    using std::cos;
    using std::sin;
    return atan2(sin(angle), cos(angle));
  }
  Pose2 z_;
  Eigen::Matrix3d sqrt_info_;
};

}  // namespace smokemap
