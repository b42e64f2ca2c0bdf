#include "layout/openings.hpp"

#include <algorithm>
#include <cmath>

#include "layout/gaps.hpp"

namespace smokemap {
namespace {

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
  repair_hidden(map, covered, thickness_px, reach);
  for (const auto& gap : gaps_ahead(map, thickness_px, reach)) {
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
