#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/pose2.hpp"

namespace smokemap {

using TriangleIndices = std::array<int, 3>;

/// Delaunay triangulation of points inside a box whose four corners are the first four points, counter-clockwise
/// (Bowyer 1981, Watson 1981). The other points must lie strictly inside the box and be distinct.
/// @return triangles, counter-clockwise, that cover the box. Cost: O(n^1.5) for spread points.
/// Differs from the textbook: starts from the box instead of a super-triangle, and looks at points moved by about a
/// millionth of the box, always the same way, so that the many points of a plan that lie on one circle make no trouble.
std::vector<TriangleIndices> triangulate_in_box(const std::vector<Point2>& points);

/// The shares with which the corners of a triangle make up `p`; all in [0, 1] inside.
Eigen::Vector3d barycentric(const Point2& p, const Point2& a, const Point2& b, const Point2& c);

/// Finds the triangle that holds a point by a grid of buckets.
class TriangleLocator {
 public:
  TriangleLocator() = default;
  TriangleLocator(const std::vector<Point2>& points, const std::vector<TriangleIndices>& triangles);
  struct Hit {
    int triangle = 0;
    Eigen::Vector3d shares;
  };
  /// Nothing outside of all triangles.
  std::optional<Hit> find(const Point2& p) const;

 private:
  std::size_t bucket(int x, int y) const;
  std::vector<Point2> points_;
  std::vector<TriangleIndices> triangles_;
  Point2 low_ = Point2::Zero();
  double cell_m_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<int>> buckets_;
};

}  // namespace smokemap
