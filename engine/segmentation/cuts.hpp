#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "segmentation/wall_rings.hpp"

namespace smokemap {

/// A straight line across free space from wall to wall that may be a boundary between rooms.
struct Cut {
  cv::Point a, b;  ///< free pixels beside the walls it ends at
  double length_px = 0;
  double support = 0;  ///< 0..2: at how many of its ends a wall runs on in its direction
};

/// What free space is like on the two sides of a cut.
struct CutSides {
  std::array<double, 2> extent_px = {0, 0};     ///< usual extent in the direction of the cut, close behind it
  std::array<double, 2> clearance_px = {0, 0};  ///< largest clearance straight away from its middle
};

struct CutSearch {
  double longest_px = 0;      ///< no longer cuts
  double tolerance_px = 0;    ///< how far the rings may be off the walls
  double least_detour = 1.6;  ///< the way round along the wall between the ends, in lengths of the cut
};

/// Cuts from reflex corners: to other corners, to the nearest places of walls, and on in the direction of the wall.
/// Ordered by corner. Cost: corners times walls within reach.
std::vector<Cut> candidate_cuts(const cv::Mat& structure, const std::vector<WallRing>& rings, const CutSearch& search);

/// Looks to both sides of a cut, from two pixels away on. A side without room for that is 0 wide.
/// @param structure  255 = free, rim not free; this and other cuts may be drawn into it as walls
CutSides look_beside(const cv::Mat& structure, const cv::Mat& clearance, const Cut& cut);

}  // namespace smokemap
