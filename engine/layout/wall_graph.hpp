#pragma once

#include <vector>

#include "layout/ink_stroke.hpp"
#include "layout/layout_params.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// Strokes -> corners and walls: ends that stop short of a wall, or overshoot it, meet its centre line; ends that
/// nearly touch in line, or in a gentle bend, are joined; walls are cut where others meet or cross them. Directions are
/// never changed by more than the snap. Fills corners and walls only, in the strokes' pixels. The order of strokes does
/// not matter beyond rounding.
LayoutMap build_wall_graph(const std::vector<InkStroke>& chosen, double thickness_px, const LayoutParams& params);

/// Two walls that carry each other on in a straight line, where nothing else meets them, become one; corners without
/// walls go. Openings stay where they are.
LayoutMap without_straight_corners(LayoutMap map);

}  // namespace smokemap
