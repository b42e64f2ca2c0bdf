#include "navigation/planner.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::array<Cell, 8> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

struct Open {
  float priority;
  int index;  // breaks ties, so that the answer does not depend on the queue's mood
  bool operator>(const Open& other) const {
    return priority != other.priority ? priority > other.priority : index > other.index;
  }
};

/// Best-first search from one cell. Without a goal it fills everything (Dijkstra).
class Search {
 public:
  Search(const CostMap& map, Cell start)
      : map_(map), cost_(map.frame().cell_count(), kFar), parent_(map.frame().cell_count(), -1) {
    push(start, 0, -1, 0);
  }

  bool run(std::optional<Cell> goal) {
    const int goal_index = goal ? index(*goal) : -1;
    std::vector<bool> closed(cost_.size(), false);
    while (!queue_.empty()) {
      const int i = queue_.top().index;
      queue_.pop();
      if (closed[static_cast<std::size_t>(i)]) continue;
      closed[static_cast<std::size_t>(i)] = true;
      if (i == goal_index) return true;
      expand(i, goal);
    }
    return !goal;
  }

  std::vector<Cell> way_to(Cell goal) const {
    std::vector<Cell> way;
    for (int i = index(goal); i >= 0; i = parent_[static_cast<std::size_t>(i)]) way.push_back(cell(i));
    std::reverse(way.begin(), way.end());
    return way;
  }
  std::vector<float> take_costs() { return std::move(cost_); }

 private:
  int index(Cell c) const { return static_cast<int>(map_.frame().index(c)); }
  Cell cell(int i) const { return {i % map_.frame().width_cells, i / map_.frame().width_cells}; }

  void push(Cell c, float cost, int parent, float to_go) {
    const auto i = static_cast<std::size_t>(index(c));
    if (cost >= cost_[i]) return;
    cost_[i] = cost, parent_[i] = parent;
    queue_.push({cost + to_go, static_cast<int>(i)});
  }

  void expand(int i, const std::optional<Cell>& goal) {
    const Cell c = cell(i);
    const double step_m = map_.frame().resolution_m;
    for (const Cell& d : kNeighbours) {
      const Cell next{c.x + d.x, c.y + d.y};
      if (!map_.drivable(next)) continue;
      if (d.x != 0 && d.y != 0 && !(map_.drivable({c.x + d.x, c.y}) && map_.drivable({c.x, c.y + d.y}))) continue;
      const double length = step_m * (d.x != 0 && d.y != 0 ? std::numbers::sqrt2 : 1.0);
      const double to_go = goal ? step_m * std::hypot(goal->x - next.x, goal->y - next.y) : 0.0;
      push(next, cost_[static_cast<std::size_t>(i)] + static_cast<float>(length * map_.cost_per_metre(next)), i,
           static_cast<float>(to_go));
    }
  }

  const CostMap& map_;
  std::vector<float> cost_;
  std::vector<int> parent_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> queue_;
};

/// Cost of the straight line, or nothing if it leaves drivable ground or squeezes between two corners.
std::optional<double> straight_cost(const CostMap& map, const Point2& a, const Point2& b) {
  const double length = (b - a).norm(), step = 0.25 * map.frame().resolution_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(length / step)));
  double cost = 0;
  Cell before = map.frame().cell_of(a);
  for (int i = 0; i <= steps; ++i) {
    const Cell cell = map.frame().cell_of(a + (b - a) * (static_cast<double>(i) / steps));
    if (!map.drivable(cell)) return std::nullopt;
    if (cell.x != before.x && cell.y != before.y &&
        !(map.drivable({cell.x, before.y}) && map.drivable({before.x, cell.y})))
      return std::nullopt;
    cost += map.cost_per_metre(cell) * length / (steps + 1);
    before = cell;
  }
  return cost;
}

/// Leaves out points as long as the straight line costs no more than the way over them.
std::vector<Point2> shorten(const CostMap& map, const std::vector<Point2>& way) {
  std::vector<Point2> kept{way.front()};
  std::size_t from = 0;
  while (from + 1 < way.size()) {
    std::size_t best = from + 1;
    double over = 0;
    for (std::size_t to = from + 1; to < way.size() && to < from + 60; ++to) {
      over += straight_cost(map, way[to - 1], way[to]).value_or(0);
      const auto direct = straight_cost(map, way[from], way[to]);
      if (direct && *direct <= 1.02 * over + 1e-6) best = to;
    }
    kept.push_back(way[best]);
    from = best;
  }
  return kept;
}

Path measured(const CostMap& map, std::vector<Point2> points) {
  Path path;
  path.points = std::move(points);
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const Point2 &a = path.points[i - 1], &b = path.points[i];
    const double length = (b - a).norm();
    path.length_m += length;
    const int steps = std::max(1, static_cast<int>(length / map.frame().resolution_m));
    for (int k = 0; k < steps; ++k)
      if (map.ground(map.frame().cell_of(a + (b - a) * ((k + 0.5) / steps))) == Ground::kPlanned)
        path.planned_m += length / steps;
  }
  return path;
}

Error unreachable_goal(const CostMap& map, const Point2& goal) {
  switch (map.ground(map.frame().cell_of(goal))) {
    case Ground::kBlocked:
      return fail(Errc::kDegenerate, "the place is inside a wall or an obstacle");
    case Ground::kUnknown:
      return fail(Errc::kDegenerate, "the place is neither on the plan nor seen by a robot");
    default:
      return fail(Errc::kDegenerate, "the place is too narrow for the robot");
  }
}

}  // namespace

Result<Ok> PlannerParams::validate() const {
  return ParamCheck("PlannerParams")
      .in_range("leave_radius_m", leave_radius_m, 0, 5)
      .in_range("goal_radius_m", goal_radius_m, 0, 5)
      .result();
}

std::optional<Cell> nearest_drivable(const CostMap& map, const Point2& p, double radius_m) {
  const Cell center = map.frame().cell_of(p);
  const int reach = static_cast<int>(std::ceil(radius_m / map.frame().resolution_m));
  std::optional<Cell> best;
  double best_m = radius_m + map.frame().resolution_m;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Cell cell{center.x + dx, center.y + dy};
      if (!map.drivable(cell)) continue;
      const double away = (map.frame().center_of(cell) - p).norm();
      if (away < best_m) best_m = away, best = cell;
    }
  return best;
}

Result<Path> plan_path(const CostMap& map, const Point2& start, const Point2& goal, const PlannerParams& params) {
  const auto from = nearest_drivable(map, start, params.leave_radius_m);
  if (!from) return fail(Errc::kDegenerate, "the robot stands where it can't move");
  const auto to = nearest_drivable(map, goal, params.goal_radius_m);
  if (!to) return unreachable_goal(map, goal);
  Search search(map, *from);
  if (!search.run(*to)) return fail(Errc::kDegenerate, kNoWayKnown);
  std::vector<Point2> way;
  for (const Cell& cell : search.way_to(*to)) way.push_back(map.frame().center_of(cell));
  std::vector<Point2> points = shorten(map, way);
  points.insert(points.begin(), start);
  if (map.frame().cell_of(goal) == *to) points.push_back(goal);
  return measured(map, std::move(points));
}

std::vector<float> cost_to_come(const CostMap& map, const Point2& start, const PlannerParams& params) {
  const auto from = nearest_drivable(map, start, params.leave_radius_m);
  if (!from) return std::vector<float>(map.frame().cell_count(), kFar);
  Search search(map, *from);
  search.run(std::nullopt);
  return search.take_costs();
}

}  // namespace smokemap
