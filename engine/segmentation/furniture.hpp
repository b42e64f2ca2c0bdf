#pragma once

#include <opencv2/core.hpp>

namespace smokemap {

/// What walls leave free, whatever stands in the rooms.
struct Structure {
  cv::Mat free_space;       ///< CV_8UC1, 255 = free, furniture painted over
  double thickness_px = 0;  ///< usual in the narrower part of it
};

/// Furniture hides how wide rooms are, so what counts as furniture is asked again once some of it is gone.
/// @param clutter_ratio  islands smaller than this many usual thicknesses are furniture
Structure structure_of(const cv::Mat& free_space, double clutter_ratio);

}  // namespace smokemap
