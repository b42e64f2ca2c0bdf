#include "slam/surface_points.hpp"

#include <algorithm>
#include <cmath>

#include "slam/principal_line.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kMostDrawnHits = 360;
constexpr std::size_t kMostDrawnFreeEnds = 90;

/// Hits in beam order, robot frame, straightened.
struct Beams {
  std::vector<Point2> hits;
  std::vector<double> step_m;  ///< distance to the next beam on a wall that is hit square
  std::vector<Point2> drawn;   ///< the hits and those that are not to be matched
  std::vector<Point2> free_ends;
};

Beams read_beams(const LaserScan& scan, const BeamConvention& convention, const Twist2& twist, double farthest_m,
                 const std::vector<BeamUse>& uses) {
  Beams beams;
  const std::size_t count = distinct_beams(scan);
  beams.hits.reserve(count);
  beams.step_m.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const BeamUse use = i < uses.size() ? uses[i] : BeamUse::kAll;
    if (use == BeamUse::kNothing) continue;
    const BeamKind kind = classify(scan.ranges_m[i], scan, convention);
    if (kind == BeamKind::kUnknown) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    const double range = kind == BeamKind::kHit ? static_cast<double>(scan.ranges_m[i]) : farthest_m;
    Point2 p = scan.T_robot_laser * Point2(range * std::cos(angle), range * std::sin(angle));
    if (scan.time_increment_s != 0) p = twist.after(static_cast<double>(i) * scan.time_increment_s) * p;
    if (kind == BeamKind::kFreeToMax) {
      beams.free_ends.push_back(p);
      continue;
    }
    beams.drawn.push_back(p);
    if (use == BeamUse::kDrawing) continue;
    beams.hits.push_back(p);
    beams.step_m.push_back(range * std::abs(scan.angle_increment_rad));
  }
  return beams;
}

/// Indices of the hits that are matched.
std::vector<std::size_t> select(const std::vector<Point2>& hits, const Point2& p_sensor, const PointParams& params) {
  std::vector<std::size_t> chosen;
  for (double spacing = params.spacing_m;; spacing *= 1.4) {
    chosen.clear();
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if ((hits[i] - p_sensor).norm() > params.farthest_m) continue;
      if (chosen.empty() || (hits[i] - hits[chosen.back()]).norm() >= spacing) chosen.push_back(i);
    }
    if (chosen.size() <= static_cast<std::size_t>(params.most_points)) return chosen;
  }
}

/// The surface through hit `i`, from its neighbours in beam order.
SurfacePoint surface_at(const Beams& beams, std::size_t i, const Point2& p_sensor, const PointParams& params) {
  SurfacePoint point;
  point.p = beams.hits[i];
  const double radius = std::max(params.line_radius_m, params.line_steps * beams.step_m[i]);
  PrincipalLine line;
  line.add(point.p);
  for (std::size_t j = i + 1; j < beams.hits.size() && (beams.hits[j] - point.p).norm() <= radius; ++j)
    line.add(beams.hits[j]);
  for (std::size_t j = i; j-- > 0 && (beams.hits[j] - point.p).norm() <= radius;) line.add(beams.hits[j]);
  if (line.count() < 3) return point;
  const PrincipalLine::Fit fit = line.fit();
  if (fit.rms_across_m > params.line_rms_m || fit.rms_along_m < 3 * fit.rms_across_m) return point;
  point.normal = fit.normal;
  if (point.normal.dot(p_sensor - point.p) < 0) point.normal = -point.normal;
  point.p -= point.normal * point.normal.dot(point.p - fit.mean);
  return point;
}

}  // namespace

std::vector<Point2> thin(const std::vector<Point2>& points, double spacing_m, std::size_t most) {
  std::vector<Point2> kept;
  for (double spacing = spacing_m;; spacing *= 1.4) {
    kept.clear();
    for (const Point2& p : points)
      if (kept.empty() || (p - kept.back()).norm() >= spacing) kept.push_back(p);
    if (kept.size() <= most) return kept;
  }
}

ScanPoints surface_points(const LaserScan& scan, const BeamConvention& convention, const Twist2& twist,
                          const PointParams& params, const std::vector<BeamUse>& uses) {
  const Beams beams = read_beams(scan, convention, twist, params.farthest_m, uses);
  const Point2 p_sensor = scan.T_robot_laser.translation();
  ScanPoints points;
  for (const std::size_t i : select(beams.hits, p_sensor, params))
    points.surface.push_back(surface_at(beams, i, p_sensor, params));
  points.hits_robot = std::make_shared<const std::vector<Point2>>(thin(beams.drawn, 0.02, kMostDrawnHits));
  points.free_ends_robot = std::make_shared<const std::vector<Point2>>(thin(beams.free_ends, 0.02, kMostDrawnFreeEnds));
  return points;
}

}  // namespace smokemap
