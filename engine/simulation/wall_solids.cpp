#include "simulation/wall_solids.hpp"

#include <algorithm>

#include "core/expect.hpp"

namespace smokemap {

Polygon WallSolid::quad() const {
  const Point2 side = half_thickness_m * line.normal();
  return {line.a - side, line.b - side, line.b + side, line.a + side};
}

std::vector<WallSolid> wall_solids(const FloorPlan& plan, const std::vector<double>& thickness_m) {
  ENGINE_EXPECT(thickness_m.empty() || thickness_m.size() == plan.walls.size());
  const auto thickness = [&](std::size_t wall) {
    return thickness_m.empty() ? plan.walls[wall].thickness_m : thickness_m[wall];
  };
  // A wall reaches into a corner by half of the thickest other wall there.
  const auto reach = [&](std::size_t wall, int corner) {
    double thickest = 0;
    for (std::size_t other = 0; other < plan.walls.size(); ++other)
      if (other != wall && (plan.walls[other].corner_a == corner || plan.walls[other].corner_b == corner))
        thickest = std::max(thickest, thickness(other));
    return thickest / 2;
  };

  std::vector<WallSolid> solids;
  for (std::size_t i = 0; i < plan.walls.size(); ++i) {
    const Segment2 line = plan.wall_line(static_cast<int>(i));
    const double length = line.length();
    if (length <= 0) continue;
    std::vector<std::pair<double, double>> gaps;
    for (const PlanDoor& door : plan.doors)
      if (door.wall == static_cast<int>(i)) gaps.emplace_back(door.from * length, door.to * length);
    std::sort(gaps.begin(), gaps.end());
    gaps.emplace_back(length + reach(i, plan.walls[i].corner_b), 0.0);
    double from = -reach(i, plan.walls[i].corner_a);
    const Point2 u = line.direction();
    for (const auto& [gap_begin, gap_end] : gaps) {
      if (gap_begin > from)
        solids.push_back({{line.a + from * u, line.a + gap_begin * u}, thickness(i) / 2, static_cast<int>(i)});
      from = gap_end;
    }
  }
  return solids;
}

}  // namespace smokemap
