#include "navigation/bottleneck.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <utility>
#include <vector>

#include "topology/voronoi_graph.hpp"

namespace smokemap {
namespace {

/// Every way counts, however narrow.
constexpr VoronoiParams kAllWays{.clutter_ratio = 0, .narrow_ratio = 0, .part_ratio = 0};

struct Narrowest {
  double clearance_m = std::numeric_limits<double>::infinity();
  Point2 p_px = Point2::Zero();
};

/// The middle lines of the ground as links between numbered places: the graph's nodes, then `start` and `goal`.
class WayNetwork {
 public:
  WayNetwork(const CostMap& map, const VoronoiGraph& graph, const cv::Mat& parts, const Point2& start_px,
             const Point2& goal_px)
      : map_(map), links_(graph.nodes.size() + 2) {
    const auto start = static_cast<int>(graph.nodes.size()), goal = start + 1;
    const Stop from = stop_near(graph, parts, start_px), to = stop_near(graph, parts, goal_px);
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      const VoronoiEdge& edge = graph.edges[e];
      std::vector<std::pair<std::size_t, int>> stops{{0, edge.from}, {edge.path_px.size() - 1, edge.to}};
      if (from.edge == static_cast<int>(e)) stops.emplace_back(from.at, start);
      if (to.edge == static_cast<int>(e)) stops.emplace_back(to.at, goal);
      std::sort(stops.begin(), stops.end());
      for (std::size_t k = 0; k + 1 < stops.size(); ++k)
        link(stops[k].second, stops[k + 1].second, narrowest(edge.path_px, stops[k].first, stops[k + 1].first));
    }
    for (const auto& [stop, place] : {std::pair(from, start), std::pair(to, goal)})
      if (stop.node >= 0) link(stop.node, place, {});
  }

  /// The narrowest place of the widest way from the start to the goal (Dijkstra over the narrowest so far).
  std::optional<Narrowest> solve() const {
    const std::size_t start = links_.size() - 2, goal = links_.size() - 1;
    std::vector<Narrowest> best(links_.size(), Narrowest{-1, Point2::Zero()});
    std::priority_queue<std::pair<double, std::size_t>> queue;
    best[start].clearance_m = std::numeric_limits<double>::infinity();
    queue.emplace(best[start].clearance_m, start);
    while (!queue.empty()) {
      const auto [clearance_m, at] = queue.top();
      queue.pop();
      if (clearance_m < best[at].clearance_m) continue;
      if (at == goal) return best[goal];
      for (const auto& [next, narrow] : links_[at]) {
        const Narrowest& least = narrow.clearance_m < best[at].clearance_m ? narrow : best[at];
        if (least.clearance_m <= best[next].clearance_m) continue;
        best[next] = least;
        queue.emplace(least.clearance_m, next);
      }
    }
    return std::nullopt;
  }

 private:
  /// Where a place joins the graph: on an edge, or at a node that has none.
  struct Stop {
    int edge = -1, node = -1;
    std::size_t at = 0;
  };

  Stop stop_near(const VoronoiGraph& graph, const cv::Mat& parts, const Point2& p_px) const {
    const auto part_at = [&](const Point2& p) {
      return parts.at<int>(static_cast<int>(std::lround(p.y())), static_cast<int>(std::lround(p.x())));
    };
    Stop best;
    double nearest = std::numeric_limits<double>::infinity();
    const int part = part_at(p_px);
    const auto is_nearer = [&](const Point2& p) {
      const double away = (p - p_px).squaredNorm();
      if (away >= nearest || part_at(p) != part) return false;
      nearest = away;
      return true;
    };
    for (std::size_t n = 0; n < graph.nodes.size(); ++n)
      if (graph.nodes[n].edges.empty() && is_nearer(graph.nodes[n].p_px)) best = {-1, static_cast<int>(n), 0};
    for (std::size_t e = 0; e < graph.edges.size(); ++e)
      for (std::size_t i = 0; i < graph.edges[e].path_px.size(); ++i)
        if (is_nearer(graph.edges[e].path_px[i])) best = {static_cast<int>(e), -1, i};
    return best;
  }

  Narrowest narrowest(const std::vector<Point2>& path_px, std::size_t from, std::size_t to) const {
    Narrowest least;
    for (std::size_t i = from; i <= to; ++i) {
      const Cell cell{static_cast<int>(path_px[i].x()), static_cast<int>(path_px[i].y())};
      const double clearance_m = map_.clearance_m(cell);
      if (clearance_m < least.clearance_m) least = {clearance_m, path_px[i]};
    }
    return least;
  }

  void link(int a, int b, const Narrowest& narrow) {
    links_[static_cast<std::size_t>(a)].emplace_back(static_cast<std::size_t>(b), narrow);
    links_[static_cast<std::size_t>(b)].emplace_back(static_cast<std::size_t>(a), narrow);
  }

  const CostMap& map_;
  std::vector<std::vector<std::pair<std::size_t, Narrowest>>> links_;
};

bool is_ground(const CostMap& map, Cell cell) {
  return map.ground(cell) == Ground::kFree || map.ground(cell) == Ground::kPlanned;
}

}  // namespace

std::optional<Bottleneck> bottleneck_between(const CostMap& map, const Point2& start, const Point2& goal) {
  const GridFrame& frame = map.frame();
  const Cell from = frame.cell_of(start), to = frame.cell_of(goal);
  if (!is_ground(map, from) || !is_ground(map, to)) return std::nullopt;
  cv::Mat ground(frame.height_cells, frame.width_cells, CV_8UC1),
      parts;  // a row of cells is a row of pixels: up is down
  for (int y = 0; y < ground.rows; ++y)
    for (int x = 0; x < ground.cols; ++x) ground.at<unsigned char>(y, x) = is_ground(map, {x, y}) ? 255 : 0;
  cv::connectedComponents(ground, parts, 8, CV_32S);
  if (parts.at<int>(from.y, from.x) != parts.at<int>(to.y, to.x)) return std::nullopt;
  const Result<VoronoiGraph> graph = voronoi_graph(ground, kAllWays);
  if (!graph) return std::nullopt;
  const auto narrow = WayNetwork(map, *graph, parts, Point2(from.x, from.y), Point2(to.x, to.y)).solve();
  if (!narrow || !std::isfinite(narrow->clearance_m)) return std::nullopt;
  const Cell at{static_cast<int>(narrow->p_px.x()), static_cast<int>(narrow->p_px.y())};
  return Bottleneck{frame.center_of(at), std::max(0.0, 2 * narrow->clearance_m - frame.resolution_m)};
}

std::optional<std::string> too_narrow_a_way(const CostMap& map, const Point2& start, const Point2& goal) {
  const auto narrow = bottleneck_between(map, start, goal);
  const double needed_m = 2 * map.params().robot_radius_m;
  if (!narrow || narrow->width_m >= needed_m) return std::nullopt;
  char text[160];
  std::snprintf(text, sizeof text, "the way is only %.1f m wide at one place (%.1f, %.1f); the robot needs %.1f m",
                narrow->width_m, narrow->p_map.x(), narrow->p_map.y(), needed_m);
  return std::string(text);
}

}  // namespace smokemap
