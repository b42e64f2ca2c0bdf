#include "layout/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace smokemap {
namespace {

constexpr double kCarriesOn = 0.7;  ///< cosine of the turn between two walls of which one carries on the other
constexpr double kStub = 4;         ///< times its thickness: where a shorter wall was joined may have turned it
constexpr double kTurned = 0.45;    ///< rad, at most

/// The way the wall would go on from an end. A stub goes on square to, or along, the longest wall that it was joined
/// to.
Point2 way_on(const LayoutMap& map, std::size_t wall, bool at_b) {
  const Segment2 s = map.wall_px(static_cast<int>(wall));
  const Point2 drawn = at_b ? s.direction() : Point2(-s.direction());
  const LayoutWall& stub = map.walls[wall];
  if (s.length() > kStub * stub.thickness_px) return drawn;
  const int joined = at_b ? stub.corner_a : stub.corner_b;
  Segment2 longest = s;
  for (std::size_t j = 0; j < map.walls.size(); ++j) {
    const Segment2 other = map.wall_px(static_cast<int>(j));
    const bool meets = map.walls[j].corner_a == joined || map.walls[j].corner_b == joined;
    if (j != wall && meets && other.length() > 2 * longest.length()) longest = other;
  }
  const Point2 u = longest.direction(), n = longest.normal();
  for (const Point2& way : {u, Point2(-u), n, Point2(-n)})
    if (way.dot(drawn) > std::cos(kTurned)) return way;
  return drawn;
}

}  // namespace

std::vector<LooseEnd> loose_ends(const LayoutMap& map) {
  std::vector<LooseEnd> ends;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    if (s.length() < 1e-9) continue;
    if (map.corners[static_cast<std::size_t>(map.walls[w].corner_a)].degree == 1)
      ends.push_back({map.walls[w].corner_a, static_cast<int>(w), s.a, way_on(map, w, false)});
    if (map.corners[static_cast<std::size_t>(map.walls[w].corner_b)].degree == 1)
      ends.push_back({map.walls[w].corner_b, static_cast<int>(w), s.b, way_on(map, w, true)});
  }
  return ends;
}

std::vector<LooseEnd> joined_ends(const LayoutMap& map) {
  std::vector<LooseEnd> ends;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    if (s.length() < 1e-9) continue;
    for (const bool at_b : {false, true}) {
      const int corner = at_b ? map.walls[w].corner_b : map.walls[w].corner_a;
      const Point2 outward = at_b ? s.direction() : Point2(-s.direction());
      bool alone = true, carried_on = false;
      for (std::size_t j = 0; j < map.walls.size(); ++j) {
        const auto& other = map.walls[j];
        if (j == w || (other.corner_a != corner && other.corner_b != corner)) continue;
        const Segment2 o = map.wall_px(static_cast<int>(j));
        alone = false;
        carried_on |= (other.corner_a == corner ? o.direction() : Point2(-o.direction())).dot(outward) > kCarriesOn;
      }
      if (!alone && !carried_on) ends.push_back({corner, static_cast<int>(w), at_b ? s.b : s.a, outward});
    }
  }
  return ends;
}

std::vector<Gap> gaps_ahead(const LayoutMap& map, const std::vector<LooseEnd>& ends, double thickness_px,
                            double reach_px) {
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
      gap = {{end.p, other.p}, end.corner, other.corner, -1, own};
    }
    const Segment2 ray{end.p + 0.5 * end.outward, end.p + best * end.outward};
    for (std::size_t w = 0; w < map.walls.size(); ++w) {
      if (static_cast<int>(w) == end.wall || map.walls[w].corner_a == end.corner || map.walls[w].corner_b == end.corner)
        continue;
      const Segment2 drawn = map.wall_px(static_cast<int>(w));
      Segment2 wall = drawn;
      if (line_angle_between(wall.heading(), ray.heading()) < 0.6) continue;
      const Point2 more = 0.6 * thickness_px * wall.direction();
      wall = {wall.a - more, wall.b + more};
      const auto hit = intersection(ray, wall);
      if (!hit) continue;
      const double ahead = (*hit - end.p).dot(end.outward);
      if (ahead >= best) continue;
      best = ahead;
      gap = {{end.p, closest_point(drawn, *hit)}, end.corner, -1, static_cast<int>(w), own};
    }
    if (best >= reach_px || best < 1) continue;
    const auto key = std::pair{std::min(gap.corner_a, gap.corner_b), std::max(gap.corner_a, gap.corner_b)};
    if (gap.corner_b >= 0 && !seen.insert(key).second) continue;
    gaps.push_back(gap);
  }
  return gaps;
}

double covered_share(const Segment2& s, const cv::Mat& mask) {
  int inside = 0, all = 0;
  for (double t = 1; t < s.length(); t += 1, ++all) {
    const Point2 p = s.a + t * s.direction();
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x)) ++inside;
  }
  return all ? static_cast<double>(inside) / all : 0;
}

}  // namespace smokemap
