#pragma once

#include <vector>

#include "simulation/building.hpp"

namespace smokemap {

/// A thick piece of wall between its ends and its doors: a rectangle around `line`, which is a centre line.
struct WallSolid {
  Segment2 line;
  double half_thickness_m = 0;
  int wall = 0;

  Polygon quad() const;  ///< counter-clockwise
};

/// The walls of a plan as rectangles, cut at doors, grown into each other at corners so that these are filled.
/// @param thickness_m per wall; empty = the plan's own
std::vector<WallSolid> wall_solids(const FloorPlan& plan, const std::vector<double>& thickness_m = {});

}  // namespace smokemap
