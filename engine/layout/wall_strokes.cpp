#include "layout/wall_strokes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "layout/drawings.hpp"
#include "layout/thickness_classes.hpp"

namespace smokemap {
namespace {

constexpr double kHollowShare = 0.3;     ///< of the long lines in pairs: from here on single lines are no walls
constexpr double kWindowReach = 2.5;     ///< times the widest door: how far a post may be from the wall it carries on
constexpr double kLeastOfFirst = 0.2;    ///< of the area of the first reading: smaller is only a part of that drawing
constexpr double kAlikeThickness = 0.3;  ///< in the logarithm of thickness
constexpr double kPostReach = 10;        ///< times what strokes that carry on each other may be apart: windows
constexpr double kLeastPart = 0.02;      ///< of the score of the drawing's best part: less is a word or a bar
constexpr double kSlender = 15;          ///< times its thickness
constexpr double kMuchThinner = 0.35;    ///< than the usual wall
constexpr double kFewThin = 0.15;        ///< of the walls' length
constexpr double kClosed = 1.5;          ///< times an outline's thickness: solid, or two lines that blur made one

std::vector<InkStroke> pick(const std::vector<InkStroke>& strokes, const std::vector<std::size_t>& members) {
  std::vector<InkStroke> picked;
  picked.reserve(members.size());
  for (const std::size_t i : members) picked.push_back(strokes[i]);
  return picked;
}

/// Length of what is too long for letters, leaves and signs.
double long_length(const std::vector<InkStroke>& strokes, double side_px) {
  return std::accumulate(strokes.begin(), strokes.end(), 0.0, [&](double sum, const InkStroke& s) {
    return sum + (s.length() > 0.025 * side_px ? s.length() : 0);
  });
}

/// Short strokes that lie in the body of a longer one, a little askew: the rounded end of a wall, the foot of an arc.
std::vector<InkStroke> without_echoes(const std::vector<InkStroke>& strokes) {
  std::vector<InkStroke> kept;
  for (const auto& s : strokes) {
    const bool echo = std::any_of(strokes.begin(), strokes.end(), [&](const InkStroke& o) {
      const double body = o.thickness_px + 1;
      return o.length() > 1.3 * s.length() && o.coverage > s.coverage - 0.2 &&
             line_angle_between(o.axis.heading(), s.axis.heading()) < radians(35) &&
             distance(o.axis, s.axis.a) < body && distance(o.axis, s.axis.b) < body;
    });
    if (!echo) kept.push_back(s);
  }
  return kept;
}

/// Blocks as long as wide are columns, signs or letters, unless they carry on another wall.
std::vector<InkStroke> without_blocks(const std::vector<InkStroke>& strokes, double reach_px) {
  std::vector<InkStroke> kept;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const auto& s = strokes[i];
    const bool carries_on = std::any_of(strokes.begin(), strokes.end(), [&](const InkStroke& o) {
      return &o != &s && o.length() > 1.3 * o.thickness_px &&
             line_angle_between(o.axis.heading(), s.axis.heading()) < radians(6) &&
             std::abs(signed_line_distance(o.axis, s.axis.midpoint())) < 0.5 * o.thickness_px + 1 &&
             gap_between(o.axis, s.axis) < reach_px && s.thickness_px < 1.6 * o.thickness_px;
    });
    if (s.length() >= 1.6 * s.thickness_px || (carries_on && s.length() >= 0.7 * s.thickness_px)) kept.push_back(s);
  }
  return kept;
}

/// Gray blocks (signs on a copy without colour, shaded areas) are not as dark as the walls. What is many times longer
/// than thick is no block: fronts are hatched or dotted beside black partitions.
std::vector<InkStroke> dark_enough(const std::vector<InkStroke>& strokes) {
  std::vector<std::pair<double, double>> darkness;
  for (const auto& s : strokes) darkness.emplace_back(s.darkness, s.length());
  const double usual = weighted_quantile(darkness, 0.6);
  std::vector<InkStroke> kept;
  for (const auto& s : strokes)
    if (s.darkness > (s.thickness_px < 5 ? 0.5 : s.length() < kSlender * s.thickness_px ? 0.75 : 0.3) * usual)
      kept.push_back(s);
  return kept;
}

bool half_of_a_pair(const InkStroke& s, const std::vector<InkStroke>& pairs) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const InkStroke& p) {
    return line_angle_between(p.axis.heading(), s.axis.heading()) < radians(4) &&
           distance(p.axis, s.axis.midpoint()) < 0.6 * p.thickness_px;
  });
}

