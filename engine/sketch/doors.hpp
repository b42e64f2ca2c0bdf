#pragma once

#include <vector>

#include "geometry/segment2.hpp"
#include "maps/sketch_map.hpp"

namespace smokemap {

/// Doors drawn as architects do: a leaf that stands open, the arc it swings on, or both.
struct DrawnDoors {
  std::vector<Stroke> walls;          ///< what is left; strokes that held a door are parted
  std::vector<Stroke> marks;          ///< leaves and arcs, kDoor
  std::vector<Segment2> openings_px;  ///< from the hinge to the place where the leaf shuts
};

/// Takes doors out of wall strokes: an arc of about a quarter of a circle whose centre lies at a wall (the hinge) and
/// one of whose ends lies at a wall. A straight line from the hinge to the other end is its leaf.
/// @param extent_px  longer side of the box round the walls; doors are a small share of it
/// Source: own. Cost: O(points + arcs * pieces).
DrawnDoors find_drawn_doors(const std::vector<Stroke>& walls, double extent_px);

}  // namespace smokemap
