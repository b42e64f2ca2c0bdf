#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "geometry/segment2.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

using SheetCorners = std::array<Point2, 4>;  ///< clockwise from top left, pixels

struct SheetProposal {
  SheetCorners corners_px;
  double confidence = 0;  ///< 0..1; 0 = nothing stood out and the whole picture is proposed
  double sigma_px = 0;    ///< of a corner, if these are the sides of the sheet at all, which is what confidence says
};

/// The sheet of paper in a photograph: the quadrilateral that fills a good part of it and differs from what lies around
/// it, found at a small size and refined at full size. Where no rim is in sight, a rectangle of the sheet around the
/// drawing, from the vanishing points of its lines, at less confidence.
SheetProposal propose_sheet(const cv::Mat& bgr);

/// Every side moved to where paper begins, by at most 1.6 % of the sheet's long side, to a fraction of a pixel; a side
/// without a clear rim stays.
/// @param bgr  CV_8UC3
struct RefinedSheet {
  SheetCorners corners_px;
  double agreement = 0;  ///< of the side least seen: share of its length at which the rim is where the side is
  double sigma_px = 0;   ///< of the worst corner
};
RefinedSheet refine_sheet(const cv::Mat& bgr, const SheetCorners& corners_px);

/// A step in brightness runs inside the sides at the same distance from all of them: they may be those of a picture
/// frame as bright as paper. Coloured borders printed on the sheet look alike.
bool may_be_framed(const cv::Mat& bgr, const SheetCorners& corners_px);

/// From straight lines in a picture: the rectangle of the sheet that bounds them. Nothing when one of two families of
/// lines (rows, columns; each within 35 degrees of its axis) does not meet in one point, or when both are parallel: a
/// picture taken straight on needs no corners.
std::optional<SheetProposal> propose_by_vanishing_points(const std::vector<Segment2>& lines_px, cv::Size size);

/// The picture seen straight on. Sides get their mean length in the photograph; a sheet within a tenth of the A series'
/// ratio is made to have it. kInvalidArgument unless the corners are finite, convex, clockwise and span at least 16 px.
struct RectifiedSheet {
  cv::Mat bgr;
  SheetHomography homography;
};
Result<RectifiedSheet> rectify_sheet(const cv::Mat& bgr, const SheetCorners& corners_px, double max_megapixels);

}  // namespace smokemap
