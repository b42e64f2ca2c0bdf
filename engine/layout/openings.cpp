#include "layout/openings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "layout/doors.hpp"
#include "layout/edit.hpp"
#include "layout/gaps.hpp"
#include "layout/median.hpp"
#include "layout/wall_graph.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

constexpr double kWidestWindow = 0.3;  ///< of the plan's long side
constexpr double kWidestTread = 0.02;  ///< of the plan's long side: lines so close in a row are stairs and shelves
constexpr double kAside = 0.6;         ///< rad, between a wall and a line that leads aside from its end
constexpr double kLined = 0.6;         ///< of a gap no wider than doors are
constexpr double kNarrowing = 1.3;     ///< times as wide as a passage are the spaces on both its sides
constexpr double kWiderDoor = 1.3;     ///< times the usual door
constexpr double kWiderPassage = 1.8;  ///< times the usual door
constexpr double kFramed = 0.8;        ///< of a wide gap must have a frame drawn along it
constexpr double kLeastNib = 0.1;      ///< of a wall's thickness
constexpr double kLeastNibPx = 1.5;

/// Share of the gap along which thin lines run within a wall's width.
/// @param side  -1 or 1: only those to that side of its middle; 0: all
double lined_share(const Segment2& gap, const std::vector<InkStroke>& thin, double thickness_px, int side = 0) {
  std::vector<std::pair<double, double>> lined;
  for (const auto& s : thin) {
    if (line_angle_between(s.axis.heading(), gap.heading()) > radians(6)) continue;
    const double aside = signed_line_distance(gap, s.axis.midpoint());
    if (std::abs(aside) > 0.8 * thickness_px || (side != 0 && side * aside < 0.2 * thickness_px)) continue;
    const double a = std::clamp(along(gap, s.axis.a), 0.0, 1.0), b = std::clamp(along(gap, s.axis.b), 0.0, 1.0);
    lined.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(lined.begin(), lined.end());
  double share = 0, until = 0;
  for (const auto& [from, to] : lined) share += std::max(0.0, to - std::max(from, until)), until = std::max(until, to);
  return share;
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

/// The wall at the place, or -1.
int wall_near(const LayoutMap& map, const Point2& p, double reach_px, int except = -1) {
  int nearest = -1;
  double best = reach_px;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    if (static_cast<int>(w) == except) continue;
    const double d = distance(map.wall_px(static_cast<int>(w)), p);
    if (d < best) best = d, nearest = static_cast<int>(w);
  }
  return nearest;
}

/// Thin lines that lead from a loose end aside to another wall: the front of a closet, a door between two stubs. One to
/// each side: a partition may part two closets.
std::vector<Segment2> lines_from_ends(const LayoutMap& map, const std::vector<InkStroke>& thin, double thickness_px,
                                      double reach_px) {
  const double touch = 1.2 * thickness_px;
  const auto ends = loose_ends(map);
  std::vector<Segment2> lines;
  for (const auto& end : ends) {
    std::array<bool, 2> closed{};
    for (const auto& s : thin) {
      if (s.length() < 2 * thickness_px || s.length() > reach_px) continue;
      const bool from_a = (s.axis.a - end.p).norm() < (s.axis.b - end.p).norm();
      const Point2 foot = from_a ? s.axis.a : s.axis.b, far = from_a ? s.axis.b : s.axis.a;
      const double turn = line_angle_between(s.axis.heading(), std::atan2(end.outward.y(), end.outward.x()));
      const int other = wall_near(map, far, touch, end.wall);
      if ((foot - end.p).norm() > touch || turn < kAside || other < 0) continue;
      Segment2 line{end.p, closest_point(map.wall_px(other), far)};
      for (const auto& stub : ends)
        if (stub.wall == other && (stub.p - far).norm() < touch) line.b = stub.p;
      if (line_angle_between(line.heading(), s.axis.heading()) > radians(12)) continue;
      const Point2 way = line.b - line.a;
      const std::size_t side = end.outward.x() * way.y() - end.outward.y() * way.x() > 0;
      if (closed[side]) continue;
      closed[side] = true;
      const bool known =
          std::any_of(lines.begin(), lines.end(), [&](const Segment2& o) { return o.b == line.a && o.a == line.b; });
      if (!known) lines.push_back(line);
    }
  }
  return lines;
}

bool starts_at(const std::vector<Segment2>& lines, const Point2& p) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const Segment2& s) { return (s.a - p).norm() < 1.5 || (s.b - p).norm() < 1.5; });
}

/// How far it is from the place to the next wall or opening, at most the length of the way.
double free_way(const LayoutMap& map, const Segment2& way) {
  double free = way.length();
  const auto stop = [&](const Segment2& line) {
    if (const auto hit = intersection(way, line)) free = std::min(free, (*hit - way.a).norm());
  };
  for (std::size_t w = 0; w < map.walls.size(); ++w) stop(map.wall_px(static_cast<int>(w)));
  for (const auto& o : map.openings) stop(o.gap_px);
  return free;
}

