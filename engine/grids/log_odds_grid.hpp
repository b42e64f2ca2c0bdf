#pragma once

#include <cstdint>
#include <vector>

#include "grids/grid_frame.hpp"
#include "grids/occupancy_grid.hpp"

namespace smokemap {

/// How much a beam says about a cell.
struct LogOddsParams {
  double hit = 0.85;    ///< log odds added by a beam that ends in the cell
  double pass = -0.40;  ///< log odds added by a beam that goes through it
  double clamp = 4.0;   ///< the sum is cut at this, both ways, when read
};

/// Occupancy from beams. Kept as two counts a cell, so that evidence can be taken back exactly when a pose moves:
/// removing what was added leaves the grid as if it had never been there. Grows as needed. 8 bytes a cell.
class LogOddsGrid {
 public:
  explicit LogOddsGrid(double resolution_m = 0.05, const LogOddsParams& params = {});

  /// A beam from `origin` that ended on something at `end`: cells before it are passed, the last one is hit.
  /// @param grazed_m  of the beam's end, along which it passes so near to what it hit that its cells are the surface's:
  ///                  they are not passed
  void add_hit(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, double grazed_m = 0) {
    trace(origin, end, true, 1, grazed_m);
  }
  /// A beam known to be free up to `end`.
  void add_free(const Eigen::Vector2d& origin, const Eigen::Vector2d& end) { trace(origin, end, false, 1, 0); }
  /// Takes back an earlier add with the same arguments.
  void remove_hit(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, double grazed_m = 0) {
    trace(origin, end, true, -1, grazed_m);
  }
  void remove_free(const Eigen::Vector2d& origin, const Eigen::Vector2d& end) { trace(origin, end, false, -1, 0); }

  /// Makes room for points within these corners, and for no more; never shrinks. Growing by itself the grid takes room
  /// to spare, and for a moment twice what it has.
  void reserve(const Eigen::Vector2d& low, const Eigen::Vector2d& high) { grow(low, high, 0); }
  /// Log odds of a cell, clamped; 0 where nothing was seen or outside.
  double log_odds(Cell cell) const;
  bool seen(Cell cell) const;
  /// Percent, unknown where no beam came. Only the part in which something was seen, with `margin_cells` around.
  OccupancyGrid occupancy(int margin_cells = 4) const;
  const GridFrame& frame() const { return frame_; }
  void clear();

 private:
  struct Counts {
    std::int32_t hits = 0;
    std::int32_t passes = 0;
  };
  void grow(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double margin_m);
  void trace(const Eigen::Vector2d& origin, const Eigen::Vector2d& end, bool hit, int times, double grazed_m);
  std::int8_t percent(const Counts& counts) const;

  LogOddsParams params_;
  GridFrame frame_;
  std::vector<Counts> counts_;
};

}  // namespace smokemap
