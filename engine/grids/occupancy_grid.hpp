#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "grids/grid_frame.hpp"

namespace smokemap {

/// What crosses between modules: occupancy in percent as ROS has it, -1 unknown, 0 free .. 100 occupied.
class OccupancyGrid {
 public:
  static constexpr std::int8_t kUnknown = -1;

  OccupancyGrid() = default;
  explicit OccupancyGrid(const GridFrame& frame, std::int8_t fill = kUnknown)
      : frame_(frame), percent_(frame.cell_count(), fill) {}

  const GridFrame& frame() const { return frame_; }
  std::int8_t at(Cell cell) const { return percent_[frame_.index(cell)]; }
  std::int8_t& at(Cell cell) { return percent_[frame_.index(cell)]; }
  /// Unknown outside.
  std::int8_t get(Cell cell) const { return frame_.contains(cell) ? at(cell) : kUnknown; }
  const std::vector<std::int8_t>& cells() const { return percent_; }
  std::vector<std::int8_t>& cells() { return percent_; }
  bool empty() const { return percent_.empty(); }

 private:
  GridFrame frame_;
  std::vector<std::int8_t> percent_;
};

/// Gray picture as map_server draws it, y down: 254 free, 0 occupied, 205 unknown, in between linear. CV_8UC1.
cv::Mat to_image(const OccupancyGrid& grid);
/// Free space (percent <= free_below) as 255, everything else 0, y down. CV_8UC1.
cv::Mat free_mask(const OccupancyGrid& grid, int free_below = 35);

}  // namespace smokemap
