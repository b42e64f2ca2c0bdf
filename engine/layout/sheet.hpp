#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

using SheetCorners = std::array<Point2, 4>;  ///< clockwise from top left, pixels

struct SheetProposal {
  SheetCorners corners_px;
  double confidence = 0;  ///< 0..1; 0 = nothing stood out and the whole picture is proposed
};

/// The sheet of paper in a photograph: the bright quadrilateral that fills a good part of it.
SheetProposal propose_sheet(const cv::Mat& bgr);

/// The picture seen straight on. Sides get their mean length in the photograph; a sheet within a tenth of the A series'
/// ratio is made to have it. kInvalidArgument unless the corners are finite, convex, clockwise and span at least 16 px.
struct RectifiedSheet {
  cv::Mat bgr;
  SheetHomography homography;
};
Result<RectifiedSheet> rectify_sheet(const cv::Mat& bgr, const SheetCorners& corners_px, double max_megapixels);

}  // namespace smokemap
