#pragma once

#include <ceres/autodiff_cost_function.h>

namespace smokemap {

/// A single number is about known.   r = (value - expected) / sigma
class PriorValueCost {
 public:
  PriorValueCost(double expected, double sigma) : expected_(expected), sigma_(sigma) {}

  template <typename T>
  bool operator()(const T* value, T* residual) const {
    residual[0] = (value[0] - expected_) / sigma_;
    return true;
  }
  static ceres::CostFunction* Create(double expected, double sigma) {
    return new ceres::AutoDiffCostFunction<PriorValueCost, 1, 1>(new PriorValueCost(expected, sigma));
  }

 private:
  double expected_, sigma_;
};

}  // namespace smokemap
