#pragma once

#include <opencv2/core.hpp>

#include "segmentation/segment.hpp"

namespace smokemap {

/// The default method up to, and without, straight borders.
/// @param structure  free space without furniture, CV_8UC1
/// @return CV_32SC1, 0 = not free, ids from 1 without order
cv::Mat constriction_labels(const cv::Mat& structure, const SegmentationParams& params);

}  // namespace smokemap