/// How a plan draws hollow walls.
struct HollowStyle {
  double share = 0;       ///< of the long lines that are outlines of hollow walls, or such walls closed by blur
  double usual_px = 0;    ///< thickness of the walls
  double widest_px = 0;   ///< of the thick ones
  double outline_px = 0;  ///< of their two lines; thicker single lines are solid walls, or hollow ones closed by blur
};

HollowStyle hollow_style(const std::vector<InkStroke>& pairs, const std::vector<InkStroke>& lines, double side_px) {
  HollowStyle style;
  std::vector<std::pair<double, double>> spacing, outlines;
  for (const auto& p : pairs) spacing.emplace_back(p.thickness_px, p.length());
  for (const auto& s : lines)
    if (half_of_a_pair(s, pairs)) outlines.emplace_back(s.thickness_px, s.length());
  style.usual_px = weighted_quantile(spacing, 0.5);
  style.widest_px = std::min(weighted_quantile(spacing, 0.9), 2.5 * style.usual_px);
  style.outline_px = weighted_quantile(outlines, 0.5);
  const double all = long_length(lines, side_px), paired = 2 * long_length(pairs, side_px);
  if (all <= 0) return style;
  style.share = paired / all;
  if (style.share < 0.15) return style;
  std::vector<InkStroke> closed;
  for (const auto& s : lines)
    if (s.thickness_px > kClosed * style.outline_px && s.thickness_px < 1.35 * style.usual_px &&
        !half_of_a_pair(s, pairs))
      closed.push_back(s);
  style.share += long_length(closed, side_px) / all;
  return style;
}

/// Where a plan draws some walls as two lines, those two lines become one.
std::vector<InkStroke> with_pairs_joined(const std::vector<InkStroke>& strokes, const std::vector<InkStroke>& pairs) {
  std::vector<InkStroke> joined = pairs;
  for (const auto& s : strokes)
    if (!half_of_a_pair(s, pairs)) joined.push_back(s);
  return joined;
}

/// The region that a person pointed at: the best of those around the place.
const StrokeRegion& region_at(const std::vector<StrokeRegion>& regions, const std::optional<Point2>& at) {
  if (at)
    for (const auto& region : regions)
      if (region.score() > 0 && (region.low.array() <= at->array()).all() && (region.high.array() >= at->array()).all())
        return region;
  return regions.front();
}

/// The best drawing, or the one at the place.
void take_drawing(WallStrokes& out, std::vector<Drawing> drawings, const std::optional<Point2>& at) {
  const std::size_t chosen = at ? drawing_at(drawings, *at) : 0;
  out.walls.clear();
  for (std::size_t d = 0; d < drawings.size(); ++d) {
    const double share = drawings.front().score > 0 ? drawings[d].score / drawings.front().score : 1;
    out.drawings.push_back({drawings[d].low, drawings[d].high, std::clamp(share, 0.0, 1.0), d == chosen});
    if (d == chosen) out.walls = std::move(drawings[d].walls);
  }
}

