#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "core/result.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

inline constexpr size_t kMostRegions = 65535;  ///< that a label image of 16 bit can tell apart

/// Numbers labels by descending area (ties: topmost, then leftmost pixel) and describes regions and borders.
/// @param labels  CV_32SC1, 0 = not free; at most 65535 different ones
Segmentation describe_regions(const cv::Mat& labels);

/// Gives every free pixel without a label the label of the nearest labelled one reached through free space; free space
/// without any label is left alone. `labels` CV_32SC1, `free_space` 255 = free.
void grow_labels(const cv::Mat& free_space, cv::Mat& labels);

/// Labels the connected parts of free space that have none yet, from `next` on.
void label_rest(const cv::Mat& free_space, int next, cv::Mat& labels);

/// Parts of a region that a cut or furniture tore off become regions of their own (4 neighbours). New ids from 1.
cv::Mat connected_regions(const cv::Mat& labels);

/// Regions smaller than `least_area` join the nearest one that is not, unless all are so small.
void sweep_crumbs(cv::Mat& labels, double least_area);

/// Refuses what no method can split, with the reason: not CV_8UC1, over 64 megapixels, no free cell.
Result<Ok> check_free_space(const cv::Mat& free_space);

/// describe_regions; kTooLarge over 65535 regions.
Result<Segmentation> described(const cv::Mat& labels);

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
