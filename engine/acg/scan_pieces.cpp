#include "acg/scan_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kBend_m = 0.06;     ///< a hit this far from the chord begins a new piece
constexpr double kFitRms_m = 0.035;  ///< rougher runs are no walls
constexpr int kMinHits = 5;
constexpr double kHitSigma_m = 0.03;

bool neighbours(const Point2& a, const Point2& b) {
  const double range = std::min(a.norm(), b.norm());
  return (a - b).norm() < 0.12 + 0.09 * range;
}

/// Total least squares through the run; nothing if it is too short or too rough.
void add_piece(std::span<const Point2> run, double min_length_m, std::vector<ScanPiece>& pieces) {
  if (static_cast<int>(run.size()) < kMinHits) return;
  Point2 mean = Point2::Zero();
  for (const Point2& p : run) mean += p;
  mean /= static_cast<double>(run.size());
  double xx = 0, xy = 0, yy = 0;
  for (const Point2& p : run) {
    const Point2 d = p - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  const double heading = 0.5 * std::atan2(2 * xy, xx - yy);
  Point2 u(std::cos(heading), std::sin(heading));
  const Point2 n(-u.y(), u.x());
  double low = 0, high = 0, square = 0;
  for (const Point2& p : run) {
    low = std::min(low, u.dot(p - mean)), high = std::max(high, u.dot(p - mean));
    square += std::pow(n.dot(p - mean), 2);
  }
  if (high - low < min_length_m || std::sqrt(square / static_cast<double>(run.size())) > kFitRms_m) return;
  Segment2 s{mean + low * u, mean + high * u};
  if (signed_line_distance(s, Point2::Zero()) < 0) std::swap(s.a, s.b);
  pieces.push_back({s, static_cast<int>(run.size())});
}

void split(std::span<const Point2> run, double min_length_m, std::vector<ScanPiece>& pieces) {
  if (static_cast<int>(run.size()) < kMinHits) return;
  const Segment2 chord{run.front(), run.back()};
  std::size_t worst = 0;
  double worst_m = kBend_m;
  for (std::size_t i = 1; i + 1 < run.size(); ++i) {
    const double d = chord.length() > 0.05 ? std::abs(signed_line_distance(chord, run[i])) : (run[i] - chord.a).norm();
    if (d > worst_m) worst_m = d, worst = i;
  }
  if (worst == 0) return add_piece(run, min_length_m, pieces);
  split(run.first(worst + 1), min_length_m, pieces);
  split(run.subspan(worst), min_length_m, pieces);
}

std::vector<WallLine> as_walls(const std::vector<ScanPiece>& pieces) {
  std::vector<WallLine> walls;
  for (const ScanPiece& p : pieces) {
    const double independent = std::clamp(p.segment.length() / 0.25, 2.0, static_cast<double>(p.hits));
    walls.push_back({p.segment, p.hits, kHitSigma_m / std::sqrt(independent),
                     kHitSigma_m * std::sqrt(12 / independent) / p.segment.length(), 0});
  }
  return walls;
}

}  // namespace

NodeView view_of(const PoseNode& node, const AcgParams& params) {
  NodeView view;
  view.id = node.id;
  std::vector<Point2> hits;
  if (node.hits_robot)
    for (const Point2& p : *node.hits_robot)
      if (p.allFinite() && p.norm() > 0.05) hits.push_back(p);
  std::stable_sort(hits.begin(), hits.end(), [](const Point2& a, const Point2& b) {
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  // Begin at a break, so that a wall behind the robot is not cut where the angles wrap.
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point2& before = hits[(i + hits.size() - 1) % hits.size()];
    if (neighbours(before, hits[i])) continue;
    std::rotate(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(i), hits.end());
    break;
  }
  std::size_t from = 0;
  for (std::size_t i = 1; i <= hits.size(); ++i) {
    if (i < hits.size() && neighbours(hits[i - 1], hits[i])) continue;
    split(std::span(hits).subspan(from, i - from), params.min_piece_m, view.pieces);
    from = i;
  }
  const auto add_ray = [&](const Point2& p, bool hit) {
    view.rays.push_back({std::atan2(p.y(), p.x()), p.normalized(), p.norm(), hit});
  };
  for (const Point2& p : hits) add_ray(p, true);
  if (node.free_ends_robot)
    for (const Point2& p : *node.free_ends_robot)
      if (p.allFinite() && p.norm() > 0.05) add_ray(p, false);
  std::stable_sort(view.rays.begin(), view.rays.end(),
                   [](const ScanRay& a, const ScanRay& b) { return a.bearing_rad < b.bearing_rad; });
  view.corners = find_corners(as_walls(view.pieces));
  return view;
}

}  // namespace smokemap
