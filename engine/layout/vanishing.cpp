// Idea: a plan without a visible rim (a close-up, a screen) still shows its perspective: walls and text run along two
// directions of the sheet, each family of lines meets in one point. The lines through those two points that bound all
// of the drawing are a rectangle of the sheet.
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "layout/sheet.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kSeeds = 28;         ///< of the longest lines, each pair is tried
constexpr double kMeetsDeg = 0.6;          ///< a line misses its vanishing point by less
constexpr double kLeastShare = 0.6;        ///< of the family's length must meet there
constexpr double kLeastConvergeDeg = 2.5;  ///< across the picture: less is no perspective
constexpr double kVanishingTrust = 0.6;    ///< a rectangle of the drawing is not the rim of the sheet

struct Pencil {
  cv::Vec3d point;  ///< homogeneous, in coordinates about the picture's middle, over its long side
  double share = 0;
  std::vector<Segment2> lines;
};

cv::Vec3d homogeneous_line(const Segment2& s) {
  const cv::Vec3d l = cv::Vec3d(s.a.x(), s.a.y(), 1).cross(cv::Vec3d(s.b.x(), s.b.y(), 1));
  return l / std::max(1e-12, std::hypot(l[0], l[1]));
}

/// How far the line's direction is from that to the point, seen from its middle.
double misses_by_rad(const Segment2& s, const cv::Vec3d& point) {
  const Point2 m = s.midpoint();
  const Point2 to(point[0] - point[2] * m.x(), point[1] - point[2] * m.y());
  return to.norm() < 1e-12 ? 0 : line_angle_between(std::atan2(to.y(), to.x()), s.heading());
}

std::optional<Pencil> pencil_of(std::vector<Segment2> lines) {
  if (lines.size() < 4) return std::nullopt;
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Segment2& a, const Segment2& b) { return a.length() > b.length(); });
  double all = 0;
  for (const auto& s : lines) all += s.length();
  const auto supporters = [&](const cv::Vec3d& point) {
    double sum = 0;
    for (const auto& s : lines)
      if (misses_by_rad(s, point) < radians(kMeetsDeg)) sum += s.length();
    return sum;
  };
  Pencil best;
  const std::size_t seeds = std::min(lines.size(), kSeeds);
  for (std::size_t i = 0; i < seeds; ++i)
    for (std::size_t j = i + 1; j < seeds; ++j) {
      const cv::Vec3d point = homogeneous_line(lines[i]).cross(homogeneous_line(lines[j]));
      if (cv::norm(point) < 1e-9) continue;
      const double share = supporters(point) / all;
      if (share > best.share) best.share = share, best.point = point / cv::norm(point);
    }
  if (best.share < kLeastShare) return std::nullopt;
  cv::Matx33d normal = cv::Matx33d::zeros();  // the point nearest to all of its lines
  for (const auto& s : lines) {
    if (misses_by_rad(s, best.point) >= radians(kMeetsDeg)) continue;
    best.lines.push_back(s);
    const cv::Vec3d l = homogeneous_line(s);
    normal += s.length() * (l * l.t());
  }
  cv::Vec3d values;
  cv::Matx33d vectors;
  if (best.lines.size() < 4 || !cv::eigen(normal, values, vectors)) return std::nullopt;
  best.point = cv::Vec3d(vectors(2, 0), vectors(2, 1), vectors(2, 2));
  return best;
}

/// The two lines of the pencil that bound all points: the first and last along the axis across the pencil.
std::array<cv::Vec3d, 2> bounds(const Pencil& pencil, const std::vector<Point2>& points, bool rows) {
  std::array<cv::Vec3d, 2> lines;
  double low = 1e300, high = -1e300;
  for (const Point2& p : points) {
    const cv::Vec3d line = pencil.point.cross(cv::Vec3d(p.x(), p.y(), 1));
    const double steep = rows ? line[1] : line[0];
    if (std::abs(steep) < 1e-12) continue;
    const double place = -line[2] / steep;  // where it crosses the middle of the picture
    if (place < low) low = place, lines[0] = line;
    if (place > high) high = place, lines[1] = line;
  }
  return lines;
}

/// Turn of the pencil's lines from one side of the picture to the other.
double convergence_rad(const Pencil& pencil, bool rows) {
  const auto heading_at = [&](const Point2& p) {
    return std::atan2(pencil.point[1] - pencil.point[2] * p.y(), pencil.point[0] - pencil.point[2] * p.x());
  };
  const Point2 half = rows ? Point2(0, 0.35) : Point2(0.35, 0);
  return line_angle_between(heading_at(half), heading_at(-half));
}

}  // namespace

std::optional<SheetProposal> propose_by_vanishing_points(const std::vector<Segment2>& lines_px, cv::Size size) {
  const double side = std::max(size.width, size.height);
  const Point2 middle(0.5 * size.width, 0.5 * size.height);
  std::vector<Segment2> families[2];
  for (const auto& s : lines_px) {
    const Segment2 unit{(s.a - middle) / side, (s.b - middle) / side};
    const double from_x = line_angle_between(unit.heading(), 0);
    if (from_x < radians(35)) families[0].push_back(unit);
    if (from_x > radians(55)) families[1].push_back(unit);
  }
  const auto rows = pencil_of(std::move(families[0])), columns = pencil_of(std::move(families[1]));
  if (!rows || !columns) return std::nullopt;
  if (std::max(convergence_rad(*rows, true), convergence_rad(*columns, false)) < radians(kLeastConvergeDeg))
    return std::nullopt;
  std::vector<Point2> points;
  for (const auto* pencil : {&*rows, &*columns})
    for (const auto& s : pencil->lines) points.push_back(s.a), points.push_back(s.b);
  const auto across = bounds(*rows, points, true), down = bounds(*columns, points, false);
  SheetProposal proposal;
  const std::array<std::pair<int, int>, 4> at{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const cv::Vec3d p =
        across[static_cast<std::size_t>(at[i].first)].cross(down[static_cast<std::size_t>(at[i].second)]);
    if (std::abs(p[2]) < 1e-12) return std::nullopt;
    const Point2 corner(p[0] / p[2], p[1] / p[2]);
    if (!corner.allFinite() || corner.cwiseAbs().maxCoeff() > 1.0) return std::nullopt;
    proposal.corners_px[i] = middle + side * corner;
  }
  proposal.confidence = kVanishingTrust * std::min(rows->share, columns->share);
  return proposal;
}

}  // namespace smokemap
