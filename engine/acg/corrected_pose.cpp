#include <optional>

#include "acg/auto_complete_graph.hpp"

namespace smokemap {

Pose2 corrected_pose(const PoseGraph& graph, const MergedMap& merged, const std::string& robot, Stamp stamp,
                     const Pose2& T_slam_robot) {
  if (merged.trajectory.size() != graph.nodes.size()) return T_slam_robot;
  std::optional<std::size_t> before, after;
  for (std::size_t i = 0; i < graph.nodes.size() && !after; ++i) {
    if (graph.nodes[i].robot != robot) continue;
    (graph.nodes[i].stamp <= stamp ? before : after) = i;
  }
  const auto by = [&](std::size_t i) {
    return merged.trajectory[i].T_map_robot * (graph.nodes[i].T_map_robot.inverse() * T_slam_robot);
  };
  if (!before && !after) return T_slam_robot;
  if (!before || !after) return by(before ? *before : *after);
  const Stamp from = graph.nodes[*before].stamp, to = graph.nodes[*after].stamp;
  return interpolate(by(*before), by(*after), static_cast<double>(stamp - from) / static_cast<double>(to - from));
}

}  // namespace smokemap
