#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// What a person knows about the picture.
struct LayoutOptions {
  /// Corners of the sheet in photo pixels, clockwise from its top left; then the layout is in pixels of the rectified
  /// sheet.
  std::optional<std::array<Point2, 4>> sheet_corners_px;
  std::optional<double> metres_per_pixel;  ///< of layout_px, measured by a person
  std::optional<Point2> plan_at_px;        ///< layout_px: of several drawings on the sheet the one at this place
  bool rectify = true;                     ///< false: the corners only say where the sheet is, nothing is warped
};

struct LayoutReading {
  LayoutMap layout;
  cv::Mat rectified;           ///< the picture that `layout` lies over: CV_8UC3, the input itself without corners
  SheetHomography homography;  ///< photo pixels -> layout_px; the identity without corners
  std::array<Point2, 4> sheet_corners_px{Point2::Zero(), Point2::Zero(), Point2::Zero(), Point2::Zero()};
  ///< photo pixels, clockwise from top left: those given, else what the program proposes (the whole picture if no sheet
  ///< stands out)
  double sheet_confidence = 0;  ///< 0..1 in the proposal; 1 for corners that were given
};

/// Reads an evacuation plan: picture of any kind (photograph, scan, rendering) -> walls, corners, openings, rooms,
/// signs.
///
/// The steps: divide out the light; split off colour; take the ink; drop text and furniture; trace the skeleton of what
/// is left into straight wall pieces with thickness; keep the thickness class that makes the building; join pieces,
/// close hollow walls, repair walls under signs; make the wall graph; find openings and rooms.
///
/// @param picture_bgr  CV_8UC3 (also CV_8UC1, CV_8UC4, CV_16U*: converted); sheet_px as taken, at most max_megapixels
/// @return layout in pixels of the INPUT picture unless corners were given (then of the rectified sheet). Every wall
/// carries a
///         confidence; what the reader doubts is said in `layout.warnings`.
///         kInvalidArgument: empty picture, corners that make no convex quadrilateral; kTooLarge; kDegenerate: no walls
///         found; kCancelled.
/// Cost: about 0.2 s a megapixel of the working size (at most 8 MP) on one core. Deterministic at any thread count.
/// Source: the classical line of Ahmed et al. (2011) and de las Heras et al. (2014): thick/thin split, line pairs, gap
/// closing; differs: thickness classes are taken from the picture, oblique walls are never forced to right angles.
Result<LayoutReading> read_layout(const cv::Mat& picture_bgr, const LayoutOptions& options = {},
                                  const LayoutParams& params = {}, const Progress& progress = {});

}  // namespace smokemap
