#pragma once

#include <opencv2/core.hpp>

namespace smokemap {

/// Distance of every free pixel's centre to the nearest not-free pixel's centre; what lies outside the picture is not
/// free. CV_32FC1, 0 where not free. Exact.
cv::Mat clearance_image(const cv::Mat& free_space);

/// Local thickness: for every free pixel the radius of the largest disc inside free space that covers it. CV_32FC1.
/// Constant along a corridor and across a room, so that a step of it is a door or a mouth. (MAORIS calls it fuzzy
/// opening.) Cost: one step a pixel, and one for each row of each disc on the ridge of `clearance`.
cv::Mat local_thickness(const cv::Mat& clearance);

/// The same in whole pixels as MAORIS has it: discs of one pixel less than the clearance of their centres, each painted
/// with that clearance. CV_32FC1.
cv::Mat fuzzy_opening(const cv::Mat& clearance);

/// The free space with furniture painted over: islands of not-free pixels whose larger side is below `max_side_px`
/// become free. What touches the picture's edge stays. CV_8UC1.
cv::Mat without_islands(const cv::Mat& free_space, double max_side_px);

/// What is usual in the narrower part of a map: a fifth of its free area is thinner. A large hall hardly changes it. 0
/// if there is no free pixel.
double typical_thickness(const cv::Mat& thickness);

}  // namespace smokemap
