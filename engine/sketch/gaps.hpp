#pragma once

#include <vector>

#include "maps/sketch_map.hpp"
#include "sketch/sketch_params.hpp"

namespace smokemap {

/// Openings that loose ends of walls were meant to close, and those they were meant to leave.
/// @param extent_px  longer side of the box round the walls
/// Cost: O(ends * points).
std::vector<SketchGap> find_gaps(const std::vector<Stroke>& walls, double extent_px, const SketchParams& params);

}  // namespace smokemap
