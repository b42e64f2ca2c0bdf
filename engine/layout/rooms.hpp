#pragma once

#include <vector>

#include "geometry/polygon.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// The spaces that walls and openings together close off, as outlines through the middle of the walls; large first.
/// Spaces under 0.05 % of the plan's square are shafts or slips.
std::vector<Polygon> find_rooms(const LayoutMap& map);

}  // namespace smokemap
