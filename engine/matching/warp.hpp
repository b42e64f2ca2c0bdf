#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "matching/align.hpp"
#include "matching/raster.hpp"

namespace smokemap {

/// An alignment bent until the walls of both maps meet.
struct Warp {
  cv::Mat cells_b;      ///< CV_32FC2, one entry a cell of raster a: where it lies in cells of raster b (x, y)
  double scale = 1;     ///< cells of b for one of a, before bending
  double likeness = 0;  ///< of the depth images after bending, 0..1
  double bending = 0;   ///< root mean square of how much neighbouring cells are pulled apart, relative
  double score = 0;     ///< likeness less bending and pin misses; what hypotheses are compared by
};

/// Bends an alignment (Thirion's demons on depth images: each wall moves down the slope of the other map's depth, and
/// the field of moves is smoothed, first widely, then less). Pins are met.
Warp bend(const MapAlignment& alignment, const MapRaster& a, const MapRaster& b, const std::vector<Pin>& pins);

}  // namespace smokemap
