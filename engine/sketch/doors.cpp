#include "sketch/doors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kStep = 0.006;         ///< strokes are looked at in steps of this share of the extent
constexpr double kLeastRadius = 0.045;  ///< of the extent
constexpr double kMostRadius = 0.2;
constexpr double kMostOff = 0.07;  ///< root mean square distance from the circle, in radii
constexpr double kAtHinge = 0.35;  ///< a hand misses the centre by as much, in radii
constexpr double kAtWall = 0.25;   ///< and the jamb by as much
constexpr double kLeastSweep_deg = 55, kMostSweep_deg = 125;
constexpr double kCorner_deg = 60;  ///< a stroke that turns more within three steps has a corner there

struct Circle {
  Point2 centre = Point2::Zero();
  double radius = 0;
};

/// Points every `step` along a stroke, ends included.
std::vector<Point2> resampled(const std::vector<Point2>& points, double step) {
  if (points.empty()) return {};
  std::vector<Point2> out{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point2 d = points[i + 1] - points[i];
    const int pieces = std::max(1, static_cast<int>(std::lround(d.norm() / step)));
    for (int k = 1; k <= pieces; ++k) out.push_back(points[i] + d * (static_cast<double>(k) / pieces));
  }
  return out;
}

/// Parts a stroke where it turns sharply: at the sharpest place of each turn.
std::vector<std::vector<Point2>> parted_at_corners(const std::vector<Point2>& points) {
  const std::size_t n = points.size(), reach = 2;
  std::vector<double> turn(n, 0);
  for (std::size_t i = reach; i + reach < n; ++i) {
    const Point2 in = points[i] - points[i - reach], out = points[i + reach] - points[i];
    if (in.norm() > 0 && out.norm() > 0)
      turn[i] = std::abs(wrap_angle(std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x())));
  }
  std::vector<std::vector<Point2>> parts(1);
  for (std::size_t i = 0; i < n; ++i) {
    parts.back().push_back(points[i]);
    bool is_corner = turn[i] > radians(kCorner_deg);
    for (std::size_t k = i >= reach ? i - reach : 0; is_corner && k <= std::min(n - 1, i + reach); ++k)
      is_corner = turn[k] < turn[i] || (turn[k] == turn[i] && k >= i);
    if (is_corner) parts.push_back({points[i]});
  }
  return parts;
}

/// Least squares (Kasa): x^2 + y^2 = 2 a x + 2 b y + c.
std::optional<Circle> fit_circle(const std::vector<Point2>& points) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  const Point2& origin = points.front();  // for the sake of digits
  for (const Point2& point : points) {
    const Point2 p = point - origin;
    const Eigen::Vector3d row(2 * p.x(), 2 * p.y(), 1);
    A += row * row.transpose();
    rhs += row * p.squaredNorm();
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(A);
  if (!lu.isInvertible()) return std::nullopt;
  const Eigen::Vector3d x = lu.solve(rhs);
  const double square = x.z() + x.head<2>().squaredNorm();
  if (!(square > 0)) return std::nullopt;
  return Circle{origin + x.head<2>(), std::sqrt(square)};
}

/// The circle if the points are about a quarter of it.
std::optional<Circle> as_arc(const std::vector<Point2>& points, double extent_px) {
  if (points.size() < 5) return std::nullopt;
  const auto circle = fit_circle(points);
  if (!circle || circle->radius < kLeastRadius * extent_px || circle->radius > kMostRadius * extent_px)
    return std::nullopt;
  double off = 0, sweep = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2 d = points[i] - circle->centre;
    off += std::pow(d.norm() - circle->radius, 2);
    if (i == 0) continue;
    const Point2 before = points[i - 1] - circle->centre;
    sweep += wrap_angle(std::atan2(d.y(), d.x()) - std::atan2(before.y(), before.x()));
  }
  off = std::sqrt(off / static_cast<double>(points.size()));
  const bool is_quarter = std::abs(sweep) > radians(kLeastSweep_deg) && std::abs(sweep) < radians(kMostSweep_deg);
  return is_quarter && off < kMostOff * circle->radius ? circle : std::nullopt;
}

class DoorFinder {
 public:
  DoorFinder(const std::vector<Stroke>& walls, double extent_px) : walls_(walls), extent_px_(extent_px) {
    for (std::size_t s = 0; s < walls.size(); ++s)
      for (auto& part : parted_at_corners(resampled(walls[s].points_px, kStep * extent_px)))
        if (part.size() > 1) parts_.push_back({s, std::move(part), false});
  }

