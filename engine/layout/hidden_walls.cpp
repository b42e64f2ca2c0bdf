// Idea: a sign hides what is drawn below it, but walls do not end at signs. Straight runs are joined first, then
// corners, then walls that end on another one, which may have been joined just before.
#include <algorithm>
#include <cmath>
#include <optional>

#include "layout/edit.hpp"
#include "layout/gaps.hpp"

namespace smokemap {
namespace {

constexpr double kHiddenConfidence = 0.5;
constexpr double kHiddenShare = 0.55;  ///< of the missing piece must lie under signs
constexpr double kLeastTurn = 0.5;     ///< rad, between the walls of a hidden corner

void join(LayoutMap& map, int a, int b, double thickness_px, double confidence) {
  if (a == b) return;
  map.walls.push_back({a, b, thickness_px, confidence, false});
  map.corners[static_cast<std::size_t>(a)].degree += 1;
  map.corners[static_cast<std::size_t>(b)].degree += 1;
}

void add_hidden(LayoutMap& map, int a, int b, double thickness_px) { join(map, a, b, thickness_px, kHiddenConfidence); }

/// The corner at a place of a wall: one of its ends if near, else the wall is cut there.
int corner_on_wall(LayoutMap& map, int wall, const Point2& p, double near_px) {
  const LayoutWall whole = map.walls[static_cast<std::size_t>(wall)];
  for (const int c : {whole.corner_a, whole.corner_b})
    if ((map.corners[static_cast<std::size_t>(c)].p_px - p).norm() < near_px) return c;
  const int middle = static_cast<int>(map.corners.size());
  map.corners.push_back({closest_point(map.wall_px(wall), p), 2, kHiddenConfidence});
  LayoutWall rest = whole;
  rest.corner_a = middle;
  map.walls[static_cast<std::size_t>(wall)].corner_b = middle;
  map.walls.push_back(rest);
  return middle;
}

struct HiddenCorner {
  LooseEnd one, two;
  Point2 meeting = Point2::Zero();
  double length_px = 0;  ///< of both missing pieces
};

/// How far ahead of the end the place lies; negative behind it.
double ahead_of(const LooseEnd& end, const Point2& p) { return (p - end.p).dot(end.outward); }

/// The missing piece is short, or a sign lies over it.
bool is_hidden(const Point2& from, const Point2& to, const cv::Mat& covered, double thickness_px) {
  return (to - from).norm() < 1.5 * thickness_px || covered_share({from, to}, covered) > kHiddenShare;
}

std::optional<HiddenCorner> corner_between(const LooseEnd& one, const LooseEnd& two, const cv::Mat& covered,
                                           double thickness_px, double reach_px) {
  const double turn =
      line_angle_between(std::atan2(one.outward.y(), one.outward.x()), std::atan2(two.outward.y(), two.outward.x()));
  if (turn < kLeastTurn || one.wall == two.wall) return std::nullopt;
  const auto meeting = line_intersection({one.p, one.p + one.outward}, {two.p, two.p + two.outward});
  if (!meeting) return std::nullopt;
  const double d1 = ahead_of(one, *meeting), d2 = ahead_of(two, *meeting);
  if (std::min(d1, d2) < -thickness_px || std::max(d1, d2) > reach_px || d1 + d2 < 1) return std::nullopt;
  if (!is_hidden(one.p, *meeting, covered, thickness_px) || !is_hidden(two.p, *meeting, covered, thickness_px))
    return std::nullopt;
  const int x = static_cast<int>(std::lround(meeting->x())), y = static_cast<int>(std::lround(meeting->y()));
  const bool below_sign = x >= 0 && y >= 0 && x < covered.cols && y < covered.rows && covered.at<uchar>(y, x);
  if (!below_sign && std::max(d1, d2) > 1.5 * thickness_px) return std::nullopt;
  return HiddenCorner{one, two, *meeting, std::abs(d1) + std::abs(d2)};
}

void join_in_line(LayoutMap& map, const cv::Mat& covered, double thickness_px, double reach_px) {
  for (const auto& gap : gaps_ahead(map, loose_ends(map), thickness_px, reach_px))
    if (gap.corner_b >= 0 && covered_share(gap.segment, covered) > kHiddenShare)
      add_hidden(map, gap.corner_a, gap.corner_b, gap.thickness_px);
}

void join_corners(LayoutMap& map, const cv::Mat& covered, double thickness_px, double reach_px) {
  const auto ends = loose_ends(map);
  std::vector<HiddenCorner> found;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j)
      if (const auto corner = corner_between(ends[i], ends[j], covered, thickness_px, reach_px))
        found.push_back(*corner);
  std::stable_sort(found.begin(), found.end(),
                   [](const HiddenCorner& a, const HiddenCorner& b) { return a.length_px < b.length_px; });
  for (const auto& corner : found) {
    const auto is_loose = [&](const LooseEnd& end) {
      return map.corners[static_cast<std::size_t>(end.corner)].degree == 1;
    };
    if (!is_loose(corner.one) || !is_loose(corner.two)) continue;
    const auto& [one, two, meeting, length] = corner;
    const double thickness = map.walls[static_cast<std::size_t>(one.wall)].thickness_px;
    // The end next to the corner is moved there; a longer missing piece is a wall of its own.
    const LooseEnd& near = ahead_of(one, meeting) <= ahead_of(two, meeting) ? one : two;
    const LooseEnd& far = &near == &one ? two : one;
    int at = near.corner;
    if (ahead_of(near, meeting) < 1.5 * thickness_px) {
      map.corners[static_cast<std::size_t>(at)].p_px = meeting;
    } else {
      at = static_cast<int>(map.corners.size());
      map.corners.push_back({meeting, 0, kHiddenConfidence});
      add_hidden(map, near.corner, at, thickness);
    }
    add_hidden(map, far.corner, at, map.walls[static_cast<std::size_t>(far.wall)].thickness_px);
  }
}

void join_to_walls(LayoutMap& map, const cv::Mat& covered, double thickness_px, double reach_px) {
  for (const auto& gap : gaps_ahead(map, loose_ends(map), thickness_px, reach_px))
    if (gap.wall_b >= 0 && covered_share(gap.segment, covered) > kHiddenShare)
      carry_on(map, gap, thickness_px, kHiddenConfidence);
}

}  // namespace

void carry_on(LayoutMap& map, const Gap& gap, double thickness_px, double confidence) {
  if (gap.corner_b >= 0) return join(map, gap.corner_a, gap.corner_b, gap.thickness_px, confidence);
  // An earlier cut may have left the place to the second half of the wall.
  int wall = gap.wall_b;
  for (std::size_t w = 0; w < map.walls.size(); ++w)
    if (distance(map.wall_px(static_cast<int>(w)), gap.segment.b) < distance(map.wall_px(wall), gap.segment.b) - 1e-6)
      wall = static_cast<int>(w);
  join(map, gap.corner_a, corner_on_wall(map, wall, gap.segment.b, thickness_px), gap.thickness_px, confidence);
}

void repair_hidden(LayoutMap& map, const cv::Mat& covered, double thickness_px, double reach_px) {
  join_in_line(map, covered, thickness_px, reach_px);
  join_corners(map, covered, thickness_px, reach_px);
  join_to_walls(map, covered, thickness_px, reach_px);
  map = with_degrees(std::move(map));
}

}  // namespace smokemap
