#pragma once

#include <utility>
#include <vector>

#include "grids/grid_frame.hpp"
#include "grids/occupancy_grid.hpp"

namespace smokemap {

/// Two end points, metres.
using EndPoints = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Distance to the nearest wall for every point of a plane, looked up smoothly between cell centres.
/// Immutable; distances are cut at `limit_m`. Memory: 4 bytes a cell. Cost to build: linear in cells.
class DistanceMap {
 public:
  DistanceMap() = default;
  /// To the centre of the nearest cell with at least `occupied_from` percent; error up to half a cell diagonal.
  static DistanceMap from_occupied(const OccupancyGrid& grid, double limit_m, int occupied_from = 65);
  /// To the nearest segment, exact at cell centres closer than `limit_m`. The frame is the segments' box with `limit_m`
  /// around it.
  static DistanceMap from_segments(const std::vector<EndPoints>& segments, double resolution_m, double limit_m);

  /// Metres, bilinear between cell centres; `limit_m` outside the frame.
  double at(const Eigen::Vector2d& p) const;
  /// Derivative of `at` by x and y; zero outside.
  Eigen::Vector2d gradient(const Eigen::Vector2d& p) const;
  double limit_m() const { return limit_m_; }
  const GridFrame& frame() const { return frame_; }
  bool empty() const { return distance_m_.empty(); }

 private:
  struct Corners;
  bool corners_of(const Eigen::Vector2d& p, Corners& corners) const;

  GridFrame frame_;
  double limit_m_ = 0;
  std::vector<float> distance_m_;
};

}  // namespace smokemap
