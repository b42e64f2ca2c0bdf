#pragma once

#include <ceres/autodiff_cost_function.h>

#include "geometry/segment2.hpp"

namespace smokemap {

/// A wall of the published graph: as a vector in map it is as drawn, up to stretch along and shift across.
///   d = (b - a) - z,  r = (u . d / sigma_along, n . d / sigma_across),  u = z / |z|, n its left normal
/// A turn of the whole plan costs: that is how it was published.
class DrawnVectorCost {
 public:
  DrawnVectorCost(const Point2& z, double sigma_along_m, double sigma_across_m)
      : z_(z), u_(z.normalized()), along_m_(sigma_along_m), across_m_(sigma_across_m) {}

  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const T dx = b[0] - a[0] - z_.x(), dy = b[1] - a[1] - z_.y();
    residual[0] = (u_.x() * dx + u_.y() * dy) / along_m_;
    residual[1] = (u_.x() * dy - u_.y() * dx) / across_m_;
    return true;
  }
  static ceres::CostFunction* Create(const Point2& z, double sigma_along_m, double sigma_across_m) {
    return new ceres::AutoDiffCostFunction<DrawnVectorCost, 2, 2, 2>(
        new DrawnVectorCost(z, sigma_along_m, sigma_across_m));
  }

 private:
  Point2 z_, u_;
  double along_m_, across_m_;
};

}  // namespace smokemap
