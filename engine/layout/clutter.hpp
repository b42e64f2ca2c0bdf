#pragma once

#include <opencv2/core.hpp>

#include "layout/layout_params.hpp"

namespace smokemap {

/// Letters: pieces of ink that hang together with nothing else, stand in a row of at least three alike (any direction),
/// and are not just bars. A row of wall stubs or columns has gaps wider than its pieces are high, or is made of bars.
/// @param ink  CV_8UC1, 255 = ink
/// @return CV_8UC1, 255 on the letters themselves
/// Cost: one pass of component labelling, 10 ms a megapixel.
cv::Mat find_text(const cv::Mat& ink);

/// Dark bars with light words on them, as tables and titles have on copies without colour: oblong, filled, with at
/// least three light spots of a letter's size, which together are the smaller part.
/// @param darkness  CV_8UC1, 0 paper .. 255 black: blurred letters are hardly lighter than their bar
/// @return CV_8UC1, 255 on bar and words
cv::Mat find_headers(const cv::Mat& darkness, const LayoutParams& params);

/// Filled figures that are wider than walls: signs and headers on copies without colour, columns, shaded boxes.
/// White pictograms inside are part of them.
/// @param wall_px  thickness of the plan's walls
/// @return CV_8UC1, 255 inside
cv::Mat find_blocks(const cv::Mat& ink, double wall_px);

}  // namespace smokemap
