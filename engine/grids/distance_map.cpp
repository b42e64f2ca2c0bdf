#include "grids/distance_map.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/expect.hpp"

namespace smokemap {
namespace {

double distance_to_segment(const EndPoints& segment, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = segment.second - segment.first;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp((p - segment.first).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (segment.first + share * along - p).norm();
}

}  // namespace

/// The four cell centres around a point and where it lies between them.
struct DistanceMap::Corners {
  float low_left, low_right, high_left, high_right;
  double u, v;
};

DistanceMap DistanceMap::from_occupied(const OccupancyGrid& grid, double limit_m, int occupied_from) {
  DistanceMap map;
  map.frame_ = grid.frame();
  map.limit_m_ = limit_m;
  if (grid.empty()) return map;
  const GridFrame& frame = grid.frame();
  cv::Mat open(frame.height_cells, frame.width_cells, CV_8UC1);
  bool any = false;
  for (int y = 0; y < frame.height_cells; ++y)
    for (int x = 0; x < frame.width_cells; ++x) {
      const bool wall = grid.at({x, y}) >= occupied_from;
      open.at<std::uint8_t>(y, x) = wall ? 0 : 255;
      any = any || wall;
    }
  map.distance_m_.assign(frame.cell_count(), static_cast<float>(limit_m));
  if (!any) return map;
  cv::Mat cells;
  cv::distanceTransform(open, cells, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  for (int y = 0; y < frame.height_cells; ++y)
    for (int x = 0; x < frame.width_cells; ++x)
      map.distance_m_[frame.index({x, y})] =
          static_cast<float>(std::min(limit_m, static_cast<double>(cells.at<float>(y, x)) * frame.resolution_m));
  return map;
}

DistanceMap DistanceMap::from_segments(const std::vector<EndPoints>& segments, double resolution_m, double limit_m) {
  ENGINE_EXPECT(resolution_m > 0 && limit_m > 0);
  DistanceMap map;
  map.limit_m_ = limit_m;
  if (segments.empty()) return map;
  Eigen::Vector2d low = segments.front().first, high = low;
  for (const EndPoints& s : segments) {
    low = low.cwiseMin(s.first).cwiseMin(s.second);
    high = high.cwiseMax(s.first).cwiseMax(s.second);
  }
  map.frame_ = frame_around(low, high, resolution_m, limit_m + resolution_m);
  map.distance_m_.assign(map.frame_.cell_count(), static_cast<float>(limit_m));
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(limit_m);
  for (const EndPoints& s : segments) {
    const Cell from = map.frame_.cell_of(s.first.cwiseMin(s.second) - reach),
               to = map.frame_.cell_of(s.first.cwiseMax(s.second) + reach);
    for (int y = std::max(0, from.y); y <= std::min(map.frame_.height_cells - 1, to.y); ++y)
      for (int x = std::max(0, from.x); x <= std::min(map.frame_.width_cells - 1, to.x); ++x) {
        float& cell = map.distance_m_[map.frame_.index({x, y})];
        cell = std::min(cell, static_cast<float>(distance_to_segment(s, map.frame_.center_of({x, y}))));
      }
  }
  return map;
}

bool DistanceMap::corners_of(const Eigen::Vector2d& p, Corners& corners) const {
  if (distance_m_.empty()) return false;
  const double x = (p.x() - frame_.origin.x()) / frame_.resolution_m - 0.5,
               y = (p.y() - frame_.origin.y()) / frame_.resolution_m - 0.5;
  if (!(x >= 0 && y >= 0 && x < frame_.width_cells - 1 && y < frame_.height_cells - 1)) return false;
  const Cell low{static_cast<int>(x), static_cast<int>(y)};
  const std::size_t at = frame_.index(low), above = at + static_cast<std::size_t>(frame_.width_cells);
  corners = {distance_m_[at], distance_m_[at + 1], distance_m_[above], distance_m_[above + 1], x - low.x, y - low.y};
  return true;
}

double DistanceMap::at(const Eigen::Vector2d& p) const {
  Corners c;
  if (!corners_of(p, c)) return limit_m_;
  const double low = c.low_left + c.u * (c.low_right - c.low_left),
               high = c.high_left + c.u * (c.high_right - c.high_left);
  return low + c.v * (high - low);
}

Eigen::Vector2d DistanceMap::gradient(const Eigen::Vector2d& p) const {
  Corners c;
  if (!corners_of(p, c)) return Eigen::Vector2d::Zero();
  const double by_u = (1 - c.v) * (c.low_right - c.low_left) + c.v * (c.high_right - c.high_left);
  const double by_v = (1 - c.u) * (c.high_left - c.low_left) + c.u * (c.high_right - c.low_right);
  return Eigen::Vector2d(by_u, by_v) / frame_.resolution_m;
}

}  // namespace smokemap
