#pragma once

#include <optional>
#include <vector>

#include "maps/layout_map.hpp"

namespace smokemap {

/// Widths of all openings read as doors, in the map's pixels.
std::vector<double> door_widths(const LayoutMap& map);

/// Half of the doors are wider; nothing below three doors, which may all be misread.
std::optional<double> usual_door_width(std::vector<double> widths);

}  // namespace smokemap
