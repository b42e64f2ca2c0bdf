#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/polygon.hpp"
#include "maps/sketch_map.hpp"

namespace smokemap {

/// What a person has filled with slanting lines: shafts, cupboards, machines. Nobody walks there. Lines along the walls
/// are steps instead, and stairs are free space.
struct Hatching {
  Polygon outline_px;
  double heading_rad = 0;  ///< of its lines, modulo pi
};

/// Hatched areas in the ink of a photographed drawing: close lines that fill an area, run one way, and not along the
/// walls. Every area is a rectangle where it nearly is one, else its hull.
/// @param mask  CV_8UC1, 255 = ink
std::vector<Hatching> find_hatched_ink(const cv::Mat& mask);

/// Takes the hatching out of the mask and leaves its outline, `pen_px` thick.
void outline_hatched_ink(const std::vector<Hatching>& areas, int pen_px, cv::Mat& mask);

/// Parallel lines across the area, by which find_hatched_strokes() finds it again.
std::vector<Segment2> hatching_lines(const Hatching& area);

/// Strokes that hatch an area (four or more straight, near, slanting ones), walls or notes, and the areas.
struct HatchedStrokes {
  std::vector<Hatching> areas;
  std::vector<bool> is_hatching;  ///< one a stroke
};

/// @param extent  longer side of the drawing
HatchedStrokes find_hatched_strokes(const std::vector<Stroke>& strokes, double extent);

}  // namespace smokemap
