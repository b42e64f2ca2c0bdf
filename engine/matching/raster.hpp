#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/pose2.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// A map shrunk to a few thousand cells, which is all that a hand-drawn map can say, with what alignment needs.
struct MapRaster {
  cv::Mat labels;  ///< CV_16UC1: the region of each cell's centre, 0 = none; a margin of empty cells all around
  cv::Mat depth;   ///< CV_32FC1: 0 well outside, 1 on a wall, 2 well inside free space, linear between
  double px_per_cell = 1;
  Point2 origin_px = Point2::Zero();  ///< picture point of the centre of cell (0, 0)
  double wall_direction_rad = 0;      ///< of most walls, modulo 90 degrees, in [0, pi/2); picture axes (y down)
  double free_cells = 0;

  Point2 to_px(const Point2& p_cells) const { return origin_px + px_per_cell * p_cells; }
  Point2 to_cells(const Point2& p_px) const { return (p_px - origin_px) / px_per_cell; }
};

/// Cell -> pixel of the picture.
Eigen::Affine2d pixels_of_cells(const MapRaster& raster);

/// @param side_cells  longer side of the free space's box, without the margin
/// @param slope_cells half width of the ramp of `depth`
MapRaster make_raster(const Segmentation& map, int side_cells, double slope_cells);

/// The same with cells twice as wide, depths averaged; cell centres lie between those of the raster given.
MapRaster halved(const MapRaster& raster);

}  // namespace smokemap
