#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "geometry/pose2.hpp"

namespace smokemap {

/// r = sqrt_info * [ R(h_i)^T (t_j - t_i) - z.t ; wrap(h_j - h_i - z.h) ],   poses as (x, y, heading), map frame.
/// In standard deviations. Analytic derivatives.
class GraphEdgeCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  GraphEdgeCost(const Pose2& z_i_j, const Eigen::Matrix3d& sqrt_info) : z_(z_i_j), sqrt_info_(sqrt_info) {}
  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  Pose2 z_;
  Eigen::Matrix3d sqrt_info_;
};

}  // namespace smokemap
