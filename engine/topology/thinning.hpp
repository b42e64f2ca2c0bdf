#pragma once

#include <opencv2/core.hpp>

namespace smokemap {

/// Distance of free pixels to the nearest not-free one (outside the picture counts as not free). CV_32FC1.
cv::Mat free_clearance(const cv::Mat& free_space);

/// One pixel wide middle lines of free space, connected where free space is (8 neighbours) and with a ring around every
/// obstacle: pixels are taken away in the order of their clearance as long as that changes neither. Tips on ridges of
/// the clearance stay. CV_8UC1, 255 = line.
cv::Mat thin_by_clearance(const cv::Mat& clearance);

}  // namespace smokemap
