#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "grids/paper_view.hpp"
#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// The coloured figures of a plan, in pixels of the picture given.
struct Signs {
  std::vector<LayoutSign> signs;          ///< reading order: top to bottom, left to right
  std::optional<Point2> you_are_here_px;  ///< the most disc-like blue figure
  cv::Mat covered;                        ///< CV_8UC1, 255 where a sign hides what is drawn below
};

/// Coloured figures of sign size (half to four percent of the long side), by class of colour. Routes, headers and
/// tinted rooms are too large or too pale. In a picture without any colour (a gray copy) gray figures of that size, as
/// "grey".
Signs find_signs(const PaperView& view, const LayoutParams& params);

}  // namespace smokemap
