#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace smokemap {

/// Neighbouring strips of the sheet are stretched alike (a first-order Gauss-Markov process along the axis).
///   e_1 = (middle - line) / (e^log_scale * width_1) - 1,  e_2 = (next - middle) / (e^log_scale * width_2) - 1
///   r = (e_2 - correlation * e_1) / sigma,  sigma = stretch sigma * sqrt(1 - correlation^2)
class NeighbourStretchCost {
 public:
  NeighbourStretchCost(double width_1_m, double width_2_m, double correlation, double sigma)
      : width_1_m_(width_1_m), width_2_m_(width_2_m), correlation_(correlation), sigma_(sigma) {}

  template <typename T>
  bool operator()(const T* line, const T* middle, const T* next, const T* log_scale, T* residual) const {
    using std::exp;
    const T scale = exp(log_scale[0]);
    const T e_1 = (middle[0] - line[0]) / (scale * width_1_m_) - 1.0;
    const T e_2 = (next[0] - middle[0]) / (scale * width_2_m_) - 1.0;
    residual[0] = (e_2 - correlation_ * e_1) / sigma_;
    return true;
  }
  static ceres::CostFunction* Create(double width_1_m, double width_2_m, double correlation, double sigma) {
    return new ceres::AutoDiffCostFunction<NeighbourStretchCost, 1, 1, 1, 1, 1>(
        new NeighbourStretchCost(width_1_m, width_2_m, correlation, sigma));
  }

 private:
  double width_1_m_, width_2_m_, correlation_, sigma_;
};

}  // namespace smokemap
