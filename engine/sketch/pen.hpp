#pragma once

#include <opencv2/core.hpp>

#include "grids/paper_view.hpp"

namespace smokemap {

/// Where somebody drew on the paper.
struct PenInk {
  cv::Mat mask;           ///< CV_8UC1, 255 = pen
  cv::Mat strength;       ///< CV_8UC1, how much pen
  bool coloured = false;  ///< the pen has a colour of its own, so gray rulings and shadows do not count as ink
};

/// Finds the pen's colour, if a fair part of the ink shares one, and measures every pixel along it; a black pen is
/// measured by darkness. Only what is thin stands out (top-hat), so folds and shadow edges fall away. Weak ink stays
/// where it is connected to strong ink.
PenInk find_pen(const PaperView& view);

}  // namespace smokemap
