#pragma once

#include <ceres/autodiff_cost_function.h>

#include <cmath>

#include "geometry/segment2.hpp"

namespace smokemap {

/// A straight piece of a scan lies on one face of a wall.
///   n = left normal of (b - a) / |b - a|,  q_k = T_map_robot * piece_k,  k = 1, 2 (its ends)
///   r_k = (side * n . (q_k - a) - half_thickness) / sigma
/// side: +1 when the sensor stands left of a -> b, else -1. Moves the pose and both corners.
class PieceToWallCost {
 public:
  PieceToWallCost(const Segment2& piece_robot, double side, double half_thickness_m, double sigma_m)
      : piece_(piece_robot), side_(side), half_thickness_m_(half_thickness_m), sigma_m_(sigma_m) {}

  template <typename T>
  bool operator()(const T* pose, const T* a, const T* b, T* residual) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T dx = b[0] - a[0], dy = b[1] - a[1];
    const T inverse = 1.0 / sqrt(dx * dx + dy * dy + 1e-12);
    const T c = cos(pose[2]), s = sin(pose[2]);
    const Point2 ends[2] = {piece_.a, piece_.b};
    for (int k = 0; k < 2; ++k) {
      const T qx = pose[0] + c * ends[k].x() - s * ends[k].y() - a[0];
      const T qy = pose[1] + s * ends[k].x() + c * ends[k].y() - a[1];
      residual[k] = (side_ * (dx * qy - dy * qx) * inverse - half_thickness_m_) / sigma_m_;
    }
    return true;
  }
  static ceres::CostFunction* Create(const Segment2& piece_robot, double side, double half_thickness_m,
                                     double sigma_m) {
    return new ceres::AutoDiffCostFunction<PieceToWallCost, 2, 3, 2, 2>(
        new PieceToWallCost(piece_robot, side, half_thickness_m, sigma_m));
  }

 private:
  Segment2 piece_;
  double side_, half_thickness_m_, sigma_m_;
};

}  // namespace smokemap
