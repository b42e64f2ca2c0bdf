#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

#include "geometry/pose2.hpp"

namespace smokemap {

/// The end of a wall (a door jamb) was seen: the corner lies there along the wall; across, the wall's faces speak.
///   u = (a - b) / |a - b| (out of the wall),  q = T_map_robot * end_robot
///   r = u . (a - q) / sigma,   a: the corner at the end, b: the wall's other corner
class WallEndCost {
 public:
  WallEndCost(const Point2& end_robot, double sigma_m) : end_(end_robot), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* pose, const T* a, const T* b, T* residual) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T dx = a[0] - b[0], dy = a[1] - b[1];
    const T inverse = 1.0 / sqrt(dx * dx + dy * dy + 1e-12);
    const T c = cos(pose[2]), s = sin(pose[2]);
    const T qx = pose[0] + c * end_.x() - s * end_.y(), qy = pose[1] + s * end_.x() + c * end_.y();
    residual[0] = (dx * (a[0] - qx) + dy * (a[1] - qy)) * inverse / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(const Point2& end_robot, double sigma_m) {
    return new ceres::AutoDiffCostFunction<WallEndCost, 1, 3, 2, 2>(new WallEndCost(end_robot, sigma_m));
  }

 private:
  Point2 end_;
  double sigma_m_;
};

}  // namespace smokemap
