#include "layout/wall_strokes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "layout/drawings.hpp"

namespace smokemap {
namespace {

constexpr double kHollowShare = 0.3;  ///< of the long lines in pairs: from here on single lines are no walls
constexpr double kClosed = 1.5;       ///< times an outline's thickness: solid, or two lines that blur made one

/// The value below which `share` of the weight lies.
double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double share) {
  if (value_weight.empty()) return 0;
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : value_weight) total += weight;
  for (const auto& [value, weight] : value_weight) {
    sum += weight;
    if (sum >= share * total) return value;
  }
  return value_weight.back().first;
}

/// The emptiest place of the length-weighted log histogram between low and high.
double valley(const std::vector<InkStroke>& strokes, double low, double high, double otherwise) {
  const int bins = 24;
  std::vector<double> weight(bins, 0.0);
  const double span = std::log(high / low);
  double total = 0;
  for (const auto& s : strokes) {
    const double position = std::log(std::max(0.2, s.thickness_px) / low) / span;
    for (int b = 0; b < bins; ++b) {
      const double away = ((b + 0.5) / bins - position) * span / 0.10;
      if (std::abs(away) < 3) weight[static_cast<std::size_t>(b)] += s.length() * std::exp(-0.5 * away * away);
    }
    total += s.length();
  }
  if (total <= 0) return otherwise;
  double best = 1e300, at = otherwise;
  for (int b = 0; b < bins; ++b) {
    const double t = low * std::exp(span * (b + 0.5) / bins);
    const double cost = weight[static_cast<std::size_t>(b)] + 0.01 * total * std::abs(std::log(t / otherwise));
    if (cost < best) best = cost, at = t;
  }
  return at;
}

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
      const double body = 0.75 * o.thickness_px + 1;
      return o.length() > 1.3 * s.length() && line_angle_between(o.axis.heading(), s.axis.heading()) < radians(35) &&
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

/// Gray blocks (signs on a copy without colour, shaded areas) are not as dark as the walls.
std::vector<InkStroke> dark_enough(const std::vector<InkStroke>& strokes) {
  std::vector<std::pair<double, double>> darkness;
  for (const auto& s : strokes) darkness.emplace_back(s.darkness, s.length());
  const double usual = weighted_quantile(darkness, 0.6);
  std::vector<InkStroke> kept;
  for (const auto& s : strokes)
    if (s.darkness > (s.thickness_px >= 5 ? 0.75 : 0.5) * usual) kept.push_back(s);
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

}  // namespace

WallStrokes select_walls(const std::vector<InkStroke>& strokes, cv::Size picture, const LayoutParams& params,
                         double least_px, const std::optional<Point2>& at) {
  const double side = std::max(picture.width, picture.height);
  const double bridge = 0.02 * side;
  std::vector<InkStroke> candidates;
  for (const auto& s : strokes)
    if (s.length() >= 0.6 * params.min_wall_share * side && s.length() >= 0.7 * s.thickness_px) candidates.push_back(s);
  candidates = without_dash_dot_lines(candidates);
  const auto regions = connected_regions(candidates, bridge, side);
  WallStrokes out;
  if (regions.empty()) return out;
  const auto plan = pick(candidates, region_at(regions, at).members);

  std::vector<std::pair<double, double>> by_area;
  for (const auto& s : plan)
    if (s.length() >= 2.5 * s.thickness_px) by_area.emplace_back(s.thickness_px, s.length() * s.thickness_px);
  out.thickness_px = weighted_quantile(by_area, 0.6);
  out.thin_limit_px = valley(plan, 0.7 * params.thin_ratio * out.thickness_px,
                             1.1 * params.thin_ratio * out.thickness_px, 0.9 * params.thin_ratio * out.thickness_px);
  if (least_px > 0) out.thin_limit_px = least_px;
  std::vector<InkStroke> thick;
  for (const auto& s : candidates) {
    if (s.thickness_px < out.thin_limit_px)
      out.thin.push_back(s);
    else if (s.thickness_px < 2.2 * out.thickness_px && s.coverage > 0.55)
      thick.push_back(s);
  }
  thick = without_blocks(without_echoes(thick), params.max_opening_share * side);

  // Lines of the main class in pairs: nothing is thicker than the outline of a wall.
  const auto pairs = merge_collinear(pair_hollow(thick, 0.6 * params.max_wall_share * side), params.merge_angle_deg, 2);
  const HollowStyle style = hollow_style(pairs, thick, side);
  out.hollow = least_px <= 0 && style.share > kHollowShare;
  out.hollow_px = style.widest_px;
  out.outline_px = style.outline_px;
  if (out.hollow) {
    std::vector<std::pair<double, double>> spacing;
    for (const auto& p : pairs) {
      spacing.emplace_back(p.thickness_px, p.length());
      if (p.thickness_px < 2.5 * style.usual_px) out.walls.push_back(p);
    }
    for (const auto& s : thick)
      if (s.thickness_px > kClosed * style.outline_px && !half_of_a_pair(s, pairs)) out.walls.push_back(s);
    out.thickness_px = weighted_quantile(spacing, 0.6);
    out.thin = candidates;
  } else {
    out.walls = without_ladders(dark_enough(thick), 0.015 * side);
    if (style.share > 0.12) out.walls = with_pairs_joined(out.walls, pairs);
  }
  std::vector<std::pair<double, double>> long_ones;
  for (const auto& s : out.walls)
    if (s.length() >= 5 * s.thickness_px) long_ones.emplace_back(s.thickness_px, s.length() * s.thickness_px);
  out.thickest_px = weighted_quantile(long_ones, 0.9);
  take_drawing(out, rank_drawings(out.walls, out.thickness_px, params.max_opening_share * side, side), at);
  return out;
}

}  // namespace smokemap