/// Nothing of the plan lies to that side (-1 or 1) of the middle of the gap.
bool faces_outside(const LayoutMap& map, const Segment2& gap, int side, double far_px) {
  const Point2 away = side * gap.normal(), from = gap.midpoint() + away;
  return free_way(map, {from, from + far_px * away}) >= far_px;
}

/// A window is a wall that people and most lasers do not get through. Of what is wider than windows are, two lines are
/// a frame; one may be a sliding door, or the railing of a terrace if it runs along the outer face of the walls.
void add_window(LayoutMap& map, const Gap& gap, const std::vector<InkStroke>& thin, double thickness_px,
                double reach_px, double confidence) {
  const std::array<bool, 2> lined{lined_share(gap.segment, thin, thickness_px, -1) > kFramed,
                                  lined_share(gap.segment, thin, thickness_px, 1) > kFramed};
  const bool wide = gap.segment.length() >= reach_px, framed = lined[0] && lined[1];
  for (const int side : {-1, 1})
    if (wide && !framed && lined[side > 0] && faces_outside(map, gap.segment, side, 5 * gap.segment.length())) return;
  map.openings.push_back({gap.segment, OpeningKind::kWindow, confidence});
  if (framed || !wide) carry_on(map, gap, thickness_px, confidence);
}

/// Two thin lines as far apart as a wall is thick, from wall to wall: glass.
void add_glazing(LayoutMap& map, const std::vector<InkStroke>& thin, double thickness_px, const LayoutParams& params) {
  std::vector<InkStroke> panes;
  for (const auto& pair : pair_hollow(thin, 1.5 * thickness_px))
    if (pair.thickness_px > 0.5 * thickness_px) panes.push_back(pair);
  for (const auto& pane : merge_collinear(panes, params.merge_angle_deg, 3 * thickness_px)) {
    if (pane.length() < 4 * thickness_px) continue;
    const int a = wall_near(map, pane.axis.a, 1.5 * thickness_px), b = wall_near(map, pane.axis.b, 1.5 * thickness_px);
    if (a < 0 || b < 0 || a == b) continue;
    const Point2 middle = pane.axis.midpoint();
    const bool known = wall_near(map, middle, 1.5 * thickness_px) >= 0 ||
                       std::any_of(map.openings.begin(), map.openings.end(), [&](const LayoutOpening& o) {
                         return distance(o.gap_px, middle) < 1.5 * thickness_px;
                       });
    if (known) continue;
    map.openings.push_back({{closest_point(map.wall_px(a), pane.axis.a), closest_point(map.wall_px(b), pane.axis.b)},
                            OpeningKind::kWindow,
                            0.6});
  }
}

/// How wide the space is along the gap a little way off to one side (-1 or 1); at most `reach_px` each way.
double space_beside(const LayoutMap& map, const Segment2& gap, int side, double reach_px) {
  const Point2 u = gap.direction(), away = side * gap.normal();
  double widest = 0;
  for (const double depth : {0.5, 1.0}) {
    const Point2 from = gap.midpoint() + depth * gap.length() * away;
    widest = std::max(widest, free_way(map, {from, from + reach_px * u}) + free_way(map, {from, from - reach_px * u}));
  }
  return widest;
}

/// Both sides are wider than the gap: a mouth, not the width of a corridor.
bool is_mouth(const LayoutMap& map, const Segment2& gap) {
  const double width = gap.length();
  return std::min(space_beside(map, gap, -1, 2 * width), space_beside(map, gap, 1, 2 * width)) > kNarrowing * width;
}

bool has_opening(const LayoutMap& map, const Segment2& gap, double thickness_px) {
  return std::any_of(map.openings.begin(), map.openings.end(), [&](const LayoutOpening& o) {
    return distance(o.gap_px, gap.midpoint()) < 1.5 * thickness_px || distance(gap, o.gap_px.midpoint()) < thickness_px;
  });
}

/// How far the ink reaches from the place the way given, at most `far_px`; 0 where there is none.
double ink_ahead(const cv::Mat& ink, const Point2& p, const Point2& way, double far_px) {
  double reach = 0;
  for (; reach < far_px; reach += 0.5) {
    const Point2 at = p + reach * way;
    const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
    if (x < 0 || y < 0 || x >= ink.cols || y >= ink.rows || ink.at<uchar>(y, x) == 0) break;
  }
  return reach;
}

