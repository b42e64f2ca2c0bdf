#include "slam/surface_map.hpp"

#include <algorithm>
#include <limits>

namespace smokemap {

void SurfaceMap::reset(const Point2& center, double half_size_m) {
  const int side = std::max(1, static_cast<int>(std::ceil(2 * half_size_m / cell_m_)));
  if (side != side_) {
    side_ = side;
    heads_.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), -1);
  } else {
    for (const Average& a : cells_) heads_[static_cast<std::size_t>(a.cell)] = -1;
  }
  cells_.clear();
  // Whole multiples of the cell: averages do not depend on where the map is centred.
  low_ = ((center.array() - half_size_m) / cell_m_).floor() * cell_m_;
}

bool SurfaceMap::covers(const Point2& p, double margin_m) const {
  const Point2 d = p - low_;
  const double high = side_ * cell_m_ - margin_m;
  return side_ > 0 && d.x() >= margin_m && d.y() >= margin_m && d.x() <= high && d.y() <= high;
}

void SurfaceMap::add(const std::vector<SurfacePoint>& points, const Pose2& T_map_points) {
  const Eigen::Matrix2d R = T_map_points.rotation();
  for (const SurfacePoint& point : points) {
    if (!point.oriented()) continue;
    const Point2 p = R * point.p + T_map_points.translation(), n = R * point.normal;
    const int x = column(p.x()), y = row(p.y());
    if (x < 0 || y < 0 || x >= side_ || y >= side_) continue;
    const std::int32_t cell = y * side_ + x;
    // Quarters are turned by 22.5 degrees: walls mostly run along the axes, and must not sit on a border.
    const double turned = std::atan2(n.y(), n.x()) + kPi + kPi / 8;
    const auto quarter = static_cast<std::int32_t>(turned / (kPi / 2)) % 4;
    std::int32_t at = heads_[static_cast<std::size_t>(cell)];
    while (at >= 0 && cells_[static_cast<std::size_t>(at)].quarter != quarter)
      at = cells_[static_cast<std::size_t>(at)].next;
    if (at < 0) {
      at = static_cast<std::int32_t>(cells_.size());
      cells_.push_back(
          {Point2::Zero(), Point2::Zero(), p, n, 0, heads_[static_cast<std::size_t>(cell)], cell, quarter});
      heads_[static_cast<std::size_t>(cell)] = at;
    }
    Average& average = cells_[static_cast<std::size_t>(at)];
    average.sum += point.weight * p;
    average.normal_sum += point.weight * n;
    average.weight += point.weight;
    average.p = average.sum / average.weight;
    average.normal = average.normal_sum.normalized();
  }
}

bool SurfaceMap::nearest(const Point2& p, const Point2& normal, double gate_m, double least_cosine,
                         Surface& found) const {
  const int x = column(p.x()), y = row(p.y());
  const int rings = static_cast<int>(std::ceil(gate_m / cell_m_));
  const bool any_direction = normal.squaredNorm() < 0.5;
  double best = gate_m * gate_m;
  const Average* nearest = nullptr;
  const auto look = [&](int cx, int cy) {
    if (cx < 0 || cy < 0 || cx >= side_ || cy >= side_) return;
    const int cell = cy * side_ + cx;
    for (std::int32_t at = heads_[static_cast<std::size_t>(cell)]; at >= 0;) {
      const Average& a = cells_[static_cast<std::size_t>(at)];
      at = a.next;
      const double squared = (a.p - p).squaredNorm();
      if (squared >= best || (!any_direction && a.normal.dot(normal) < least_cosine)) continue;
      best = squared;
      nearest = &a;
    }
  };
  for (int ring = 0; ring <= rings; ++ring) {
    // Everything in this ring is at least ring - 1 whole cells away.
    const double least = std::max(0, ring - 1) * cell_m_;
    if (least * least > best) break;
    if (ring == 0) look(x, y);
    for (int d = -ring; ring > 0 && d <= ring; ++d) {
      look(x + d, y - ring);
      look(x + d, y + ring);
      if (d == -ring || d == ring) continue;
      look(x - ring, y + d);
      look(x + ring, y + d);
    }
  }
  if (!nearest) return false;
  found = {nearest->p, nearest->normal, nearest->weight};
  return true;
}

}  // namespace smokemap
