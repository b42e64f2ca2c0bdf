#pragma once

#include <optional>
#include <vector>

#include "slam/surface_map.hpp"

namespace smokemap {

/// What is believed before looking at the scan.
struct PosePrior {
  Pose2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of x, y (map frame) and heading
};

struct ScanAlignment {
  Pose2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the points alone: x, y (map frame), heading
  double score = 0;  ///< share of the points that lie on a surface of the map, weighted 0 .. 1 by their distance
  double rms_m = 0;  ///< of points on surfaces
  int matched = 0;   ///< points with a surface within the last gate
  bool converged = false;
};

/// Moves the points onto the map: Gauss-Newton on robust point-to-line distances, surfaces looked up again in every
/// iteration, within a gate that closes. r_i = n_i . (R p_i + t - q_i), Geman-McClure kernel.
/// Never fails: no surface found gives a score of 0.
ScanAlignment align(const std::vector<SurfacePoint>& points_robot, const SurfaceMap& map, const Pose2& T_map_robot,
                    const AlignParams& params, const std::optional<PosePrior>& prior = {});

/// One row of the problem, for the solver and for the test of its derivative.
struct PointToLine {
  double residual_m;
  Eigen::Vector3d jacobian;  ///< by x, y, heading
};
PointToLine point_to_line(const Point2& p_robot, const Point2& q, const Point2& normal, const Pose2& T_map_robot);

}  // namespace smokemap
