#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "maps/layout_map.hpp"

namespace smokemap {

/// An end of a wall that meets no other.
struct LooseEnd {
  int corner = 0;
  int wall = 0;
  Point2 p = Point2::Zero();
  Point2 outward = Point2::Zero();  ///< unit, the way the wall would go on
};
std::vector<LooseEnd> loose_ends(const LayoutMap& map);
/// An end of a wall that meets others, none of which carries it on.
std::vector<LooseEnd> joined_ends(const LayoutMap& map);

/// What lies between a loose end and the nearest thing straight ahead.
struct Gap {
  Segment2 segment;
  int corner_a = -1;
  int corner_b = -1;  ///< a loose end that faces it, or -1:
  int wall_b = -1;    ///< it lands on this wall, between its corners
  double thickness_px = 0;
};
/// Every pair of facing ends once. @param reach_px  things further away are not the other side of an opening
std::vector<Gap> gaps_ahead(const LayoutMap& map, const std::vector<LooseEnd>& ends, double thickness_px,
                            double reach_px);

/// Draws the wall across the gap. One that lies across its way is cut there; earlier cuts since the gap was found do no
/// harm.
void carry_on(LayoutMap& map, const Gap& gap, double thickness_px, double confidence);

/// Share of the segment that lies on the mask (CV_8UC1, not zero = on it).
double covered_share(const Segment2& s, const cv::Mat& mask);

/// Walls that signs hide, at confidence 0.5: in line where both sides agree, around a corner where two loose ends would
/// meet below a sign, and up to a wall across the way, which is cut there.
/// @param covered  CV_8UC1, 255 where signs hide the drawing; same pixels as the map
void repair_hidden(LayoutMap& map, const cv::Mat& covered, double thickness_px, double reach_px);

}  // namespace smokemap
