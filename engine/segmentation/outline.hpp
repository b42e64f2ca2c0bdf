#pragma once

#include <opencv2/core.hpp>

#include "geometry/polygon.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// Outer boundary of a region as a simplified ring in pixels of the picture, for showing. Holes are not part of it.
/// Empty for a label that no region has. `tolerance_px` is how far the ring may leave the true boundary.
Polygon region_outline(const Segmentation& segmentation, int label, double tolerance_px = 1.5);

/// The free space in one colour per region over `picture` (same size, CV_8UC1 or CV_8UC3; may be empty), with borders
/// and region numbers: what a person looks at. CV_8UC3, BGR.
cv::Mat draw_segmentation(const Segmentation& segmentation, const cv::Mat& picture = {});

/// A stable, well-spread colour for a region, BGR. The same label has the same colour in every picture.
cv::Vec3b region_colour(int label);

}  // namespace smokemap
