#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// The plan's free space as a picture, for segmentation and planning: walls are drawn with their thickness, doors and
/// passages stay open gaps, windows are closed, and what lies outside the building is not free.
///
/// @param scale  output pixels per layout_px, e.g. 0.5 for large pictures; pixel p of the output is p / scale in
/// layout_px
/// @return CV_8UC1 of the layout's size times scale: 255 free inside, 0 elsewhere. Where no wall closes a room the
///         outside is what can be reached from the picture's border, doors taken as closed.
///         kInvalidArgument for a layout without size, or a scale that makes it empty or over 40 megapixels.
Result<cv::Mat> layout_free_space(const LayoutMap& layout, double scale = 1.0);

}  // namespace smokemap
