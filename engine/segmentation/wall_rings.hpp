#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace smokemap {

/// A corner of the boundary of free space.
struct WallCorner {
  cv::Point p;             ///< the free pixel at the corner
  double along_px = 0;     ///< way from the first corner of its ring
  bool is_reflex = false;  ///< the wall points into free space here: where boundaries of rooms begin
};

/// One closed boundary of free space with its wobble smoothed away: an outer one, or that round a pillar or wall.
struct WallRing {
  std::vector<WallCorner> corners;
  double length_px = 0;

  /// The shorter way along the ring between two places on it.
  double way_px(double along_a, double along_b) const;
};

/// The boundaries of free space as polygons that stay within `tolerance_px` of it.
/// @param structure  CV_8UC1, 255 = free; no free pixel on its rim
std::vector<WallRing> trace_wall_rings(const cv::Mat& structure, double tolerance_px);

}  // namespace smokemap
