#pragma once

#include <cstdint>
#include <string>

#include "core/result.hpp"
#include "maps/layout_map.hpp"
#include "simulation/building.hpp"

namespace smokemap::bench {

/// A drawing of walls, light on dark or dark on light, as the layout reader reads it. `metres_per_pixel` is given.
Result<LayoutMap> read_drawing(const std::string& path, double metres_per_pixel);

/// A plan taken at its word: the building that looks like this, its gates shut. Where the drawing shows no way from one
/// room to the next, a door of a metre is cut into a wall between them (which one: by `seed`), so that every room of 4
/// square metres or more can be entered. Rooms are those of the reader. World: metres, y up, as LayoutMap::frame says.
Result<FloorPlan> building_of_plan(const LayoutMap& plan, std::uint64_t seed);

/// The plans of the real buildings of the published experiments in a folder of data sets.
struct RealPlan {
  std::string name, file;  ///< below the folder
  double metres_per_pixel = 0;
};
const std::vector<RealPlan>& real_plans();

}  // namespace smokemap::bench
