#pragma once

#include <cstdint>
#include <vector>

#include "geometry/pose2.hpp"
#include "grids/grid_frame.hpp"

namespace smokemap {

/// How likely a point lies at a place, 0 .. 255, blurred around known points; with coarser levels that hold the largest
/// value of each 2^k x 2^k window, so that a search can bound what a whole block of poses may score.
class LikelihoodGrid {
 public:
  /// @param points   in the grid's frame
  /// @param sigma_m  of the blur around each point; cut at three sigma
  LikelihoodGrid(const std::vector<Point2>& points, double cell_m, double sigma_m, int levels);

  const GridFrame& frame() const { return frame_; }
  int levels() const { return static_cast<int>(levels_.size()); }
  /// Largest value over the cells [x, x + 2^level) x [y, y + 2^level); 0 outside.
  int most(int level, int x, int y) const {
    const Level& l = levels_[static_cast<std::size_t>(level)];
    const int column = x + l.pad, row = y + l.pad;
    if (column < 0 || row < 0 || column >= l.width || row >= l.height) return 0;
    return l
        .value[static_cast<std::size_t>(row) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(column)];
  }

 private:
  struct Level {
    int pad = 0, width = 0, height = 0;  ///< cell (x, y) of the frame is stored at (x + pad, y + pad)
    std::vector<std::uint8_t> value;
  };
  static Level coarser(const Level& fine, int reach_cells);

  GridFrame frame_;
  std::vector<Level> levels_;
};

}  // namespace smokemap
