#include "grids/occupancy_grid.hpp"

#include <algorithm>

namespace smokemap {
namespace {

/// One gray value a cell, the picture's top row being the grid's highest y.
template <typename Gray>
cv::Mat draw(const OccupancyGrid& grid, Gray gray) {
  const GridFrame& frame = grid.frame();
  cv::Mat image(frame.height_cells, frame.width_cells, CV_8UC1);
  for (int row = 0; row < image.rows; ++row) {
    auto* out = image.ptr<std::uint8_t>(row);
    for (int x = 0; x < image.cols; ++x) out[x] = gray(grid.at({x, image.rows - 1 - row}));
  }
  return image;
}

}  // namespace

cv::Mat to_image(const OccupancyGrid& grid) {
  return draw(grid, [](int percent) -> std::uint8_t {
    if (percent < 0) return 205;
    return static_cast<std::uint8_t>(254 - std::min(percent, 100) * 254 / 100);
  });
}

cv::Mat free_mask(const OccupancyGrid& grid, int free_below) {
  return draw(grid, [&](int percent) -> std::uint8_t { return percent >= 0 && percent <= free_below ? 255 : 0; });
}

}  // namespace smokemap
