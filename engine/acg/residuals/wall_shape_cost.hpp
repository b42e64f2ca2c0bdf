#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace smokemap {

/// A drawn wall (or the gap of a door) may stretch, but hardly turns, against the turn and scale of the whole plan.
///   d = R(turn + heading)^T (b - a)
///   r = [ (d_x - e^log_scale * length) / sigma_along ;  d_y / sigma_across ]
/// a, b: corners in map (metres); heading, length: as drawn. Free of any common shift, turn and scale of the plan.
/// For small errors this is the log-length and the angle of the wall, without their poles for a wall of no length.
class WallShapeCost {
 public:
  WallShapeCost(double length_m, double heading_rad, double sigma_along_m, double sigma_across_m)
      : length_m_(length_m),
        heading_rad_(heading_rad),
        sigma_along_m_(sigma_along_m),
        sigma_across_m_(sigma_across_m) {}

  template <typename T>
  bool operator()(const T* a, const T* b, const T* turn, const T* log_scale, T* residual) const {
    using std::cos;
    using std::exp;
    using std::sin;
    const T c = cos(turn[0] + heading_rad_), s = sin(turn[0] + heading_rad_);
    const T dx = b[0] - a[0], dy = b[1] - a[1];
    residual[0] = (c * dx + s * dy - exp(log_scale[0]) * length_m_) / sigma_along_m_;
    residual[1] = (-s * dx + c * dy) / sigma_across_m_;
    return true;
  }
  static ceres::CostFunction* Create(double length_m, double heading_rad, double sigma_along_m, double sigma_across_m) {
    return new ceres::AutoDiffCostFunction<WallShapeCost, 2, 2, 2, 1, 1>(
        new WallShapeCost(length_m, heading_rad, sigma_along_m, sigma_across_m));
  }

 private:
  double length_m_, heading_rad_, sigma_along_m_, sigma_across_m_;
};

}  // namespace smokemap
