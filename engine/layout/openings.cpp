#include "layout/openings.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace smokemap {
namespace {

struct LooseEnd {
  int corner = 0;
  int wall = 0;
  Point2 p = Point2::Zero();
  Point2 outward = Point2::Zero();
};

std::vector<LooseEnd> loose_ends(const LayoutMap& map) {
  std::vector<LooseEnd> ends;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    if (s.length() < 1e-9) continue;
    if (map.corners[static_cast<std::size_t>(map.walls[w].corner_a)].degree == 1)
      ends.push_back({map.walls[w].corner_a, static_cast<int>(w), s.a, -s.direction()});
    if (map.corners[static_cast<std::size_t>(map.walls[w].corner_b)].degree == 1)
      ends.push_back({map.walls[w].corner_b, static_cast<int>(w), s.b, s.direction()});
  }
  return ends;
}

struct Gap {
  Segment2 segment;
  int corner_a = -1, corner_b = -1;  ///< -1: lands on a wall between its corners
  double thickness_px = 0;
};

/// The nearest thing straight ahead of a loose end, if it is near enough to be the other side of an opening.
std::vector<Gap> gaps_ahead(const LayoutMap& map, double thickness_px, double reach_px) {
  const auto ends = loose_ends(map);
  std::vector<Gap> gaps;
  std::set<std::pair<int, int>> seen;
  for (const auto& end : ends) {
    const double own = map.walls[static_cast<std::size_t>(end.wall)].thickness_px;
    double best = reach_px;
    Gap gap;
    for (const auto& other : ends) {
      if (other.corner == end.corner || other.outward.dot(end.outward) > -0.97) continue;
      const Point2 d = other.p - end.p;
      const double ahead = d.dot(end.outward), beside = std::abs(d.x() * end.outward.y() - d.y() * end.outward.x());
      if (ahead <= 0 || ahead >= best || beside > 0.7 * std::max(thickness_px, own)) continue;
      best = ahead;
      gap = {{end.p, other.p}, end.corner, other.corner, own};
    }
    const Segment2 ray{end.p + 0.5 * end.outward, end.p + best * end.outward};
    for (std::size_t w = 0; w < map.walls.size(); ++w) {
      if (static_cast<int>(w) == end.wall) continue;
      Segment2 wall = map.wall_px(static_cast<int>(w));
      if (line_angle_between(wall.heading(), ray.heading()) < 0.6) continue;
      const Point2 more = 0.6 * thickness_px * wall.direction();
      wall = {wall.a - more, wall.b + more};
      const auto hit = intersection(ray, wall);
      if (!hit) continue;
      const double ahead = (*hit - end.p).dot(end.outward);
      if (ahead >= best) continue;
      best = ahead;
      gap = {{end.p, *hit}, end.corner, -1, own};
    }
    if (best >= reach_px || best < 1) continue;
    const auto key = std::pair{std::min(gap.corner_a, gap.corner_b), std::max(gap.corner_a, gap.corner_b)};
    if (gap.corner_b >= 0 && !seen.insert(key).second) continue;
    gaps.push_back(gap);
  }
  return gaps;
}

/// Length of the gap along which some thin line runs within a wall's width.
double lined_share(const Segment2& gap, const std::vector<InkStroke>& thin, double thickness_px) {
  double lined = 0;
  for (const auto& s : thin) {
    if (line_angle_between(s.axis.heading(), gap.heading()) > radians(6)) continue;
    if (std::abs(signed_line_distance(gap, s.axis.midpoint())) > 0.8 * thickness_px) continue;
    const double a = std::clamp(along(gap, s.axis.a), 0.0, 1.0), b = std::clamp(along(gap, s.axis.b), 0.0, 1.0);
    lined = std::max(lined, std::abs(b - a));
  }
  return lined;
}

/// A thin line about as long as the gap stands at one of its ends.
bool has_leaf(const Segment2& gap, const std::vector<InkStroke>& thin, double thickness_px) {
  const double width = gap.length();
  return std::any_of(thin.begin(), thin.end(), [&](const InkStroke& s) {
    if (s.length() < 0.5 * width || s.length() > 1.4 * width + thickness_px) return false;
    if (line_angle_between(s.axis.heading(), gap.heading()) < radians(25)) return false;
    for (const Point2& hinge : {gap.a, gap.b})
      for (const Point2& foot : {s.axis.a, s.axis.b})
        if ((hinge - foot).norm() < 0.25 * width + thickness_px) return true;
    return false;
  });
}

}  // namespace

double covered_share(const Segment2& s, const cv::Mat& covered) {
  int inside = 0, all = 0;
  for (double t = 1; t < s.length(); t += 1, ++all) {
    const Point2 p = s.a + t * s.direction();
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (x >= 0 && y >= 0 && x < covered.cols && y < covered.rows && covered.at<uchar>(y, x)) ++inside;
  }
  return all ? static_cast<double>(inside) / all : 0;
}

void close_gaps(LayoutMap& map, const std::vector<InkStroke>& thin, const cv::Mat& covered, double thickness_px,
                const LayoutParams& params) {
  double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
  for (const auto& c : map.corners) {
    low_x = std::min(low_x, c.p_px.x()), high_x = std::max(high_x, c.p_px.x());
    low_y = std::min(low_y, c.p_px.y()), high_y = std::max(high_y, c.p_px.y());
  }
  const double plan = std::max(high_x - low_x, high_y - low_y);
  const double reach =
      std::max(params.max_opening_share * plan, std::min(2.5 * params.max_opening_share * plan, 9 * thickness_px));
  for (const auto& gap : gaps_ahead(map, thickness_px, reach)) {
    if (covered_share(gap.segment, covered) > 0.55) {
      int b = gap.corner_b;
      if (b < 0) {
        b = static_cast<int>(map.corners.size());
        map.corners.push_back({gap.segment.b, 1, 0.5});
      }
      map.walls.push_back({gap.corner_a, b, gap.thickness_px, 0.5, false});
      map.corners[static_cast<std::size_t>(gap.corner_a)].degree += 1;
      map.corners[static_cast<std::size_t>(b)].degree += 1;
      continue;
    }
    LayoutOpening opening;
    opening.gap_px = gap.segment;
    if (has_leaf(gap.segment, thin, thickness_px)) {
      opening.kind = OpeningKind::kDoor, opening.confidence = 0.85;
    } else if (lined_share(gap.segment, thin, thickness_px) > 0.6) {
      opening.kind = OpeningKind::kWindow, opening.confidence = 0.8;
    } else {
      opening.kind = OpeningKind::kPassage, opening.confidence = 0.5;
    }
    map.openings.push_back(opening);
  }
}

}  // namespace smokemap
