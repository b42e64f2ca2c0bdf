#pragma once

#include <optional>
#include <string>

#include "navigation/cost_map.hpp"

namespace smokemap {

/// The narrowest place of the widest way between two places.
struct Bottleneck {
  Point2 p_map = Point2::Zero();
  double width_m = 0;  ///< between blocked cells; to about a cell
};

/// Whatever the robot's size, on ground seen free or planned. Nothing if no way joins the places, or one of them is not
/// on such ground.
/// Cost: O(cells log cells), for the Voronoi graph of the ground (topology/voronoi_graph.hpp).
std::optional<Bottleneck> bottleneck_between(const CostMap& map, const Point2& start, const Point2& goal);

/// For people, when no way is known: where the way is too narrow for the robot, and by how much. Nothing if that is not
/// the reason.
std::optional<std::string> too_narrow_a_way(const CostMap& map, const Point2& start, const Point2& goal);

}  // namespace smokemap
