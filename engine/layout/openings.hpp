#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "layout/ink_stroke.hpp"
#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// Looks ahead from every loose end of a wall: to a loose end that faces it, or to a wall across its way. What lies
/// between becomes a wall of low confidence where a sign hides it (see repair_hidden), otherwise a window (thin lines
/// run along it), a door (a leaf stands at its side) or a passage.
/// @param covered  CV_8UC1, 255 where signs hide the drawing; same pixels as the map
void close_gaps(LayoutMap& map, const std::vector<InkStroke>& thin, const cv::Mat& covered, double thickness_px,
                const LayoutParams& params);

}  // namespace smokemap
