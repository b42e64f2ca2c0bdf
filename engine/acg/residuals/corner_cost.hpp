#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

#include "geometry/pose2.hpp"

namespace smokemap {

/// Two faces that meet were seen to meet here: the plan's corner lies behind their crossing.
///   r = (T_map_robot * seen_robot + offset_map - corner) / sigma
/// offset_map: from where the faces cross to where the walls' centre lines cross, as the walls lie when linked.
class CornerCost {
 public:
  CornerCost(const Point2& seen_robot, const Point2& offset_map, double sigma_m)
      : seen_(seen_robot), offset_(offset_map), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* pose, const T* corner, T* residual) const {
    using std::cos;
    using std::sin;
    const T c = cos(pose[2]), s = sin(pose[2]);
    residual[0] = (pose[0] + c * seen_.x() - s * seen_.y() + offset_.x() - corner[0]) / sigma_m_;
    residual[1] = (pose[1] + s * seen_.x() + c * seen_.y() + offset_.y() - corner[1]) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(const Point2& seen_robot, const Point2& offset_map, double sigma_m) {
    return new ceres::AutoDiffCostFunction<CornerCost, 2, 3, 2>(new CornerCost(seen_robot, offset_map, sigma_m));
  }

 private:
  Point2 seen_, offset_;
  double sigma_m_;
};

}  // namespace smokemap
