#pragma once

#include <ceres/autodiff_cost_function.h>

#include "geometry/segment2.hpp"

namespace smokemap {

/// A person said: this corner of the plan is here.
///   r = (corner - p_map) / sigma
class PinCost {
 public:
  PinCost(const Point2& p_map, double sigma_m) : p_map_(p_map), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* corner, T* residual) const {
    for (int k = 0; k < 2; ++k) residual[k] = (corner[k] - p_map_[k]) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(const Point2& p_map, double sigma_m) {
    return new ceres::AutoDiffCostFunction<PinCost, 2, 2>(new PinCost(p_map, sigma_m));
  }

 private:
  Point2 p_map_;
  double sigma_m_;
};

}  // namespace smokemap