  DrawnDoors run() {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (const auto circle = as_arc(parts_[i].points, extent_px_)) try_arc(i, *circle);
    return result();
  }

 private:
  struct Part {
    std::size_t stroke = 0;
    std::vector<Point2> points;
    bool is_mark = false;
  };
  struct Place {
    Point2 p = Point2::Zero();
    double away = std::numeric_limits<double>::infinity();
  };

  /// Nearest place of a wall, but for two parts.
  Place wall_near(const Point2& p, std::size_t arc, std::optional<std::size_t> leaf) const {
    Place best;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i == arc || i == leaf || parts_[i].is_mark) continue;
      for (std::size_t k = 0; k + 1 < parts_[i].points.size(); ++k) {
        const Point2 q = closest_point({parts_[i].points[k], parts_[i].points[k + 1]}, p);
        if ((q - p).norm() < best.away) best = {q, (q - p).norm()};
      }
    }
    return best;
  }

  /// A straight part from the centre to one end of the arc.
  std::optional<std::size_t> leaf_to(const Point2& tip, const Circle& circle, std::size_t arc) const {
    const double near = kAtHinge * circle.radius;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i == arc || parts_[i].is_mark) continue;
      const Point2 &a = parts_[i].points.front(), &b = parts_[i].points.back();
      const bool fits = ((a - tip).norm() < near && (b - circle.centre).norm() < near) ||
                        ((b - tip).norm() < near && (a - circle.centre).norm() < near);
      double off = 0;
      for (const Point2& p : parts_[i].points) off = std::max(off, distance({a, b}, p));
      if (fits && off < 0.1 * circle.radius) return i;
    }
    return std::nullopt;
  }

  void try_arc(std::size_t arc, const Circle& circle) {
    const Point2 ends[2] = {parts_[arc].points.front(), parts_[arc].points.back()};
    std::optional<std::size_t> best_leaf;
    Place best_jamb, best_hinge;
    for (int shut = 0; shut < 2; ++shut) {
      const auto leaf = leaf_to(ends[1 - shut], circle, arc);
      const Place jamb = wall_near(ends[shut], arc, leaf), hinge = wall_near(circle.centre, arc, leaf);
      const bool fits = jamb.away < kAtWall * circle.radius && hinge.away < kAtHinge * circle.radius &&
                        (jamb.p - hinge.p).norm() > 0.5 * circle.radius;
      const bool is_better =
          (leaf && !best_leaf) || (leaf.has_value() == best_leaf.has_value() && jamb.away < best_jamb.away);
      if (fits && is_better) best_leaf = leaf, best_jamb = jamb, best_hinge = hinge;
    }
    if (!std::isfinite(best_jamb.away)) return;
    parts_[arc].is_mark = true;
    if (best_leaf) parts_[*best_leaf].is_mark = true;
    openings_.push_back({best_hinge.p, best_jamb.p});
  }

  DrawnDoors result() {
    DrawnDoors doors;
    doors.openings_px = std::move(openings_);
    for (std::size_t s = 0, i = 0; s < walls_.size(); ++s) {
      std::vector<Part> of_stroke;
      for (; i < parts_.size() && parts_[i].stroke == s; ++i) of_stroke.push_back(std::move(parts_[i]));
      const bool is_whole = std::none_of(of_stroke.begin(), of_stroke.end(), [](const Part& p) { return p.is_mark; });
      if (is_whole) {
        doors.walls.push_back(walls_[s]);
        continue;
      }
      for (Part& part : of_stroke) {
        Stroke piece = walls_[s];
        piece.points_px = std::move(part.points);
        if (part.is_mark) piece.kind = StrokeKind::kDoor;
        (part.is_mark ? doors.marks : doors.walls).push_back(std::move(piece));
      }
    }
    return doors;
  }

  const std::vector<Stroke>& walls_;
  double extent_px_;
  std::vector<Part> parts_;  ///< stroke by stroke
  std::vector<Segment2> openings_;
};

}  // namespace

DrawnDoors find_drawn_doors(const std::vector<Stroke>& walls, double extent_px) {
  if (!(extent_px > 0)) return {walls, {}, {}};
  return DoorFinder(walls, extent_px).run();
}

}  // namespace smokemap
