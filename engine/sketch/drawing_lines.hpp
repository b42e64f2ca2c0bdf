#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/segment2.hpp"
#include "sketch/skeleton.hpp"

namespace smokemap {

using Polyline = std::vector<Point2>;

double polyline_length(const Polyline& line);

/// Takes printed rulings out of the mask: lines that cross most of the picture, nearly parallel, fainter than the pen.
/// Where the pen runs over a ruling its ink stays. Returns how many rulings there were.
/// @param mask      CV_8UC1, 255 = ink; changed
/// @param strength  CV_8UC1, how much pen
int erase_ruled_lines(cv::Mat& mask, const cv::Mat& strength, double turn_deg);

/// Branches as polylines that stay within `tolerance_px` of what was drawn.
std::vector<Polyline> straightened(const std::vector<SkeletonBranch>& branches, double tolerance_px);

/// Drops families of four or more straight, parallel lines with at most `spacing_px` between neighbours: hatching,
/// steps. A line much wider than the others of its family stays.
/// @param widths    of the pen, one a line
/// @param left_out  gets what was dropped, if given
std::vector<Polyline> without_hatching(std::vector<Polyline> lines, const std::vector<double>& widths,
                                       double spacing_px, std::vector<Polyline>* left_out = nullptr);

}  // namespace smokemap
