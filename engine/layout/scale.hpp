#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// What a picture says about its scale. Lengths in the same pixels.
struct ScaleEvidence {
  std::vector<double> door_widths_px;
  std::optional<double> bar_division_px;  ///< one division of a scale bar: a round length, but nobody reads its numbers
  std::optional<double> sheet_px;         ///< long side of a sheet with the ratio of the A series
};

/// Metres per pixel with its relative sigma (one standard deviation, doubts between readings included). Doors tell the
/// scale to some 20 %; a bar's division is 0.5, 1, 2, 5 ... metres and tells it exactly once doors tell which; a sheet
/// is A4, A3 or A2 drawn at a round ratio, which is little, but something where no door was found. Nothing without
/// evidence: no bar and less than three doors and no sheet. Cost: about a thousand small steps.
std::optional<LayoutScale> guess_scale(const ScaleEvidence& evidence, const LayoutParams& params);

/// Length of a division of a scale bar: a slim figure standing alone whose boxes are filled in turns, or a line with
/// ticks; three divisions or more, all alike. The longest such figure, along x or y up to some three degrees.
/// @param ink  CV_8UC1, not zero = ink
std::optional<double> find_scale_bar(const cv::Mat& ink);

/// Long side of the picture if its sides have the ratio of the A series within 1.5 percent.
std::optional<double> a_series_side(cv::Size picture);

}  // namespace smokemap
