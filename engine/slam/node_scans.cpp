#include "slam/node_scans.hpp"

#include <Eigen/LU>
#include <limits>
#include <queue>

#include "geometry/covariance.hpp"

namespace smokemap {

Result<Eigen::Matrix3d> edge_sqrt_information(const Eigen::Matrix3d& information_map, double heading, double sigma_m,
                                              double sigma_rad) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Pose2(0, 0, heading).rotation().transpose();
  Eigen::Matrix3d information = turn * information_map * turn.transpose();
  information.diagonal().array() += 1.0;  // one metre where the points say nothing
  Eigen::Matrix3d covariance = information.inverse();
  covariance.diagonal() += Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return sqrt_information(Eigen::Matrix3d(0.5 * (covariance + covariance.transpose())));
}

std::vector<double> graph_distances(const PoseGraph& graph, const NodeScans& scans, int from, double jump_m) {
  const std::size_t count = graph.nodes.size();
  std::vector<std::vector<std::pair<int, double>>> links(count);
  for (const PoseEdge& edge : graph.edges) {
    if (edge.state == LinkState::kRejected) continue;
    const auto a = static_cast<std::size_t>(edge.from), b = static_cast<std::size_t>(edge.to);
    const double way = std::abs(scans.way_m[a] - scans.way_m[b]);
    const double length = b == a + 1 ? way : std::min(way, jump_m);
    links[a].emplace_back(edge.to, length);
    links[b].emplace_back(edge.from, length);
  }
  std::vector<double> distance(count, std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  distance[static_cast<std::size_t>(from)] = 0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [so_far, node] = open.top();
    open.pop();
    if (so_far > distance[static_cast<std::size_t>(node)]) continue;
    for (const auto& [next, length] : links[static_cast<std::size_t>(node)]) {
      double& best = distance[static_cast<std::size_t>(next)];
      if (so_far + length >= best) continue;
      best = so_far + length;
      open.emplace(best, next);
    }
  }
  return distance;
}

}  // namespace smokemap
