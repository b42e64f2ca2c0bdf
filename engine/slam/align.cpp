#include "slam/align.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

/// Sums over the points at one pose.
struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double score = 0, squares = 0, weight = 0;
  int matched = 0;
};

NormalEquations linearize(const std::vector<SurfacePoint>& points, const SurfaceMap& map, const Pose2& T_map_robot,
                          double gate_m, double kernel_m, const AlignParams& params) {
  NormalEquations sum;
  const Eigen::Matrix2d R = T_map_robot.rotation();
  const double per_sigma = 1.0 / (params.sigma_point_m * params.sigma_point_m);
  SurfaceMap::Surface surface;
  for (const SurfacePoint& point : points) {
    sum.weight += point.weight;
    const Point2 arm = R * point.p;
    const Point2 p = arm + T_map_robot.translation();
    const Point2 n = point.oriented() ? Point2(R * point.normal) : Point2(Point2::Zero());
    if (!map.nearest(p, n, std::max(gate_m, params.reach_m), params.normals_within, surface)) continue;
    const double r = surface.normal.dot(p - surface.p);
    if (std::abs(r) > gate_m) continue;
    const Eigen::Vector3d J(surface.normal.x(), surface.normal.y(), surface.normal.dot(Point2(-arm.y(), arm.x())));
    const double falloff = kernel_m * kernel_m / (kernel_m * kernel_m + r * r);
    const double weight = point.weight * falloff * falloff * per_sigma;
    sum.H.noalias() += weight * J * J.transpose();
    sum.b.noalias() += weight * r * J;
    sum.score += point.weight * falloff * falloff;
    sum.squares += r * r;
    ++sum.matched;
  }
  return sum;
}

}  // namespace

PointToLine point_to_line(const Point2& p_robot, const Point2& q, const Point2& normal, const Pose2& T_map_robot) {
  const Point2 arm = T_map_robot.rotation() * p_robot;
  return {normal.dot(arm + T_map_robot.translation() - q),
          {normal.x(), normal.y(), normal.dot(Point2(-arm.y(), arm.x()))}};
}

ScanAlignment align(const std::vector<SurfacePoint>& points_robot, const SurfaceMap& map, const Pose2& T_map_robot,
                    const AlignParams& params, const std::optional<PosePrior>& prior) {
  ScanAlignment found;
  found.T_map_robot = T_map_robot;
  NormalEquations sum;
  double gate_m = params.gate_m;
  for (int i = 0; i < params.iterations; ++i) {
    const double kernel_m = std::max(0.5 * gate_m, params.last_gate_m * 0.5);
    sum = linearize(points_robot, map, found.T_map_robot, gate_m, kernel_m, params);
    Eigen::Matrix3d H = sum.H;
    Eigen::Vector3d b = sum.b;
    if (prior) {
      Eigen::Vector3d away = found.T_map_robot.vector() - prior->T_map_robot.vector();
      away.z() = wrap_angle(away.z());
      H += prior->information;
      b += prior->information * away;
    }
    H.diagonal().array() += 1e-3;
    const Eigen::Vector3d step = H.ldlt().solve(-b);
    if (!step.allFinite()) break;
    found.T_map_robot = {found.T_map_robot.translation() + step.head<2>(), found.T_map_robot.heading() + step.z()};
    const bool still = step.head<2>().norm() < params.stop_m && std::abs(step.z()) < params.stop_rad;
    if (still && gate_m <= params.last_gate_m) {
      found.converged = true;
      break;
    }
    gate_m = std::max(params.last_gate_m, still ? params.last_gate_m : 0.7 * gate_m);
  }
  sum = linearize(points_robot, map, found.T_map_robot, params.last_gate_m, 0.5 * params.last_gate_m, params);
  found.information = sum.H;
  found.score = sum.weight > 0 ? sum.score / sum.weight : 0;
  found.rms_m = sum.matched > 0 ? std::sqrt(sum.squares / sum.matched) : 0;
  found.matched = sum.matched;
  return found;
}

}  // namespace smokemap
