#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace smokemap {

/// What is drawn in line stays in line: a corner lies on the drawn line it belongs to, or as far off as expected.
///   r = (u(turn + axis) . corner - line - e^log_scale * offset) / sigma
/// u = unit vector, line = its coordinate along u in map (metres), offset = of the corner from it in the drawing.
class DrawnLineCost {
 public:
  DrawnLineCost(double axis_rad, double offset_m, double sigma_m)
      : axis_rad_(axis_rad), offset_m_(offset_m), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* corner, const T* turn, const T* line, const T* log_scale, T* residual) const {
    using std::cos;
    using std::exp;
    using std::sin;
    const T angle = turn[0] + axis_rad_;
    const T expected = line[0] + exp(log_scale[0]) * offset_m_;
    residual[0] = (cos(angle) * corner[0] + sin(angle) * corner[1] - expected) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(double axis_rad, double offset_m, double sigma_m) {
    return new ceres::AutoDiffCostFunction<DrawnLineCost, 1, 2, 1, 1, 1>(
        new DrawnLineCost(axis_rad, offset_m, sigma_m));
  }

 private:
  double axis_rad_, offset_m_, sigma_m_;
};

}  // namespace smokemap
