#include "geometry/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/expect.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

/// Positive if p lies inside the circle through a, b, c (counter-clockwise).
bool in_circle(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
  const Point2 u = a - p, v = b - p, w = c - p;
  return u.squaredNorm() * cross(v, w) - v.squaredNorm() * cross(u, w) + w.squaredNorm() * cross(u, v) > 0;
}

std::vector<Point2> moved_a_little(const std::vector<Point2>& points) {
  std::vector<Point2> out = points;
  const double step = 1e-6 * (points[2] - points[0]).norm();
  auto random = random_stream(20171011, 1);
  for (std::size_t i = 4; i < out.size(); ++i)
    out[i] += Point2(uniform(random, -step, step), uniform(random, -step, step));
  return out;
}

/// Replaces the triangles whose circle holds the point by a fan around it.
void insert(int point, const std::vector<Point2>& points, std::vector<TriangleIndices>& triangles) {
  const auto at = [&](int i) -> const Point2& { return points[static_cast<std::size_t>(i)]; };
  std::map<std::pair<int, int>, bool> rim;
  std::size_t kept = 0;
  for (const TriangleIndices& t : triangles) {
    if (!in_circle(at(t[0]), at(t[1]), at(t[2]), at(point))) {
      triangles[kept++] = t;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (const auto twin = rim.find({b, a}); twin != rim.end())
        rim.erase(twin);
      else
        rim[{a, b}] = true;
    }
  }
  triangles.resize(kept);
  for (const auto& [edge, unused] : rim) triangles.push_back({edge.first, edge.second, point});
}

}  // namespace

std::vector<TriangleIndices> triangulate_in_box(const std::vector<Point2>& points) {
  ENGINE_EXPECT(points.size() >= 4);
  const std::vector<Point2> moved = moved_a_little(points);
  std::vector<TriangleIndices> triangles{{0, 1, 2}, {0, 2, 3}};
  for (std::size_t i = 4; i < points.size(); ++i) insert(static_cast<int>(i), moved, triangles);
  return triangles;
}

Eigen::Vector3d barycentric(const Point2& p, const Point2& a, const Point2& b, const Point2& c) {
  const double area = cross(b - a, c - a);
  if (std::abs(area) < 1e-15) return {1, 0, 0};
  const double at_b = cross(p - a, c - a) / area, at_c = cross(b - a, p - a) / area;
  return {1 - at_b - at_c, at_b, at_c};
}

TriangleLocator::TriangleLocator(const std::vector<Point2>& points, const std::vector<TriangleIndices>& triangles)
    : points_(points), triangles_(triangles) {
  if (triangles.empty()) return;
  Point2 high = points.front();
  low_ = points.front();
  for (const Point2& p : points) {
    low_ = low_.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Point2 size = (high - low_).cwiseMax(1e-6);
  cell_m_ =
      std::max({std::sqrt(size.x() * size.y() / static_cast<double>(triangles.size())), size.maxCoeff() / 500.0, 1e-6});
  columns_ = static_cast<int>(size.x() / cell_m_) + 1;
  rows_ = static_cast<int>(size.y() / cell_m_) + 1;
  buckets_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Point2 from = points[static_cast<std::size_t>(triangles[t][0])], to = from;
    for (const int i : triangles[t]) {
      from = from.cwiseMin(points[static_cast<std::size_t>(i)]);
      to = to.cwiseMax(points[static_cast<std::size_t>(i)]);
    }
    const Eigen::Array2i a = ((from - low_) / cell_m_).array().floor().cast<int>();
    const Eigen::Array2i b = ((to - low_) / cell_m_).array().floor().cast<int>();
    for (int y = std::max(0, a.y()); y <= std::min(rows_ - 1, b.y()); ++y)
      for (int x = std::max(0, a.x()); x <= std::min(columns_ - 1, b.x()); ++x)
        buckets_[bucket(x, y)].push_back(static_cast<int>(t));
  }
}

std::size_t TriangleLocator::bucket(int x, int y) const {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
}

std::optional<TriangleLocator::Hit> TriangleLocator::find(const Point2& p) const {
  if (!p.allFinite()) return std::nullopt;
  const Point2 cell = (p - low_) / cell_m_;
  if (cell.x() < 0 || cell.y() < 0 || cell.x() >= columns_ || cell.y() >= rows_) return std::nullopt;
  std::optional<Hit> best;
  double best_share = -1e-9;
  for (const int t : buckets_[bucket(static_cast<int>(cell.x()), static_cast<int>(cell.y()))]) {
    const TriangleIndices& v = triangles_[static_cast<std::size_t>(t)];
    const auto at = [&](std::size_t k) -> const Point2& { return points_[static_cast<std::size_t>(v[k])]; };
    const Eigen::Vector3d shares = barycentric(p, at(0), at(1), at(2));
    if (shares.minCoeff() >= best_share) {
      best = Hit{t, shares};
      best_share = shares.minCoeff();
    }
  }
  return best;
}

}  // namespace smokemap
