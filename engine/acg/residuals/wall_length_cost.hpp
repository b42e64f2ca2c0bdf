#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace smokemap {

/// A person measured this wall.
///   r = (|b - a| - length) / sigma,  a, b: its corners in map (metres)
class WallLengthCost {
 public:
  WallLengthCost(double length_m, double sigma_m) : length_m_(length_m), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    using std::sqrt;
    const T dx = b[0] - a[0], dy = b[1] - a[1];
    residual[0] = (sqrt(dx * dx + dy * dy + 1e-12) - length_m_) / sigma_m_;
    return true;
  }
  static ceres::CostFunction* Create(double length_m, double sigma_m) {
    return new ceres::AutoDiffCostFunction<WallLengthCost, 1, 2, 2>(new WallLengthCost(length_m, sigma_m));
  }

 private:
  double length_m_, sigma_m_;
};

}  // namespace smokemap
