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

/// Bends alignments of two maps until walls meet (Thirion's demons on depth images: each wall moves down the slope of
/// the other map's depth, and the field of moves is smoothed, first widely and on a coarse raster, then less). Pins are
/// met. Cost: 2 to 4 ms an alignment.
class BendingPair {
 public:
  BendingPair(const MapRaster& a, const MapRaster& b);
  Warp bend(const MapAlignment& alignment, const std::vector<Pin>& pins) const;
  const MapRaster& a() const { return fine_.a; }
  const MapRaster& b() const { return fine_.b; }

 private:
  struct Level {
    MapRaster a, b;
    cv::Mat seen_b;            ///< CV_32FC3: depth of b and its slope along x and y
    double fine_per_cell = 1;  ///< fine cells for one of this level
  };
  static Level make_level(const MapRaster& a, const MapRaster& b, double fine_per_cell);
  static void run_stage(const Level& level, double smooth_cells, int rounds, const std::vector<Pin>& pins,
                        const cv::Mat& rigid, cv::Mat& moves);

  Level fine_, coarse_;
};

}  // namespace smokemap
