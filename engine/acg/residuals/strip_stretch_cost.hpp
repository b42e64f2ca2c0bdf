#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace smokemap {

/// The strip between two neighbouring drawn lines is stretched by about the plan's scale.
///   r = ((next - line) / (e^log_scale * width) - 1) / sigma
class StripStretchCost {
 public:
  StripStretchCost(double width_m, double sigma) : width_m_(width_m), sigma_(sigma) {}

  template <typename T>
  bool operator()(const T* line, const T* next, const T* log_scale, T* residual) const {
    using std::exp;
    residual[0] = ((next[0] - line[0]) / (exp(log_scale[0]) * width_m_) - 1.0) / sigma_;
    return true;
  }
  static ceres::CostFunction* Create(double width_m, double sigma) {
    return new ceres::AutoDiffCostFunction<StripStretchCost, 1, 1, 1, 1>(new StripStretchCost(width_m, sigma));
  }

 private:
  double width_m_, sigma_;
};

}  // namespace smokemap
