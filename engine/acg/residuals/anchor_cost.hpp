#pragma once

#include <ceres/autodiff_cost_function.h>

#include <Eigen/Core>

#include "geometry/pose2.hpp"

namespace smokemap {

/// A person said: this place of the plan is here, give or take a finger's breadth. The place is a fixed mixture of the
/// three corners around it. Within reach of the finger sensors decide and the person only leans; beyond it the person
/// wins.
///   e = share_0 a + share_1 b + share_2 c - p_map,  shares sum to 1
///   r = (e_x / sigma, e_y / sigma, max(0, |e| - reach) / sigma_beyond)
class AnchorCost {
 public:
  struct Finger {
    double sigma_m = 0.05;  ///< how hard it leans
    double reach_m = 0.05;
    double sigma_beyond_m = 0.001;
  };
  AnchorCost(const Eigen::Vector3d& shares, const Point2& p_map, const Finger& finger)
      : shares_(shares), p_map_(p_map), finger_(finger) {}

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    using std::sqrt;
    T e[2];
    for (int k = 0; k < 2; ++k) {
      e[k] = shares_[0] * a[k] + shares_[1] * b[k] + shares_[2] * c[k] - p_map_[k];
      residual[k] = e[k] / finger_.sigma_m;
    }
    const T beyond = sqrt(e[0] * e[0] + e[1] * e[1] + 1e-12) - finger_.reach_m;
    residual[2] = beyond > T(0) ? T(beyond / finger_.sigma_beyond_m) : T(0);
    return true;
  }
  static ceres::CostFunction* Create(const Eigen::Vector3d& shares, const Point2& p_map, const Finger& finger) {
    return new ceres::AutoDiffCostFunction<AnchorCost, 3, 2, 2, 2>(new AnchorCost(shares, p_map, finger));
  }

 private:
  Eigen::Vector3d shares_;
  Point2 p_map_;
  Finger finger_;
};

}  // namespace smokemap
