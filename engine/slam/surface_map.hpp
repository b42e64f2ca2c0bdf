#pragma once

#include <cstdint>
#include <vector>

#include "slam/surface_points.hpp"

namespace smokemap {

/// Oriented surface points of several scans in one frame, averaged per cell and per direction (four quarters, so that
/// the two faces of a thin wall stay apart). Made for nearest-surface queries; built often, so memory is reused.
class SurfaceMap {
 public:
  struct Surface {
    Point2 p;
    Point2 normal;  ///< unit
    double weight;  ///< number of points averaged
  };

  explicit SurfaceMap(double cell_m) : cell_m_(cell_m) {}

  /// Empties the map. Only points within `half_size_m` of `center`, per coordinate, will be kept.
  void reset(const Point2& center, double half_size_m);
  /// Points without direction are left out.
  void add(const std::vector<SurfacePoint>& points, const Pose2& T_map_points);
  bool covers(const Point2& p, double margin_m) const;
  bool empty() const { return cells_.empty(); }
  std::size_t size() const { return cells_.size(); }

  /// The nearest surface within `gate_m` whose direction differs less than acos(least_cosine) from `normal` (a zero
  /// normal fits every surface). False when there is none.
  bool nearest(const Point2& p, const Point2& normal, double gate_m, double least_cosine, Surface& found) const;
  /// Calls visit(Surface) for every averaged surface, in the order in which their cells were first seen.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (const Average& a : cells_) visit(Surface{a.p, a.normal, a.weight});
  }

 private:
  struct Average {
    Point2 sum, normal_sum;
    Point2 p, normal;
    double weight;
    std::int32_t next;  ///< another direction in the same cell, -1 = none
    std::int32_t cell;
    std::int32_t quarter;
  };
  int column(double x) const { return static_cast<int>(std::floor((x - low_.x()) / cell_m_)); }
  int row(double y) const { return static_cast<int>(std::floor((y - low_.y()) / cell_m_)); }

  double cell_m_;
  Point2 low_ = Point2::Zero();
  int side_ = 0;
  std::vector<std::int32_t> heads_;
  std::vector<Average> cells_;
};

}  // namespace smokemap
