#include "slam/graph_edge_cost.hpp"

#include <cmath>

namespace smokemap {

bool GraphEdgeCost::Evaluate(double const* const* poses, double* residuals, double** jacobians) const {
  const Eigen::Map<const Eigen::Vector3d> i(poses[0]), j(poses[1]);
  const double c = std::cos(i.z()), s = std::sin(i.z());
  const Eigen::Vector2d d = j.head<2>() - i.head<2>();
  const Eigen::Vector2d seen(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
  const Eigen::Vector3d error(seen.x() - z_.x(), seen.y() - z_.y(), wrap_angle(j.z() - i.z() - z_.heading()));
  Eigen::Map<Eigen::Vector3d> out(residuals);
  out = sqrt_info_ * error;
  if (!jacobians) return true;
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::Matrix3d by_j;
  by_j << c, s, 0, -s, c, 0, 0, 0, 1;
  if (jacobians[0]) {
    Eigen::Matrix3d by_i = -by_j;
    by_i(0, 2) = seen.y();
    by_i(1, 2) = -seen.x();
    Eigen::Map<RowMajor> out_i(jacobians[0]);
    out_i = sqrt_info_ * by_i;
  }
  if (jacobians[1]) {
    Eigen::Map<RowMajor> out_j(jacobians[1]);
    out_j = sqrt_info_ * by_j;
  }
  return true;
}

}  // namespace smokemap
