#include "navigation/frontier.hpp"

#include <cmath>
#include <limits>

namespace smokemap {
namespace {

/// Reachable cells seen free that touch ground nobody saw.
bool is_border(const CostMap& map, Cell cell, const std::vector<float>& cost, bool has_plan) {
  if (map.ground(cell) != Ground::kFree || !std::isfinite(cost[map.frame().index(cell)])) return false;
  const Ground wanted = has_plan ? Ground::kPlanned : Ground::kUnknown;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell next{cell.x + dx, cell.y + dy};
      if (map.frame().contains(next) && map.ground(next) == wanted) return true;
    }
  return false;
}

bool has_planned_ground(const CostMap& map) {
  Cell cell;
  for (cell.y = 0; cell.y < map.frame().height_cells; ++cell.y)
    for (cell.x = 0; cell.x < map.frame().width_cells; ++cell.x)
      if (map.ground(cell) == Ground::kPlanned) return true;
  return false;
}

/// The connected border cells from `seed`, taken out of `border`.
std::vector<Cell> take_cluster(const GridFrame& frame, Cell seed, std::vector<bool>& border) {
  std::vector<Cell> cluster{seed};
  border[frame.index(seed)] = false;
  for (std::size_t i = 0; i < cluster.size(); ++i)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next{cluster[i].x + dx, cluster[i].y + dy};
        if (!frame.contains(next) || !border[frame.index(next)]) continue;
        border[frame.index(next)] = false;
        cluster.push_back(next);
      }
  return cluster;
}

/// The cluster's cell nearest to its middle.
Cell middle(const std::vector<Cell>& cluster) {
  double x = 0, y = 0;
  for (const Cell& cell : cluster) x += cell.x, y += cell.y;
  x /= static_cast<double>(cluster.size()), y /= static_cast<double>(cluster.size());
  Cell best = cluster.front();
  for (const Cell& cell : cluster)
    if (std::hypot(cell.x - x, cell.y - y) < std::hypot(best.x - x, best.y - y)) best = cell;
  return best;
}

bool avoided(const Point2& p, const std::vector<Point2>& avoid, double radius_m) {
  for (const Point2& a : avoid)
    if ((a - p).norm() < radius_m) return true;
  return false;
}

}  // namespace

std::optional<Frontier> best_frontier(const CostMap& map, const Point2& start, const std::vector<Point2>& avoid,
                                      const FrontierParams& params, const std::optional<Point2>& toward) {
  const GridFrame& frame = map.frame();
  const std::vector<float> cost = cost_to_come(map, start, PlannerParams{});
  const bool has_plan = has_planned_ground(map);
  std::vector<bool> border(frame.cell_count(), false);
  Cell cell;
  for (cell.y = 0; cell.y < frame.height_cells; ++cell.y)
    for (cell.x = 0; cell.x < frame.width_cells; ++cell.x)
      border[frame.index(cell)] = is_border(map, cell, cost, has_plan);
  std::optional<Frontier> best;
  double best_score = std::numeric_limits<double>::infinity();
  for (cell.y = 0; cell.y < frame.height_cells; ++cell.y)
    for (cell.x = 0; cell.x < frame.width_cells; ++cell.x) {
      if (!border[frame.index(cell)]) continue;
      const std::vector<Cell> cluster = take_cluster(frame, cell, border);
      const double size_m = static_cast<double>(cluster.size()) * frame.resolution_m;
      const Cell target = middle(cluster);
      const Point2 p = frame.center_of(target);
      if (size_m < params.min_size_m || avoided(p, avoid, params.avoid_radius_m)) continue;
      const double way = static_cast<double>(cost[frame.index(target)]);
      const double score = toward ? way + (p - *toward).norm() : way - params.gain_per_metre * size_m;
      if (score < best_score) best_score = score, best = Frontier{p, size_m, way};
    }
  return best;
}

}  // namespace smokemap
