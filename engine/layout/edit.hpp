#pragma once

#include "core/result.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// What a person corrects in a layout, as pure functions: the map goes in by value and comes out changed.
/// Indices of corners and walls that stay keep their order.

/// Adds the wall from a to b (layout_px). Ends within `snap_px` of a corner use it, within `snap_px` of a wall split
/// that wall. kInvalidArgument if the ends fall on one corner or are not finite; kConflict if that wall is there
/// already.
Result<LayoutMap> add_wall(LayoutMap layout, const Segment2& wall_px, double snap_px, double thickness_px);

/// Takes the wall out, and corners that nothing meets any more. kNotFound for an index out of range.
Result<LayoutMap> remove_wall(LayoutMap layout, int wall);

/// "These two points are so many metres apart." kInvalidArgument for points closer than a pixel or a length <= 0.
Result<LayoutMap> set_scale(LayoutMap layout, const Point2& a_px, const Point2& b_px, double length_m);

/// Recomputes every corner's degree. For maps that come from outside.
LayoutMap with_degrees(LayoutMap layout);

}  // namespace smokemap
