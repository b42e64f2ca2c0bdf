#include "geometry/segment2.hpp"

#include <algorithm>

namespace smokemap {
namespace {

/// Parameters (t on one, u on two) of the crossing of the infinite lines.
std::optional<std::pair<double, double>> crossing(const Segment2& one, const Segment2& two) {
  const Point2 d = one.b - one.a, e = two.b - two.a, between = two.a - one.a;
  const double denominator = cross(d, e);
  if (std::abs(denominator) <= 1e-9 * d.norm() * e.norm()) return std::nullopt;
  return std::pair{cross(between, e) / denominator, cross(between, d) / denominator};
}

}  // namespace

Point2 Segment2::direction() const {
  const double l = length();
  return l > 0 ? Point2((b - a) / l) : Point2(Point2::Zero());
}

Point2 Segment2::normal() const {
  const Point2 d = direction();
  return {-d.y(), d.x()};
}

double along(const Segment2& segment, const Point2& p) {
  const Point2 d = segment.b - segment.a;
  const double squared = d.squaredNorm();
  return squared > 0 ? (p - segment.a).dot(d) / squared : 0.0;
}

Point2 closest_point(const Segment2& segment, const Point2& p) {
  return segment.a + std::clamp(along(segment, p), 0.0, 1.0) * (segment.b - segment.a);
}

double distance(const Segment2& segment, const Point2& p) { return (p - closest_point(segment, p)).norm(); }

double signed_line_distance(const Segment2& segment, const Point2& p) { return segment.normal().dot(p - segment.a); }

std::optional<Point2> intersection(const Segment2& one, const Segment2& two) {
  const auto at = crossing(one, two);
  if (!at || at->first < 0 || at->first > 1 || at->second < 0 || at->second > 1) return std::nullopt;
  return one.a + at->first * (one.b - one.a);
}

std::optional<Point2> line_intersection(const Segment2& one, const Segment2& two) {
  const auto at = crossing(one, two);
  if (!at) return std::nullopt;
  return one.a + at->first * (one.b - one.a);
}

}  // namespace smokemap
