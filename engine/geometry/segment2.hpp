#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/pose2.hpp"

namespace smokemap {

/// A straight piece between two points, in whatever frame its user says.
struct Segment2 {
  Point2 a = Point2::Zero();
  Point2 b = Point2::Zero();

  double length() const { return (b - a).norm(); }
  /// Unit vector from a to b; zero for a point.
  Point2 direction() const;
  /// Left of the direction.
  Point2 normal() const;
  double heading() const { return std::atan2(b.y() - a.y(), b.x() - a.x()); }
  Point2 midpoint() const { return 0.5 * (a + b); }
};

/// Where along the segment the foot of `p` lies: 0 at a, 1 at b, beyond outside; 0 for a point-like segment.
double along(const Segment2& segment, const Point2& p);
/// Nearest point of the segment (ends included).
Point2 closest_point(const Segment2& segment, const Point2& p);
double distance(const Segment2& segment, const Point2& p);
/// Distance from the infinite line, positive on the left of a -> b.
double signed_line_distance(const Segment2& segment, const Point2& p);
/// The crossing point of two segments, ends included; nothing if parallel or apart.
std::optional<Point2> intersection(const Segment2& one, const Segment2& two);
/// The crossing of the infinite lines; nothing if they are parallel within 1e-9.
std::optional<Point2> line_intersection(const Segment2& one, const Segment2& two);

}  // namespace smokemap
