#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace smokemap {

/// What is drawn in line stays in line: a corner lies on the drawn line it belongs to.
///   r = (u(turn + axis) . corner - line) / sigma,  u = unit vector,  line = its coordinate along u in map (metres).
class DrawnLineCost {
 public:
  DrawnLineCost(double axis_rad, double sigma_m) : axis_rad_(axis_rad), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* corner, const T* turn, const T* line, T* residual) const {
    using std::cos;
    using std::sin;
    const T angle = turn[0] + axis_rad_;
    residual[0] = (cos(angle) * corner[0] + sin(angle) * corner[1] - line[0]) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(double axis_rad, double sigma_m) {
    return new ceres::AutoDiffCostFunction<DrawnLineCost, 1, 2, 1, 1>(new DrawnLineCost(axis_rad, sigma_m));
  }

 private:
  double axis_rad_, sigma_m_;
};

}  // namespace smokemap
