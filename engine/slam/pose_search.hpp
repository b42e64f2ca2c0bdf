#pragma once

#include <optional>
#include <vector>

#include "slam/likelihood_grid.hpp"

namespace smokemap {

/// The box of poses around a guess that is searched.
struct SearchWindow {
  Pose2 T_map_robot;
  double half_m = 0.3;  ///< each way in x and y
  double half_rad = 0.35;
};

struct SearchResult {
  Pose2 T_map_robot;
  double score = 0;            ///< mean likelihood of the points, 0 .. 1
  double runner_up_score = 0;  ///< best score at least `apart_m` away; 0 when not asked for or below the least score
};

/// The pose in the window at which the points score best, on the lattice of whole cells and of angles at which the
/// farthest point moves by one cell. Exact: the same answer as trying them all (of equals one,
/// always the same). Nothing when no pose reaches `least_score`.
/// @param apart_m  when positive, also says how good the best pose at least this far from the answer is
/// Source: Hess et al., Real-time loop closure in 2D lidar SLAM (ICRA 2016), branch and bound, depth first.
std::optional<SearchResult> search_pose(const std::vector<Point2>& points_robot, const LikelihoodGrid& grid,
                                        const SearchWindow& window, double least_score, double apart_m = 0);

}  // namespace smokemap
