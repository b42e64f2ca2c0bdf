#pragma once

#include <vector>

#include "localization/localizer.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

/// Follows one run through walls as they are: from the first node, known within 0.3 m and 0.1 rad, by each node's
/// motion (T_odom_robot) and hits. One estimate a node; in the frame of the walls. Deterministic for a seed.
std::vector<LocalizerEstimate> localize_nodes(const std::vector<LocalizerWall>& walls, const PoseGraph& graph,
                                              const Pose2& T_walls_first, const LocalizerParams& params = {},
                                              std::uint64_t seed = 1);

}  // namespace smokemap
