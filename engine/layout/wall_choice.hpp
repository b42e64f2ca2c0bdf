#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/progress.hpp"
#include "layout/ink_stroke.hpp"
#include "layout/layout_params.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {

/// The strokes of a picture that are walls, and what was seen on the way to them.
struct WallChoice {
  WallStrokes walls;
  cv::Mat covered;                   ///< CV_8UC1, 255 where signs and other figures hide the drawing
  bool fragment = false;             ///< of the walls that are hatched only a small part was read
  std::vector<InkStroke> strokes{};  ///< all that was traced at first
};

/// Walls in the ink. Where the thickest are as thick as walls are looked for, thicker ones are looked for. Where a plan
/// draws them as two lines, or hatches them, the space between is filled and everything is traced once more: then
/// thickness tells walls from leaves and treads, as in plans with solid walls, and blur does no harm.
/// @param darkness  CV_8UC1, 0 paper .. 255 black; without text, colour and signs
/// @param covered   CV_8UC1, 255 where signs hide the drawing
/// @param hidden    CV_8UC1, 255 there and where anything else that has a colour does
/// @param at        the drawing at this place, if a person chose one
WallChoice choose_walls(const cv::Mat& darkness, const cv::Mat& covered, const cv::Mat& hidden,
                        const LayoutParams& params, const std::optional<Point2>& at, const Progress& progress);

}  // namespace smokemap
