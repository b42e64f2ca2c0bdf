#pragma once

#include <vector>

#include "core/progress.hpp"
#include "maps/pose_graph.hpp"
#include "slam/slam_params.hpp"

namespace smokemap {

struct SolveSummary {
  double cost_before = 0;
  double cost_after = 0;
  int rejected = 0;  ///< loop edges that the others outvoted in this solve
};

/// Moves the nodes onto their edges; the first node stays where it is. Loop edges have a Cauchy kernel, wide at first
/// and narrowed in rounds, so that a wrong loop cannot hold what many right ones deny; loops that end far outside are
/// marked kRejected, far but near enough kDoubtful. Rejected edges take part in the next solve again, with the same
/// kernel. kNotConverged when Ceres gave no usable answer, kCancelled when asked to stop: the graph is untouched then.
Result<SolveSummary> solve_pose_graph(PoseGraph& graph, const GraphParams& params, const Progress& progress = {});

/// How many standard deviations an edge is from its nodes' poses.
double edge_error_sigmas(const PoseEdge& edge, const Pose2& T_map_from, const Pose2& T_map_to);

}  // namespace smokemap
