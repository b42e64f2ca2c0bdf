#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

#include "geometry/pose2.hpp"

namespace smokemap {

/// Where the robot began, as a person pointed it out: between two drawn lines, as far from each as it is drawn.
///   r = ((1 - share) line + share next - u(turn + axis) . p_map) / sigma
/// u = unit vector, p_map = the robot's first place, share = 0 on the one line, 1 on the other, outside of both
/// allowed.
class StartCost {
 public:
  StartCost(double axis_rad, double share, const Point2& p_map, double sigma_m)
      : axis_rad_(axis_rad), share_(share), p_map_(p_map), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* turn, const T* line, const T* next, T* residual) const {
    using std::cos;
    using std::sin;
    const T angle = turn[0] + axis_rad_, place = (1 - share_) * line[0] + share_ * next[0];
    residual[0] = (place - cos(angle) * p_map_.x() - sin(angle) * p_map_.y()) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(double axis_rad, double share, const Point2& p_map, double sigma_m) {
    return new ceres::AutoDiffCostFunction<StartCost, 1, 1, 1, 1>(new StartCost(axis_rad, share, p_map, sigma_m));
  }

 private:
  double axis_rad_, share_;
  Point2 p_map_;
  double sigma_m_;
};

}  // namespace smokemap
