#include <algorithm>
#include <cmath>
#include <optional>

#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

struct Neighbour {
  std::size_t other = 0;
  double offset = 0;         ///< signed distance of the other line
  double low = 0, high = 0;  ///< where both run side by side, along this line
};

/// Where `other` runs beside `line`: overlap along and offset across; nothing if not parallel.
std::optional<Neighbour> beside(const InkStroke& line, const InkStroke& other, std::size_t index, double reach) {
  if (line_angle_between(line.axis.heading(), other.axis.heading()) > radians(3)) return std::nullopt;
  const double offset = signed_line_distance(line.axis, other.axis.midpoint());
  if (std::abs(offset) > reach || std::abs(offset) < 0.5) return std::nullopt;
  double low = along(line.axis, other.axis.a) * line.length(), high = along(line.axis, other.axis.b) * line.length();
  if (low > high) std::swap(low, high);
  low = std::max(low, 0.0), high = std::min(high, line.length());
  if (high - low < 0.4 * std::min(line.length(), other.length())) return std::nullopt;
  return Neighbour{index, offset, low, high};
}

/// A ladder: about the same spacing again on the far side of either line.
bool has_rung(const std::vector<Neighbour>& around, double offset, double low, double high) {
  return std::any_of(around.begin(), around.end(), [&](const Neighbour& n) {
    if (n.offset * offset > 0) return false;
    const double overlap = std::min(high, n.high) - std::max(low, n.low);
    const double ratio = std::abs(n.offset / offset);
    return overlap > 0.5 * (high - low) && ratio > 0.6 && ratio < 1.6;
  });
}

/// For every line the parallel ones beside it.
std::vector<std::vector<Neighbour>> neighbourhoods(const std::vector<InkStroke>& lines, double reach_px) {
  std::vector<std::vector<Neighbour>> around(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Point2 middle = lines[i].axis.midpoint();
    for (std::size_t j = 0; j < lines.size(); ++j) {
      if (i == j) continue;
      const double reach = 0.5 * (lines[i].length() + lines[j].length()) + reach_px;
      if ((lines[j].axis.midpoint() - middle).squaredNorm() > reach * reach) continue;
      if (const auto n = beside(lines[i], lines[j], j, reach_px)) around[i].push_back(*n);
    }
  }
  return around;
}

}  // namespace

std::vector<InkStroke> without_ladders(const std::vector<InkStroke>& strokes, double max_spacing_px) {
  const auto around = neighbourhoods(strokes, max_spacing_px);
  const auto alike = [&](std::size_t i, const Neighbour& n) {
    const double ratio = strokes[n.other].length() / strokes[i].length();
    return ratio > 0.5 && ratio < 2 && std::abs(n.offset) > 1.6 * strokes[i].thickness_px;
  };
  std::vector<bool> rung(strokes.size(), false);
  for (std::size_t i = 0; i < strokes.size(); ++i)
    for (const auto& n : around[i])
      if (alike(i, n) && has_rung(around[i], n.offset, n.low, n.high)) rung[i] = true;
  std::vector<InkStroke> kept;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const bool outermost = std::any_of(around[i].begin(), around[i].end(), [&](const Neighbour& n) {
      return rung[n.other] && alike(i, n) && strokes[i].length() < 1.3 * strokes[n.other].length();
    });
    if (!rung[i] && !outermost) kept.push_back(strokes[i]);
  }
  return kept;
}

std::vector<InkStroke> pair_hollow(const std::vector<InkStroke>& thin, double max_spacing_px) {
  const auto around = neighbourhoods(thin, 1.7 * max_spacing_px);
  std::vector<InkStroke> pairs;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    for (const auto& n : around[i]) {
      const auto& line = thin[i];
      const auto& other = thin[n.other];
      const double spacing = std::abs(n.offset);
      if (n.other < i || spacing > max_spacing_px || spacing < 1.6 * std::max(line.thickness_px, other.thickness_px))
        continue;
      if (n.high - n.low < 2.0 * spacing) continue;
      // nothing between: a nearer parallel line belongs to it first
      const bool nearer = std::any_of(around[i].begin(), around[i].end(), [&](const Neighbour& m) {
        return m.offset * n.offset > 0 && std::abs(m.offset) < 0.9 * spacing &&
               std::min(m.high, n.high) - std::max(m.low, n.low) > 0.5 * (n.high - n.low);
      });
      if (nearer || has_rung(around[i], n.offset, n.low, n.high)) continue;
      const double back = signed_line_distance(other.axis, line.axis.midpoint());
      const double low = along(other.axis, line.axis.a + n.low * line.axis.direction()) * other.length();
      const double high = along(other.axis, line.axis.a + n.high * line.axis.direction()) * other.length();
      if (has_rung(around[n.other], back, std::min(low, high), std::max(low, high))) continue;
      const Point2 u = line.axis.direction(), shift = 0.5 * n.offset * line.axis.normal();
      InkStroke pair;
      pair.axis = {line.axis.a + n.low * u + shift, line.axis.a + n.high * u + shift};
      pair.thickness_px = spacing + 0.5 * (line.thickness_px + other.thickness_px);
      pair.coverage = std::min(line.coverage, other.coverage);
      pair.darkness = std::min(line.darkness, other.darkness);
      pair.hollow = true;
      pairs.push_back(pair);
    }
  }
  return pairs;
}

std::vector<InkStroke> merge_collinear(std::vector<InkStroke> strokes, double angle_deg, double gap_px) {
  std::stable_sort(strokes.begin(), strokes.end(),
                   [](const InkStroke& a, const InkStroke& b) { return a.length() > b.length(); });
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      for (std::size_t j = i + 1; j < strokes.size();) {
        auto& big = strokes[i];
        const auto& small = strokes[j];
        const double side = std::max(2.0, 0.5 * std::max(big.thickness_px, small.thickness_px));
        const double low = along(big.axis, small.axis.a) * big.length(),
                     high = along(big.axis, small.axis.b) * big.length();
        const bool joins = line_angle_between(big.axis.heading(), small.axis.heading()) < radians(angle_deg) &&
                           std::abs(signed_line_distance(big.axis, small.axis.a)) < side &&
                           std::abs(signed_line_distance(big.axis, small.axis.b)) < side &&
                           std::max(low, high) > -gap_px && std::min(low, high) < big.length() + gap_px;
        if (!joins) {
          ++j;
          continue;
        }
        const double sum = big.length() + small.length();
        const Point2 u = big.axis.direction(), origin = big.axis.a;
        const double from = std::min({0.0, low, high}), to = std::max({big.length(), low, high});
        big.thickness_px = (big.thickness_px * big.length() + small.thickness_px * small.length()) / sum;
        big.coverage =
            std::min(1.0, (big.coverage * big.length() + small.coverage * small.length()) / std::max(1.0, to - from));
        big.axis = {origin + from * u, origin + to * u};
        strokes.erase(strokes.begin() + static_cast<std::ptrdiff_t>(j));
        changed = true;
      }
    }
  }
  return strokes;
}

}  // namespace smokemap
