#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "navigation/cost_map.hpp"

namespace smokemap {

/// A way to drive, in `map`.
struct Path {
  std::vector<Point2> points;  ///< first = start, last = end; straight in between
  double length_m = 0;
  double planned_m = 0;  ///< of it through places no sensor saw
};

struct PlannerParams {
  double leave_radius_m =
      0.6;  ///< a robot that stands too near to a wall may leave from the nearest drivable cell within
  double goal_radius_m = 0.5;  ///< a goal too near to a wall is moved to the nearest drivable cell within
  Result<Ok> validate() const;
};

/// The reason when both places are fine but nothing drivable joins them: the one that a corrected map may cure.
inline constexpr const char* kNoWayKnown = "no way there is known";

/// The cheapest way (A*, eight neighbours, cost of CostMap), then shortened where the straight line is as good.
/// kDegenerate with a reason for people: in a wall, outside of everything known, or no way there is known.
/// Cost: O(cells log cells). Deterministic.
Result<Path> plan_path(const CostMap& map, const Point2& start, const Point2& goal, const PlannerParams& params);

/// Cost to come from one place to every cell (Dijkstra); infinity where it can't go. Row-major as the cost map.
std::vector<float> cost_to_come(const CostMap& map, const Point2& start, const PlannerParams& params);

/// The nearest drivable cell within `radius_m`, if any.
std::optional<Cell> nearest_drivable(const CostMap& map, const Point2& p, double radius_m);

}  // namespace smokemap
