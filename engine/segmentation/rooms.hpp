#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "segmentation/cut_selection.hpp"
#include "segmentation/segment.hpp"

namespace smokemap {

struct Rooms {
  cv::Mat labels;               ///< CV_32SC1, 0 = not free, ids from 1 without order
  std::vector<ChosenCut> cuts;  ///< some of them may lie within a room after crumbs were swept
};

/// The default method. Furniture is looked through, but is not free in the answer.
/// @param free_space  CV_8UC1, 255 = free, at least one pixel
Rooms find_rooms(const cv::Mat& free_space, const SegmentationParams& params);

}  // namespace smokemap
