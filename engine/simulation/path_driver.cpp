#include "simulation/path_driver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "core/check.hpp"
#include "core/expect.hpp"

namespace smokemap {
namespace {

struct Open {
  double estimate;
  std::size_t cell;
  bool operator<(
      const Open& other) const {  // the queue gives the largest: the smallest estimate, then the smallest cell
    return estimate != other.estimate ? estimate > other.estimate : cell > other.cell;
  }
};

/// The middle of every room; both ends of corridors.
std::vector<Point2> places_to_see(const FloorPlan& building) {
  std::vector<Point2> places;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const Polygon ring = building.outline(static_cast<int>(i));
    const Point2 middle = centroid(ring);
    if (!building.rooms[i].corridor) {
      places.push_back(middle);
      continue;
    }
    Point2 low = ring.front(), high = low;
    for (const Point2& p : ring) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const int axis = high.x() - low.x() > high.y() - low.y() ? 0 : 1;
    for (const double at : {low[axis] + 1.2, high[axis] - 1.2}) {
      places.push_back(middle);
      places.back()[axis] = at;
    }
  }
  return places;
}

}  // namespace

Result<Ok> PathDriverParams::validate() const {
  return ParamCheck("PathDriverParams")
      .in_range("radius_m", radius_m, 0.02, 2)
      .in_range("margin_m", margin_m, 0, 1)
      .in_range("cell_m", cell_m, 0.02, 0.5)
      .in_range("speed_mps", speed_mps, 0.01, 3)
      .in_range("turn_rate_radps", turn_rate_radps, 0.05, 5)
      .in_range("look_ahead_m", look_ahead_m, 0.05, 3)
      .in_range("arrive_m", arrive_m, 0.02, 2)
      .result();
}

PathDriver::PathDriver(const SegmentWorld& world, const PathDriverParams& params) : params_(params) {
  ENGINE_EXPECT(params.validate().ok());
  frame_ = frame_around(world.low(), world.high(), params.cell_m, 0.5);
  clearance_m_.resize(frame_.cell_count());
  const double interesting = params.radius_m + params.margin_m + 0.4;
  for (int y = 0; y < frame_.height_cells; ++y)
    for (int x = 0; x < frame_.width_cells; ++x)
      clearance_m_[frame_.index({x, y})] = static_cast<float>(world.clearance_m(frame_.center_of({x, y}), interesting));
}

Result<std::vector<Point2>> PathDriver::plan(const Point2& from, const Point2& to) const {
  const Cell start = frame_.cell_of(from), goal = frame_.cell_of(to);
  const double needed = params_.radius_m + params_.margin_m;
  if (!frame_.contains(start) || !frame_.contains(goal) || clearance_m_[frame_.index(goal)] < needed)
    return fail(Errc::kDegenerate, "no robot fits at the place to go to");
  std::vector<double> cost(frame_.cell_count(), std::numeric_limits<double>::infinity());
  std::vector<int> came_from(frame_.cell_count(), -1);
  std::priority_queue<Open> open;
  const auto guess = [&](Cell c) { return std::hypot(c.x - goal.x, c.y - goal.y); };
  cost[frame_.index(start)] = 0;
  open.push({guess(start), frame_.index(start)});
  const auto width = static_cast<std::size_t>(frame_.width_cells);
  while (!open.empty() && open.top().cell != frame_.index(goal)) {
    const Open top = open.top();
    open.pop();
    const Cell here{static_cast<int>(top.cell % width), static_cast<int>(top.cell / width)};
    if (top.estimate > cost[top.cell] + guess(here) + 1e-9) continue;
    for (int step = 0; step < 9; ++step) {
      const Cell next{here.x + step % 3 - 1, here.y + step / 3 - 1};
      if (step == 4 || !frame_.contains(next)) continue;
      const std::size_t index = frame_.index(next);
      const double clearance = clearance_m_[index];
      // A start too near to a wall may be left, as long as the way leads away from it.
      if (clearance < needed && clearance <= clearance_m_[top.cell]) continue;
      const double near_wall = std::max(0.0, needed + 0.3 - clearance) / 0.3;
      const double way = cost[top.cell] + std::hypot(next.x - here.x, next.y - here.y) * (1 + 2 * near_wall);
      if (way >= cost[index]) continue;
      cost[index] = way;
      came_from[index] = static_cast<int>(top.cell);
      open.push({way + guess(next), index});
    }
  }
  if (open.empty()) return fail(Errc::kDegenerate, "no way to the place to go to");
  std::vector<Point2> path{to};
  for (int cell = came_from[frame_.index(goal)]; cell >= 0 && cell != static_cast<int>(frame_.index(start));
       cell = came_from[static_cast<std::size_t>(cell)]) {
    const auto index = static_cast<std::size_t>(cell);
    path.push_back(frame_.center_of({static_cast<int>(index % width), static_cast<int>(index / width)}));
  }
  path.push_back(from);
  std::reverse(path.begin(), path.end());
  return path;
}

std::size_t PathDriver::visit(const Point2& from, const std::vector<Point2>& waypoints) {
  path_.clear();
  next_ = 0;
  std::size_t taken = 0;
  Point2 here = from;
  for (const Point2& goal : waypoints) {
    const auto way = plan(here, goal);
    if (!way) continue;
    path_.insert(path_.end(), way->begin(), way->end());
    here = goal;
    ++taken;
  }
  return taken;
}

VelocityCommand PathDriver::drive(const Pose2& T_world_robot) {
  const Point2& here = T_world_robot.translation();
  while (next_ < path_.size()) {
    const double reach = next_ + 1 == path_.size() ? params_.arrive_m : params_.look_ahead_m;
    if ((path_[next_] - here).norm() > reach) break;
    ++next_;
  }
  if (done()) return {};
  const Point2 p_robot = T_world_robot.inverse() * path_[next_];
  const double bearing = std::atan2(p_robot.y(), p_robot.x());
  VelocityCommand command;
  command.turn_rate_radps = std::clamp(2.5 * bearing, -params_.turn_rate_radps, params_.turn_rate_radps);
  command.speed_mps = std::abs(bearing) > 0.6 ? 0.0 : params_.speed_mps * std::cos(bearing) * std::cos(bearing);
  return command;
}

std::vector<std::vector<Point2>> room_tours(const FloorPlan& building, const std::vector<Point2>& from) {
  std::vector<Point2> open = places_to_see(building);
  std::vector<std::vector<Point2>> tours(from.size());
  std::vector<Point2> here = from;
  for (std::size_t robot = 0; !open.empty() && !from.empty(); robot = (robot + 1) % from.size()) {
    const auto nearest = std::min_element(open.begin(), open.end(), [&](const Point2& a, const Point2& b) {
      return (a - here[robot]).squaredNorm() < (b - here[robot]).squaredNorm();
    });
    here[robot] = *nearest;
    tours[robot].push_back(*nearest);
    open.erase(nearest);
  }
  return tours;
}

std::vector<Point2> room_tour(const FloorPlan& building, const Point2& from) {
  return room_tours(building, {from}).front();
}

}  // namespace smokemap
