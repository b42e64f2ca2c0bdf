#include "geometry/polygon.hpp"

namespace smokemap {

double signed_area(const Polygon& ring) {
  double twice = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    twice += ring[j].x() * ring[i].y() - ring[i].x() * ring[j].y();
  return 0.5 * twice;
}

Point2 centroid(const Polygon& ring) {
  const double area = signed_area(ring);
  Point2 sum = Point2::Zero();
  if (ring.empty()) return sum;
  if (std::abs(area) < 1e-12) {
    for (const Point2& p : ring) sum += p;
    return sum / static_cast<double>(ring.size());
  }
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    sum += (ring[j] + ring[i]) * (ring[j].x() * ring[i].y() - ring[i].x() * ring[j].y());
  return sum / (6.0 * area);
}

bool contains(const Polygon& ring, const Point2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2 &a = ring[j], &b = ring[i];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

}  // namespace smokemap