/// The wall across the end of a gap stands out into it there, however little: a nib. Walls that carry on or end at a
/// corner do not.
bool has_nib(const cv::Mat& ink, const Point2& foot, const Point2& into, double thickness_px) {
  const double far = 2 * thickness_px;
  const Point2 along(-into.y(), into.x());
  const auto face = [&](double from, double to) {
    std::vector<double> reaches;
    for (double o = from; o <= to; o += 0.2 * thickness_px)
      reaches.push_back(ink_ahead(ink, foot + o * along, into, far));
    return median_of(std::move(reaches));
  };
  const double nib = face(-0.2 * thickness_px, 0.21 * thickness_px);
  const double beside[] = {face(-2.4 * thickness_px, -1.4 * thickness_px),
                           face(1.4 * thickness_px, 2.4 * thickness_px)};
  bool wall_beside = false;
  for (const double wall : beside)
    if (wall > 0) {
      wall_beside = true;
      if (nib < wall + std::max(kLeastNibPx, kLeastNib * thickness_px) || nib >= far) return false;
    }
  return wall_beside;
}

bool between_nibs(const cv::Mat& ink, const Segment2& gap, double thickness_px) {
  return !ink.empty() && has_nib(ink, gap.a, gap.direction(), thickness_px) &&
         has_nib(ink, gap.b, -gap.direction(), thickness_px);
}

/// Openings between walls whose ends meet other walls, as at the corner of a hall: where a leaf stands, where two such
/// ends face each other across a mouth, and between nibs.
/// @param aside  lines that close loose ends already
void add_openings_at_corners(LayoutMap& map, const std::vector<InkStroke>& thin, const std::vector<Segment2>& aside,
                             const cv::Mat& ink, double thickness_px, double reach_px) {
  const auto door = usual_door_width(door_widths(map));
  const double widest_door = door ? std::min(reach_px, kWiderDoor * *door + thickness_px) : reach_px;
  const double widest = door ? std::min(reach_px, kWiderPassage * *door + thickness_px) : reach_px;
  auto ends = joined_ends(map);
  const auto loose = loose_ends(map);
  ends.insert(ends.end(), loose.begin(), loose.end());
  for (const auto& gap : gaps_ahead(map, ends, thickness_px, reach_px)) {
    const double width = gap.segment.length();
    if (width < 1.5 * thickness_px || has_opening(map, gap.segment, thickness_px)) continue;
    if (gap.corner_b < 0 && starts_at(aside, gap.segment.a)) continue;
    const bool mouth = is_mouth(map, gap.segment);
    if (width < widest_door && (mouth || gap.corner_b >= 0) && has_leaf(gap.segment, thin, thickness_px))
      map.openings.push_back({gap.segment, OpeningKind::kDoor, 0.6});
    else if (width < widest && ((gap.corner_b >= 0 && mouth) || between_nibs(ink, gap.segment, thickness_px)))
      map.openings.push_back({gap.segment, OpeningKind::kPassage, 0.4});
  }
}

}  // namespace

void close_gaps(LayoutMap& map, const std::vector<InkStroke>& thin, const cv::Mat& covered, double thickness_px,
                const LayoutParams& params, const cv::Mat& ink) {
  double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
  for (const auto& c : map.corners) {
    low_x = std::min(low_x, c.p_px.x()), high_x = std::max(high_x, c.p_px.x());
    low_y = std::min(low_y, c.p_px.y()), high_y = std::max(high_y, c.p_px.y());
  }
  const double plan = std::max(high_x - low_x, high_y - low_y);
  const double reach =
      std::max(params.max_opening_share * plan, std::min(2.5 * params.max_opening_share * plan, 9 * thickness_px));
  repair_hidden(map, covered, thickness_px, reach);
  const double widest = std::max(reach, kWidestWindow * plan);
  const auto lined = [&](const Gap& gap) { return lined_share(gap.segment, thin, thickness_px); };
  const auto lines = without_ladders(thin, kWidestTread * plan);
  const auto aside = lines_from_ends(map, lines, thickness_px, reach);
  for (const auto& gap : gaps_ahead(map, loose_ends(map), thickness_px, widest)) {
    const bool wide = gap.segment.length() >= reach;
    const bool closed_aside = starts_at(aside, gap.segment.a) || (gap.corner_b >= 0 && starts_at(aside, gap.segment.b));
    if (!wide && !closed_aside && has_leaf(gap.segment, thin, thickness_px)) {
      map.openings.push_back({gap.segment, OpeningKind::kDoor, 0.85});
    } else if (lined(gap) > (wide ? kFramed : kLined)) {
      add_window(map, gap, thin, thickness_px, reach, 0.8);
    } else if (!wide && !closed_aside) {
      map.openings.push_back({gap.segment, OpeningKind::kPassage, 0.5});
    }
  }
  for (const auto& gap : gaps_ahead(map, joined_ends(map), thickness_px, widest))
    if (lined_share(gap.segment, lines, thickness_px) > kFramed) add_window(map, gap, lines, thickness_px, reach, 0.6);
  add_openings_at_corners(map, thin, aside, ink, thickness_px, reach);
  for (const auto& line : aside)
    map.openings.push_back(
        {line, has_leaf(line, thin, thickness_px) ? OpeningKind::kDoor : OpeningKind::kPassage, 0.6});
  add_glazing(map, lines, thickness_px, params);
  map = without_straight_corners(with_degrees(std::move(map)));
}

}  // namespace smokemap
