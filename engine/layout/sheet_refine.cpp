// Idea: a search at a small size may take a hairline printed along the rim for the rim, and is off by a pixel of its
// own. At full size strips on both banks of a side are compared by their medians, in which a thin line does not show.
// Of the places where they differ along most of the side the nearest is taken.
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "geometry/segment2.hpp"
#include "layout/sheet.hpp"

namespace smokemap {
namespace {

constexpr int kRimSamples = 96;
constexpr double kRimReach = 0.016;   ///< of the sheet's long side: how far a side may be moved
constexpr double kRimStrip = 0.0035;  ///< of the same: width of the strips that are compared
constexpr double kRimStepGrey = 18;   ///< the least difference of the strips, any channel
constexpr double kAgreeing = 0.4;     ///< share of the samples that must lie on the new side

using Colour = std::array<int, 3>;

/// Colours across one place of a side, from the outside inwards.
class RimProfile {
 public:
  RimProfile(const cv::Mat& bgr, const Point2& p, const Point2& inward, int low, int high) : low_(low) {
    for (int o = low; o <= high; ++o) {
      const Point2 q = p + o * inward;
      const int x = static_cast<int>(std::lround(q.x())), y = static_cast<int>(std::lround(q.y()));
      const bool seen = x >= 0 && y >= 0 && x < bgr.cols && y < bgr.rows;
      const cv::Vec3b c = seen ? bgr.at<cv::Vec3b>(y, x) : cv::Vec3b();
      seen_.push_back(seen);
      colours_.push_back({c[0], c[1], c[2]});
    }
  }
  /// Median colour of the offsets [from, to); nothing where the picture ends.
  std::optional<Colour> median(int from, int to) const {
    Colour out{};
    std::vector<int> values;
    for (std::size_t c = 0; c < 3; ++c) {
      values.clear();
      for (int o = from; o < to; ++o) {
        const auto i = static_cast<std::size_t>(o - low_);
        if (!seen_[i]) return std::nullopt;
        values.push_back(colours_[i][c]);
      }
      const auto nth = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), nth, values.end());
      out[c] = *nth;
    }
    return out;
  }

 private:
  int low_;
  std::vector<bool> seen_;
  std::vector<Colour> colours_;
};

int largest_difference(const Colour& a, const Colour& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Offsets at which the colours change. Medians differ all over a strip's width about an edge; smoothing over as much
/// leaves one peak, at the edge.
std::vector<int> changes(const RimProfile& profile, int reach, int strip) {
  std::vector<double> step;
  for (int o = -reach; o <= reach; ++o) {
    const auto inside = profile.median(o, o + strip), outside = profile.median(o - strip, o);
    step.push_back(inside && outside ? largest_difference(*inside, *outside) : 0);
  }
  const int count = static_cast<int>(step.size()), half = strip / 2;
  std::vector<double> smooth(step.size(), 0.0);
  for (int i = 0; i < count; ++i)
    for (int k = std::max(0, i - half); k <= std::min(count - 1, i + half); ++k)
      smooth[static_cast<std::size_t>(i)] += step[static_cast<std::size_t>(k)] / (2 * half + 1);
  std::vector<int> places;
  for (int i = 0; i < count; ++i) {
    const double here = smooth[static_cast<std::size_t>(i)];
    bool peak = here >= 0.6 * kRimStepGrey;
    for (int k = std::max(0, i - half); peak && k <= std::min(count - 1, i + half); ++k)
      peak = k < i ? smooth[static_cast<std::size_t>(k)] < here : smooth[static_cast<std::size_t>(k)] <= here;
    if (peak) places.push_back(i - reach);
  }
  return places;
}

struct RimPoint {
  double along = 0;   ///< 0..1 of the side
  double offset = 0;  ///< inwards, px
};

/// The line offset = from + (to - from) * along with many points near it that is nearest to the side as it was.
std::optional<std::pair<double, double>> agreed_line(const std::vector<RimPoint>& points, int reach) {
  const int stride = std::max(1, reach / 12);
  struct Vote {
    int from, to, count;
  };
  std::vector<Vote> votes;
  int most = 0;
  for (int from = -reach; from <= reach; from += stride)
    for (int to = -reach; to <= reach; to += stride) {
      std::vector<bool> met(kRimSamples, false);
      for (const auto& p : points)
        if (std::abs(from + (to - from) * p.along - p.offset) <= stride)
          met[static_cast<std::size_t>(p.along * kRimSamples)] = true;
      const int count = static_cast<int>(std::count(met.begin(), met.end(), true));
      votes.push_back({from, to, count});
      most = std::max(most, count);
    }
  if (most < kAgreeing * kRimSamples) return std::nullopt;
  const auto away = [](const Vote& v) { return std::abs(v.from) + std::abs(v.to); };
  const Vote* best = nullptr;
  for (const auto& v : votes)
    if (v.count >= 0.75 * most &&
        (!best || away(v) < away(*best) - 2 * stride || (away(v) <= away(*best) + 2 * stride && v.count > best->count)))
      best = &v;
  // Least squares over its points.
  double n = 0, s = 0, ss = 0, o = 0, so = 0;
  for (const auto& p : points)
    if (std::abs(best->from + (best->to - best->from) * p.along - p.offset) <= 1.5 * stride)
      n += 1, s += p.along, ss += p.along * p.along, o += p.offset, so += p.along * p.offset;
  const double det = n * ss - s * s;
  if (n < 8 || std::abs(det) < 1e-9) return std::nullopt;
  const double slope = (n * so - s * o) / det, start = (o - slope * s) / n;
  return std::pair{start, start + slope};
}

Segment2 refined_side(const cv::Mat& bgr, const Segment2& side, const Point2& inward, double long_side_px) {
  const int reach = std::max(3, static_cast<int>(kRimReach * long_side_px)),
            strip = std::max(5, static_cast<int>(kRimStrip * long_side_px));
  std::vector<RimPoint> points;
  for (int i = 0; i < kRimSamples; ++i) {
    const double t = (i + 0.5) / kRimSamples, along = 0.03 + 0.94 * t;
    const RimProfile profile(bgr, side.a + along * (side.b - side.a), inward, -reach - strip, reach + strip);
    for (const int at : changes(profile, reach, strip)) points.push_back({along, at - 0.5});
  }
  const auto line = agreed_line(points, reach);
  if (!line) return side;
  return {side.a + line->first * inward, side.b + line->second * inward};
}

}  // namespace

SheetCorners refine_sheet(const cv::Mat& bgr, const SheetCorners& corners_px) {
  double long_side = 0;
  for (std::size_t i = 0; i < 4; ++i) long_side = std::max(long_side, (corners_px[(i + 1) % 4] - corners_px[i]).norm());
  std::array<Segment2, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    const Segment2 side{corners_px[i], corners_px[(i + 1) % 4]};
    if (side.length() < 32) return corners_px;
    Point2 inward = side.normal();
    if (inward.dot(corners_px[(i + 2) % 4] - side.a) < 0) inward = -inward;
    sides[i] = refined_side(bgr, side, inward, long_side);
  }
  SheetCorners refined = corners_px;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto p = line_intersection(sides[(i + 3) % 4], sides[i]);
    if (!p || (*p - corners_px[i]).norm() > 3 * kRimReach * long_side) return corners_px;
    refined[i] = *p;
  }
  return refined;
}

}  // namespace smokemap
