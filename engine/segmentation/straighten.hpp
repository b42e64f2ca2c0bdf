#pragma once

#include <opencv2/core.hpp>

namespace smokemap {

/// Replaces the ragged contacts between regions by straight cuts from wall to wall: the shortest one near each contact.
/// Contacts for which there is none keep their shape. `labels` CV_32SC1 over `structure` (255 = free).
cv::Mat straighten_borders(const cv::Mat& labels, const cv::Mat& structure);

}  // namespace smokemap
