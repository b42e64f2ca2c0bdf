#pragma once

#include <opencv2/core.hpp>

#include "maps/segmentation.hpp"

namespace smokemap {

/// Numbers labels by descending area (ties: topmost, then leftmost pixel) and describes regions and borders.
/// @param labels  CV_32SC1, 0 = not free; at most 65535 different ones
Segmentation describe_regions(const cv::Mat& labels);

/// Gives every free pixel without a label the label of the nearest labelled one reached through free space; free space
/// without any label is left alone. `labels` CV_32SC1, `free_space` 255 = free.
void grow_labels(const cv::Mat& free_space, cv::Mat& labels);

/// Where two labels touch: the pixels of `label_a` beside `label_b` and of `label_b` beside `label_a`, one run each.
struct Contact {
  int label_a = 0;  ///< the smaller label
  int label_b = 0;
  std::vector<cv::Point> pixels;  ///< row by row
};

/// All contacts (4 neighbours); two openings between the same rooms are two contacts. Ordered by labels, then first
/// pixel.
std::vector<Contact> find_contacts(const cv::Mat& labels);

}  // namespace smokemap