/// Moves a few lines much thinner than all other walls, the fronts of cupboards, from the walls to the thin lines.
/// Where such lines are many they are the partitions.
void part_off_few_thin(WallStrokes& out) {
  std::vector<std::pair<double, double>> thickness;
  double all = 0, thin = 0;
  for (const auto& s : out.walls) thickness.emplace_back(s.thickness_px, s.length()), all += s.length();
  const double limit = kMuchThinner * weighted_quantile(thickness, 0.5);
  for (const auto& s : out.walls) thin += s.thickness_px < limit ? s.length() : 0;
  if (thin > kFewThin * all) return;
  const auto first = std::stable_partition(out.walls.begin(), out.walls.end(),
                                           [&](const InkStroke& s) { return s.thickness_px >= limit; });
  out.thin.insert(out.thin.end(), first, out.walls.end());
  out.walls.erase(first, out.walls.end());
}

/// Lines of the main class in pairs: nothing is thicker than the outline of a wall.
void take_hollow(WallStrokes& out, const std::vector<InkStroke>& thick, const std::vector<InkStroke>& pairs,
                 const HollowStyle& style) {
  std::vector<std::pair<double, double>> spacing;
  for (const auto& p : pairs) {
    spacing.emplace_back(p.thickness_px, p.length());
    if (p.thickness_px < 2.5 * style.usual_px) out.walls.push_back(p);
  }
  for (const auto& s : thick)
    if (s.thickness_px > kClosed * style.outline_px && !half_of_a_pair(s, pairs)) out.walls.push_back(s);
  out.thickness_px = weighted_quantile(spacing, 0.6);
}

WallStrokes walls_of_classes(const std::vector<InkStroke>& candidates, const ThicknessClasses& classes, double side_px,
                             const LayoutParams& params, bool may_be_hollow, const std::optional<Point2>& at) {
  WallStrokes out;
  out.thickness_px = classes.usual_px;
  out.thin_limit_px = classes.thin_limit_px;
  std::vector<InkStroke> thick;
  for (const auto& s : candidates) {
    if (s.thickness_px < classes.thin_limit_px)
      out.thin.push_back(s);
    else if (s.thickness_px < std::max(2.2 * classes.usual_px, 1.3 * classes.outer_px) && s.coverage > 0.55)
      thick.push_back(s);
  }
  thick = without_blocks(without_echoes(thick), kWindowReach * params.max_opening_share * side_px);
  const auto pairs =
      merge_collinear(pair_hollow(thick, 0.6 * params.max_wall_share * side_px), params.merge_angle_deg, 2);
  const HollowStyle style = hollow_style(pairs, thick, side_px);
  out.hollow = may_be_hollow && style.share > kHollowShare;
  out.hollow_px = style.widest_px;
  out.outline_px = style.outline_px;
  if (out.hollow) {
    take_hollow(out, thick, pairs, style);
    out.thin = candidates;
  } else {
    out.walls = without_ladders(dark_enough(thick), 0.015 * side_px);
    out.walls = without_discs(out.walls, out.thickness_px, side_px);
    part_off_few_thin(out);
    if (style.share > 0.12) out.walls = with_pairs_joined(out.walls, pairs);
  }
  std::vector<std::pair<double, double>> long_ones;
  for (const auto& s : out.walls)
    if (s.length() >= 5 * s.thickness_px) long_ones.emplace_back(s.thickness_px, s.length() * s.thickness_px);
  out.thickest_px = weighted_quantile(long_ones, 0.9);
  take_drawing(out, rank_drawings(out.walls, out.thickness_px, params.max_opening_share * side_px, side_px), at);
  return out;
}

std::vector<InkStroke> could_be_walls(const std::vector<InkStroke>& strokes, double side_px,
                                      const LayoutParams& params) {
  std::vector<InkStroke> candidates;
  for (const auto& s : strokes)
    if (s.length() >= 0.6 * params.min_wall_share * side_px && s.length() >= 0.7 * s.thickness_px)
      candidates.push_back(s);
  return candidates;
}

double chosen_area(const WallStrokes& walls) {
  double area = 0;
  for (const auto& d : walls.drawings)
    if (d.chosen) area += (d.high_px - d.low_px).prod();
  return area;
}

