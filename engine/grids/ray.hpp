#pragma once

#include <cmath>
#include <limits>

#include "grids/grid_frame.hpp"

namespace smokemap {

/// Calls `visit(cell)` for every cell that the straight line from `from` to `to` passes, in order, both end cells
/// included; stops early when `visit` returns false. Cells outside the frame are visited too: `visit` checks.
/// No cell is skipped at corners (Amanatides and Woo 1987).
template <typename Visit>
void walk_ray(const GridFrame& frame, const Eigen::Vector2d& from, const Eigen::Vector2d& to, Visit&& visit) {
  Cell cell = frame.cell_of(from);
  const Cell last = frame.cell_of(to);
  const Eigen::Vector2d along = to - from;
  const int step_x = along.x() >= 0 ? 1 : -1, step_y = along.y() >= 0 ? 1 : -1;
  const auto first_border = [&](double start, double origin, double by, int index, int step) {
    if (by == 0) return std::numeric_limits<double>::infinity();
    return (origin + frame.resolution_m * (index + (step > 0 ? 1 : 0)) - start) / by;
  };
  double next_x = first_border(from.x(), frame.origin.x(), along.x(), cell.x, step_x);
  double next_y = first_border(from.y(), frame.origin.y(), along.y(), cell.y, step_y);
  const double per_x = along.x() == 0 ? 0 : frame.resolution_m / std::abs(along.x());
  const double per_y = along.y() == 0 ? 0 : frame.resolution_m / std::abs(along.y());
  int left = std::abs(last.x - cell.x) + std::abs(last.y - cell.y);
  while (visit(cell) && left-- > 0) {
    const bool sideways = cell.y == last.y || (cell.x != last.x && next_x <= next_y);
    if (sideways) {
      cell.x += step_x;
      next_x += per_x;
    } else {
      cell.y += step_y;
      next_y += per_y;
    }
  }
}

}  // namespace smokemap
