// Idea: a thick line of dashes and dots (ISO 128: limits, axes, property) is no wall, however thick. Its dots give it
// away: short pieces, about as long as thick, between two long ones in line, with the same small gap on both sides.
// Piers between windows have no dots.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "layout/drawings.hpp"
#include "layout/median.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kFewestDots = 5;

/// Gap to a longer piece that carries the dot on, on the side of the direction; nothing if there is none.
std::optional<double> gap_to_dash(const InkStroke& dot, const std::vector<InkStroke>& strokes, const Point2& outward) {
  std::optional<double> gap;
  const Point2 middle = dot.axis.midpoint();
  for (const auto& s : strokes) {
    if (&s == &dot || s.length() < 2.5 * dot.length()) continue;
    const double ratio = s.thickness_px / dot.thickness_px;
    if (ratio < 0.6 || ratio > 1.6 || line_angle_between(s.axis.heading(), dot.axis.heading()) > radians(10)) continue;
    const Point2 near = (s.axis.a - middle).squaredNorm() < (s.axis.b - middle).squaredNorm() ? s.axis.a : s.axis.b;
    const double ahead = (near - middle).dot(outward) - 0.5 * dot.length();
    const double aside = std::abs(signed_line_distance(dot.axis, near));
    if (aside > 0.7 * dot.thickness_px || ahead < 0.3 * dot.thickness_px || ahead > 4 * dot.thickness_px) continue;
    if (!gap || ahead < *gap) gap = ahead;
  }
  return gap;
}

bool is_dot(const InkStroke& s, const std::vector<InkStroke>& strokes) {
  if (s.length() < 0.7 * s.thickness_px || s.length() > 4 * s.thickness_px) return false;
  const auto ahead = gap_to_dash(s, strokes, s.axis.direction());
  const auto behind = gap_to_dash(s, strokes, -s.axis.direction());
  return ahead && behind && std::abs(*ahead - *behind) < 0.4 * std::max(*ahead, *behind);
}

}  // namespace

std::vector<bool> in_dash_dot_lines(const std::vector<InkStroke>& strokes) {
  std::vector<bool> dashed(strokes.size(), false);
  std::vector<double> thickness;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (is_dot(strokes[i], strokes)) dashed[i] = true, thickness.push_back(strokes[i].thickness_px);
  if (thickness.size() < kFewestDots) return std::vector<bool>(strokes.size(), false);
  const double usual = median_of(std::move(thickness));
  // From the dots along the line: pieces as thick that begin within a gap of one that belongs to it.
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      const auto& s = strokes[i];
      if (dashed[i] || s.thickness_px < 0.6 * usual || s.thickness_px > 1.6 * usual) continue;
      for (std::size_t j = 0; j < strokes.size() && !dashed[i]; ++j)
        if (dashed[j] && gap_between(s.axis, strokes[j].axis) < 4 * usual) dashed[i] = grown = true;
    }
  }
  return dashed;
}

std::vector<InkStroke> without_dash_dot_lines(const std::vector<InkStroke>& strokes) {
  const auto dashed = in_dash_dot_lines(strokes);
  std::vector<InkStroke> kept;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!dashed[i]) kept.push_back(strokes[i]);
  return kept;
}

}  // namespace smokemap
