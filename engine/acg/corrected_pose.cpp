#include <algorithm>

#include "acg/auto_complete_graph.hpp"

namespace smokemap {

Pose2 corrected_pose(const PoseGraph& graph, const MergedMap& merged, Stamp stamp, const Pose2& T_slam_robot) {
  if (graph.nodes.empty() || merged.trajectory.size() != graph.nodes.size()) return T_slam_robot;
  const auto after = std::upper_bound(graph.nodes.begin(), graph.nodes.end(), stamp,
                                      [](Stamp t, const PoseNode& n) { return t < n.stamp; });
  const auto by = [&](std::size_t i) {
    return merged.trajectory[i].T_map_robot * (graph.nodes[i].T_map_robot.inverse() * T_slam_robot);
  };
  if (after == graph.nodes.begin()) return by(0);
  const auto i = static_cast<std::size_t>(after - graph.nodes.begin()) - 1;
  if (after == graph.nodes.end()) return by(i);
  const double span = static_cast<double>(after->stamp - graph.nodes[i].stamp);
  return interpolate(by(i), by(i + 1), span > 0 ? static_cast<double>(stamp - graph.nodes[i].stamp) / span : 0);
}

}  // namespace smokemap
