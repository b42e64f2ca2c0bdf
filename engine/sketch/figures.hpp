#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "sketch/skeleton.hpp"

namespace smokemap {

/// Takes figures out of the mask (255 = ink) that are too small to be walls or stand apart from the drawing, which is
/// the figure with the largest box: dots, holes of the punch, grain, letters, titles.
void drop_small_figures(cv::Mat& mask, double dot_px, double text_px);

/// Takes rows of two or more small figures of one height out: letters in a room. Single strokes are no letters.
void drop_rows_of_letters(cv::Mat& mask);

/// Takes branches out that belong to joined-up writing: figures apart from the drawing, smaller than a good part of it,
/// whose straight strokes are all short beside them. Returns how many such figures there were.
std::size_t drop_words(const cv::Mat& mask, std::vector<SkeletonBranch>& branches);

}  // namespace smokemap
