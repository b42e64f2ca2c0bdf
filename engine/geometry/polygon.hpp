#pragma once

#include <vector>

#include "geometry/pose2.hpp"

namespace smokemap {

/// A closed ring; the last point joins the first. Counter-clockwise rings have positive area.
using Polygon = std::vector<Point2>;

double signed_area(const Polygon& ring);
/// Area centroid; the mean of the points for a ring without area.
Point2 centroid(const Polygon& ring);
/// Even-odd rule; points on the border may go either way.
bool contains(const Polygon& ring, const Point2& p);

}  // namespace smokemap
