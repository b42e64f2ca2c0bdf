#pragma once

#include <vector>

#include "maps/pose_graph.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// What the back end knows of each node beyond the graph, by node id.
struct NodeScans {
  std::vector<std::vector<SurfacePoint>> surface;  ///< robot frame
  std::vector<double> way_m;                       ///< driven until the node
};

/// Covariance of a match as an edge needs it: information of (x, y, heading) given in the map frame, turned into the
/// frame of a node with heading `heading`, and softened by sigmas that stand for the target's own errors.
Result<Eigen::Matrix3d> edge_sqrt_information(const Eigen::Matrix3d& information_map, double heading, double sigma_m,
                                              double sigma_rad);

/// Length of the shortest way through the graph from one node to every other: what drift grows with. Edges count by the
/// way driven between their ends, loops and matches between visits as `jump_m`; rejected edges not at all.
/// Unreached nodes get infinity. Cost O(edges log nodes).
std::vector<double> graph_distances(const PoseGraph& graph, const NodeScans& scans, int from, double jump_m);

}  // namespace smokemap
