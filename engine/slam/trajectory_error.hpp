#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "maps/odometry.hpp"

namespace smokemap {

/// A relative pose that people verified: the later pose seen from the earlier one.
struct PoseRelation {
  Stamp from = 0;
  Stamp to = 0;
  Pose2 T_from_to;
};

struct ErrorSpread {
  double mean = 0, stddev = 0, median = 0, most = 0;
};

struct RelationError {
  ErrorSpread translation_m, rotation_rad;
  std::size_t relations = 0;
  std::size_t missing = 0;  ///< no pose near one of the stamps; not in the means
  /// The same over relations both of whose stamps mean one place only. Logs stamped in coarse steps, or in bursts after
  /// a pause, hold several readings at nearly one stamp that lie up to half a metre apart: which of them a relation
  /// means cannot be told, and even the true trajectory is then judged wrong. Without odometry nobody knows: 0 of them.
  ErrorSpread clear_translation_m, clear_rotation_rad;
  std::size_t clear = 0;
};

/// Errors of an estimated trajectory, order by order of stamps.
///
/// Relation error: e = T_from_to^-1 * estimate, mean over all relations alike.
/// Source: Kuemmerle et al., Autonomous Robots 27 (2009).
/// @param odometry  readings in the order of the log; fill stamps between estimates: the poses before and after, moved
///                  along and blended. Readings that share a stamp but not a place do not tell where an estimate
///                  belongs. May be empty.
/// @param longest_gap_s  a stamp farther than this from every estimate (and reading) is missing
/// kDegenerate when no relation could be judged.
Result<RelationError> relation_error(const Trajectory& estimate, const std::vector<PoseRelation>& relations,
                                     const std::vector<Odometry>& odometry = {}, double longest_gap_s = 0.25);

struct AbsoluteError {
  double rmse_m = 0, mean_m = 0, most_m = 0, rotation_rmse_rad = 0, path_m = 0;
  std::size_t poses = 0;
};

/// Distance from the truth after the best rigid alignment. `p_robot_lever`: the truth is the pose of this point of the
/// robot. kDegenerate with fewer than two poses at stamps of the truth.
Result<AbsoluteError> absolute_error(const Trajectory& estimate, const Trajectory& truth,
                                     const Point2& p_robot_lever = Point2::Zero(), double longest_gap_s = 0.25);

struct DisplacementError {
  ErrorSpread length_m;     ///< of | |step| - |true step| |
  ErrorSpread heading_rad;  ///< of the turn, smallest angle
  std::size_t steps = 0;
};

/// The measure of Paper VI: every estimated pose takes the nearest unused true pose within `longest_gap_s`; the lengths
/// of consecutive steps are compared. Differs: the turn is wrapped by 2 pi; the published program wrapped ((a - b) mod
/// 2) pi and so reported turns too large by pi.
Result<DisplacementError> displacement_error(const Trajectory& estimate, const Trajectory& truth,
                                             double longest_gap_s = 0.5);

}  // namespace smokemap
