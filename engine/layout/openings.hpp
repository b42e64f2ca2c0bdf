#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "layout/ink_stroke.hpp"
#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// Looks ahead from every end of a wall that nothing carries on: to an end that faces it, or to a wall across its way.
/// What lies between becomes a wall of low confidence where a sign hides it (see repair_hidden), otherwise a window
/// (thin lines run along it; then it may be as wide as a shop front), a door (a leaf stands at its side) or, where the
/// end is loose, a passage. Thin lines that lead aside from a loose end to another wall close it there instead, and two
/// thin lines as far apart as a wall is thick are glass from wall to wall. Rows of treads and shelves are none of
/// these. Where walls stand out on both sides of a gap, however little, is a passage.
/// @param covered  CV_8UC1, 255 where signs hide the drawing; same pixels as the map
/// @param ink      CV_8UC1, 255 = ink; empty: nothing is known about what stands out
void close_gaps(LayoutMap& map, const std::vector<InkStroke>& thin, const cv::Mat& covered, double thickness_px,
                const LayoutParams& params, const cv::Mat& ink = {});

}  // namespace smokemap
