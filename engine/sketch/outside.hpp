#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/segment2.hpp"
#include "sketch/sketch_params.hpp"

namespace smokemap {

/// Where a drawing ends.
struct Outline {
  cv::Mat outside;                    ///< CV_8UC1, 255 = outside
  std::vector<Segment2> openings_px;  ///< of the outline, wider than those found before; thought closed
};

/// What the border of the sheet reaches through openings wider than the smallest reach that does not lose walls: a wall
/// is lost if there is nothing inside beside it. Bays of the outline stay outside.
/// @param shut       CV_8UC1, 255 = walls, with all openings known so far closed
/// @param extent_px  longer side of the box round the walls
/// Cost: O(pixels).
Outline find_outline(const cv::Mat& shut, double extent_px, const SketchParams& params);

}  // namespace smokemap
