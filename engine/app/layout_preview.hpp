#pragma once

#include <opencv2/core.hpp>

#include "maps/layout_map.hpp"

namespace smokemap::app {

/// The reading over its picture: walls red (doubtful ones orange), corners black, doors blue, windows light blue,
/// passages green, signs circled, rooms tinted.
cv::Mat draw_layout(const cv::Mat& rectified_bgr, const LayoutMap& layout);

}  // namespace smokemap::app
