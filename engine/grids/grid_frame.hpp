#pragma once

#include <Eigen/Core>
#include <cmath>

namespace smokemap {

/// Column and row of a cell; row 0 is the lowest y. Pictures have y down: the flip lives in PixelFrame and in
/// to_image / from_image, nowhere else.
struct Cell {
  int x = 0;
  int y = 0;
  bool operator==(const Cell&) const = default;
};

/// Where a grid lies in its metric frame.
struct GridFrame {
  double resolution_m = 0.05;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< outer corner of cell (0, 0), metres
  int width_cells = 0;
  int height_cells = 0;

  Cell cell_of(const Eigen::Vector2d& p) const {
    return {static_cast<int>(std::floor((p.x() - origin.x()) / resolution_m)),
            static_cast<int>(std::floor((p.y() - origin.y()) / resolution_m))};
  }
  Eigen::Vector2d center_of(Cell cell) const {
    return origin + resolution_m * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5);
  }
  bool contains(Cell cell) const { return cell.x >= 0 && cell.y >= 0 && cell.x < width_cells && cell.y < height_cells; }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_cells) + static_cast<std::size_t>(cell.x);
  }
  std::size_t cell_count() const {
    return static_cast<std::size_t>(width_cells) * static_cast<std::size_t>(height_cells);
  }
  bool operator==(const GridFrame&) const = default;
};

/// The smallest frame of whole cells (multiples of the resolution) that holds both corners with `margin_m` around.
GridFrame frame_around(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double resolution_m, double margin_m);

/// Pixels of a picture (column, row, y down, integers at pixel centres) <-> metres of the same sheet, y up.
/// Metric origin: centre of the lowest left pixel. Shared by layout_px <-> layout and sketch_px <-> sketch.
struct PixelFrame {
  int height_px = 0;
  double metres_per_pixel = 1;

  Eigen::Vector2d to_metres(const Eigen::Vector2d& p_px) const {
    return {p_px.x() * metres_per_pixel, (height_px - 1 - p_px.y()) * metres_per_pixel};
  }
  Eigen::Vector2d to_pixels(const Eigen::Vector2d& p) const {
    return {p.x() / metres_per_pixel, height_px - 1 - p.y() / metres_per_pixel};
  }
};

}  // namespace smokemap
