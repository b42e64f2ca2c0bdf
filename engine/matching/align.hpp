#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "maps/correspondence.hpp"
#include "matching/raster.hpp"

namespace smokemap {

/// One way of laying map a over map b as a whole.
struct MapAlignment {
  Eigen::Affine2d T_b_a_px = Eigen::Affine2d::Identity();  ///< pixel of a -> pixel of b
  double score = 0;  ///< likeness of the two depth images under it, 0..1, less what the pins cost
};

/// Which sides of the drawing are laid over the other map.
enum class Facing { kAsDrawn, kMirrored, kEither };

/// All ways of laying one map over another, compared once, so that pins can be weighed again at every tap.
///
/// The walls of both maps are made parallel, then the four quarter turns (of the mirror image, too, or only), a range
/// of scales along both wall directions and all shifts are compared. Cost: to construct one Fourier transform a
/// candidate, 15 ms and 3 MB altogether; to ask a few milliseconds.
class AlignmentSearch {
 public:
  AlignmentSearch(const MapRaster& a, const MapRaster& b, Facing facing);

  /// Candidate alignments, best first, different from each other.
  std::vector<MapAlignment> best(const std::vector<Pin>& pins, int count) const;

 private:
  struct Candidate {
    int turn = 0;                                            ///< candidates of one turn or mirrored turn share it
    Eigen::Affine2d window_a = Eigen::Affine2d::Identity();  ///< cell of a -> cell of b, before shifting
    cv::Mat likeness;  ///< CV_32FC1: of the depth images, for every shift; shifts wrap round
  };
  MapAlignment best_shift(const Candidate& candidate, const std::vector<Pin>& pins) const;

  MapRaster a_, b_;
  std::vector<Candidate> candidates_;
};

}  // namespace smokemap
