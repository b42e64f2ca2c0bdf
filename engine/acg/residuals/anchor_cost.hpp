#pragma once

#include <ceres/autodiff_cost_function.h>

#include <Eigen/Core>

#include "geometry/pose2.hpp"

namespace smokemap {

/// A person said: this place of the plan is here. The place is a fixed mixture of the three corners around it.
///   r = (share_0 a + share_1 b + share_2 c - p_map) / sigma,  shares sum to 1
class AnchorCost {
 public:
  AnchorCost(const Eigen::Vector3d& shares, const Point2& p_map, double sigma_m)
      : shares_(shares), p_map_(p_map), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    for (int k = 0; k < 2; ++k)
      residual[k] = (shares_[0] * a[k] + shares_[1] * b[k] + shares_[2] * c[k] - p_map_[k]) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(const Eigen::Vector3d& shares, const Point2& p_map, double sigma_m) {
    return new ceres::AutoDiffCostFunction<AnchorCost, 2, 2, 2, 2>(new AnchorCost(shares, p_map, sigma_m));
  }

 private:
  Eigen::Vector3d shares_;
  Point2 p_map_;
  double sigma_m_;
};

}  // namespace smokemap
