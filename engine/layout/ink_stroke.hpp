#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/segment2.hpp"
#include "layout/layout_params.hpp"

namespace smokemap {

/// A straight piece of ink, as wide as it was drawn. Pixels of the working picture.
struct InkStroke {
  Segment2 axis;            ///< centre line; ends where the ink ends or meets wider ink
  double thickness_px = 0;  ///< by the darkness summed across, so that blur does not thicken it
  double coverage = 0;      ///< share of the axis where ink of that width lies
  double darkness = 0;      ///< mean along the axis, 0..1
  bool hollow = false;      ///< two thin lines with paper between
  int line = -1;            ///< the same for pieces of one line, between which it is thinner or missing: windows

  double length() const { return axis.length(); }
};

/// What is darker than half of the darkest around it (and than ink_low): CV_8UC1, 255 = ink.
/// @param darkness CV_8UC1, 0 paper .. 255 black
cv::Mat ink_mask(const cv::Mat& darkness, const LayoutParams& params);

/// How dark this picture's ink is, 0..255, where blur has not thinned it: the upper quartile of all that is clearly
/// dark; 255 without ink.
double usual_black(const cv::Mat& darkness, double share = 0.25);

/// Finds straight pieces of ink: edges (line segment detector, in strips so that memory stays small), for each the
/// width of the ink behind it, then the centre line is followed along the ink as far as it goes. Longest first; every
/// piece of ink belongs to one stroke of each direction. Ink is what is darker than half of the darkest around it (and
/// than ink_low), so that faint thin lines keep their width.
/// @param darkness CV_8UC1, 0 paper .. 255 black
std::vector<InkStroke> trace_strokes(const cv::Mat& darkness, const LayoutParams& params);

}  // namespace smokemap
