#include "localization/localize_nodes.hpp"

namespace smokemap {
namespace {

constexpr double kSigmaFirst_m = 0.3, kSigmaFirst_rad = 0.1;

}  // namespace

std::vector<LocalizerEstimate> localize_nodes(const std::vector<LocalizerWall>& walls, const PoseGraph& graph,
                                              const Pose2& T_walls_first, const LocalizerParams& params,
                                              std::uint64_t seed) {
  Localizer localizer(params, seed);
  localizer.set_walls(walls);
  localizer.start_at(T_walls_first, kSigmaFirst_m, kSigmaFirst_rad);
  std::vector<LocalizerEstimate> out;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    Pose2 step;
    if (i > 0) step = graph.nodes[i - 1].T_odom_robot.inverse() * graph.nodes[i].T_odom_robot;
    localizer.update(step, graph.nodes[i].hits_robot ? *graph.nodes[i].hits_robot : std::vector<Point2>{});
    out.push_back(localizer.estimate());
  }
  return out;
}

}  // namespace smokemap