/// What lies within the chosen drawing and hangs together with it. Bars of a legend, signs and labels that stand alone
/// between its wings say nothing about the thickness of its walls.
std::vector<InkStroke> within_drawing(const std::vector<InkStroke>& strokes, const WallStrokes& walls, double bridge_px,
                                      double side_px) {
  const auto chosen =
      std::find_if(walls.drawings.begin(), walls.drawings.end(), [](const auto& d) { return d.chosen; });
  if (chosen == walls.drawings.end()) return {};
  const Point2 margin = Point2::Constant(walls.thickest_px);
  std::vector<InkStroke> inside;
  for (const auto& s : strokes) {
    const Point2 p = s.axis.midpoint();
    if ((p.array() > (chosen->low_px - margin).array()).all() && (p.array() < (chosen->high_px + margin).array()).all())
      inside.push_back(s);
  }
  const auto is_wall = [&](const InkStroke& s) {
    return std::any_of(walls.walls.begin(), walls.walls.end(),
                       [&](const InkStroke& w) { return w.axis.a == s.axis.a && w.axis.b == s.axis.b; });
  };
  const auto carries_on = [&](const InkStroke& s) {
    return std::any_of(inside.begin(), inside.end(), [&](const InkStroke& o) {
      return &o != &s && line_angle_between(o.axis.heading(), s.axis.heading()) < radians(4) &&
             std::abs(signed_line_distance(o.axis, s.axis.midpoint())) < 0.5 * s.thickness_px + 1 &&
             std::abs(std::log(o.thickness_px / s.thickness_px)) < kAlikeThickness &&
             gap_between(o.axis, s.axis) < kPostReach * bridge_px;
    });
  };
  std::vector<InkStroke> hanging;
  const auto regions = connected_regions(inside, bridge_px, side_px);
  for (const auto& region : regions) {
    const bool belongs = region.score() > kLeastPart * regions.front().score() ||
                         std::any_of(region.members.begin(), region.members.end(),
                                     [&](std::size_t m) { return is_wall(inside[m]) || carries_on(inside[m]); });
    for (const std::size_t m : region.members)
      if (belongs) hanging.push_back(inside[m]);
  }
  return hanging;
}

}  // namespace

std::vector<InkStroke> dash_dot_lines(const std::vector<InkStroke>& strokes, cv::Size picture,
                                      const LayoutParams& params) {
  const auto candidates = could_be_walls(strokes, std::max(picture.width, picture.height), params);
  const auto dashed = in_dash_dot_lines(candidates);
  std::vector<InkStroke> found;
  for (std::size_t i = 0; i < dashed.size(); ++i)
    if (dashed[i]) found.push_back(candidates[i]);
  return found;
}

WallStrokes select_walls(const std::vector<InkStroke>& strokes, cv::Size picture, const LayoutParams& params,
                         double least_px, const std::optional<Point2>& at) {
  const double side = std::max(picture.width, picture.height);
  const double bridge = 0.02 * side;
  auto candidates = without_dash_dot_lines(could_be_walls(strokes, side, params));
  straighten_thickness(candidates);
  const auto regions = connected_regions(candidates, bridge, side);
  if (regions.empty()) return {};
  ThicknessClasses classes = thickness_classes(pick(candidates, region_at(regions, at).members), params);
  if (least_px > 0) {
    classes.thin_limit_px = least_px;
    return walls_of_classes(candidates, classes, side, params, false, at);
  }
  // What hangs together was the frame of the sheet, or the partitions without the outer walls: once more by what lies
  // within the drawing that it led to.
  const auto first = walls_of_classes(candidates, classes, side, params, true, at);
  const auto inside = within_drawing(candidates, first, bridge, side);
  if (inside.empty()) return first;
  auto second = walls_of_classes(candidates, thickness_classes(inside, params), side, params, true, at);
  // Signs and labels may be thicker than the lines of a plan with hollow walls.
  return chosen_area(second) >= kLeastOfFirst * chosen_area(first) ? second : first;
}

}  // namespace smokemap
