#include "slam/node_scans.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <queue>

#include "geometry/covariance.hpp"

namespace smokemap {
namespace {

constexpr double kNormalSteps = 32'000;

std::int16_t packed(double part_of_normal) {
  return static_cast<std::int16_t>(std::lround(part_of_normal * kNormalSteps));
}

/// Covariance of an edge as a displacement about the map's origin: its translation's error, and a turn about the node
/// it leads to.
Eigen::Matrix3d displacement(const PoseGraph& graph, const PoseEdge& edge) {
  const Pose2& T_map_from = graph.nodes[static_cast<std::size_t>(edge.from)].T_map_robot;
  const Pose2& T_map_to = graph.nodes[static_cast<std::size_t>(edge.to)].T_map_robot;
  Eigen::Matrix3d lever = Eigen::Matrix3d::Identity();
  lever.topLeftCorner<2, 2>() = T_map_from.rotation();
  lever.topRightCorner<2, 1>() = Point2(T_map_to.y(), -T_map_to.x());
  const Eigen::Matrix3d root = lever * edge.sqrt_information.inverse();
  return root * root.transpose();
}

}  // namespace

void NodeScans::add(const std::vector<SurfacePoint>& surface, double way_m, bool by_radar) {
  Scan scan{{}, way_m, by_radar};
  scan.points.reserve(surface.size());
  for (const SurfacePoint& s : surface)
    scan.points.push_back({static_cast<float>(s.p.x()), static_cast<float>(s.p.y()), static_cast<float>(s.weight),
                           packed(s.normal.x()), packed(s.normal.y())});
  scans_.push_back(std::move(scan));
}

std::vector<SurfacePoint> NodeScans::surface(int node) const {
  std::vector<SurfacePoint> points;
  points.reserve(scan(node).points.size());
  for (const Packed& p : scan(node).points)
    points.push_back({Point2(static_cast<double>(p.x), static_cast<double>(p.y)),
                      Point2(p.normal_x / kNormalSteps, p.normal_y / kNormalSteps), static_cast<double>(p.weight)});
  return points;
}

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

Eigen::Matrix3d GraphDistance::covariance_at(const Point2& p_map) const {
  Eigen::Matrix3d there = Eigen::Matrix3d::Identity();
  there.topRightCorner<2, 1>() = Point2(-p_map.y(), p_map.x());
  return there * spread * there.transpose();
}

std::vector<GraphDistance> graph_distances(const PoseGraph& graph, const NodeScans& scans, int from, double jump_m) {
  struct Link {
    std::size_t next, edge;
    double length_m;
  };
  const std::size_t count = graph.nodes.size();
  std::vector<std::vector<Link>> links(count);
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const PoseEdge& edge = graph.edges[e];
    if (edge.state == LinkState::kRejected) continue;
    const auto a = static_cast<std::size_t>(edge.from), b = static_cast<std::size_t>(edge.to);
    const double way = std::abs(scans.way_m(edge.from) - scans.way_m(edge.to));
    const double length = b == a + 1 ? way : std::min(way, jump_m);
    links[a].push_back({b, e, length});
    links[b].push_back({a, e, length});
  }
  std::vector<GraphDistance> distance(count);
  for (GraphDistance& d : distance) d.way_m = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> by_edge(count, graph.edges.size()), before(count);
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  distance[static_cast<std::size_t>(from)].way_m = 0;
  open.emplace(0.0, static_cast<std::size_t>(from));
  while (!open.empty()) {
    const auto [so_far, node] = open.top();
    open.pop();
    if (so_far > distance[node].way_m) continue;
    if (by_edge[node] < graph.edges.size())
      distance[node].spread = distance[before[node]].spread + displacement(graph, graph.edges[by_edge[node]]);
    for (const Link& link : links[node]) {
      if (so_far + link.length_m >= distance[link.next].way_m) continue;
      distance[link.next].way_m = so_far + link.length_m;
      by_edge[link.next] = link.edge;
      before[link.next] = node;
      open.emplace(distance[link.next].way_m, link.next);
    }
  }
  return distance;
}

}  // namespace smokemap
