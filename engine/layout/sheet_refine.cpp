// Idea: a search at a small size may take a hairline printed along the rim for the rim, and is off by a pixel of its
// own. At full size wide strips on both banks of a side are compared by their medians, in which a thin line does not
// show. Where they differ along most of the side there is a step: from the wall to paper, from the wall to a picture
// frame, from the frame to paper, from the margin to a coloured header. Coming from outside, the rim is the last of the
// steps that lead from something dark and unprinted to something whiter. Its place is then measured to a fraction of a
// pixel.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/segment2.hpp"
#include "layout/median.hpp"
#include "layout/rim_profile.hpp"
#include "layout/sheet.hpp"

namespace smokemap {
namespace {

constexpr int kRimSamples = 96;
constexpr double kRimReach = 0.016;   ///< of the sheet's long side: how far a side may be moved
constexpr double kRimStrip = 0.0055;  ///< of the same: width of the strips that are compared
constexpr double kRimStepGrey = 18;   ///< the least difference of the strips, any channel
constexpr double kAgreeing = 0.4;     ///< share of the samples that must lie on the new side
constexpr int kMostSteps = 4;         ///< looked at along one side
constexpr double kStandsOut = 0.6;    ///< within a strip's width of a step less than this share of it may be left
constexpr double kDoubtful = 0.6;     ///< trust in a rim that may be a bright frame's
constexpr double kLeaves = 0.4;       ///< of the step: colours that differ by more are no longer the wall's
constexpr double kOnTheLinePx = 1.5;  ///< of the fine line: what counts as agreeing with it

/// Offsets at which the colours change. Medians differ all over a strip's width about an edge; smoothing over as much
/// leaves one peak, at the edge. Where they differ everywhere (a rough wall) there is no edge.
std::vector<int> changes(const RimProfile& profile, int reach, int strip) {
  const int most = reach + strip, count = 2 * most + 1, half = strip / 2;
  std::vector<double> step, smooth;
  for (int o = -most; o <= most; ++o) {
    const auto inside = profile.median(o, o + strip), outside = profile.median(o - strip, o);
    step.push_back(inside && outside ? largest_difference(*inside, *outside) : 0);
  }
  for (int i = 0; i < count; ++i) {
    const int low = std::max(0, i - half), high = std::min(count - 1, i + half);
    smooth.push_back(std::accumulate(step.begin() + low, step.begin() + high + 1, 0.0) / (high - low + 1));
  }
  std::vector<int> places;
  for (int i = strip; i + strip < count; ++i) {
    const auto at = smooth.begin() + i;
    const double valley = std::max(*std::min_element(at - strip, at), *std::min_element(at + 1, at + strip + 1));
    if (*at < 0.6 * kRimStepGrey || valley > kStandsOut * *at) continue;
    if (std::all_of(at - half, at, [&](double v) { return v < *at; }) &&
        std::all_of(at, at + half + 1, [&](double v) { return v <= *at; }))
      places.push_back(i - most);
  }
  return places;
}

/// Green, red or blue as it is printed; picture frames are gray, black or brown.
bool is_printed(const Colour& bgr) {
  const auto [low, high] = std::minmax({bgr[0], bgr[1], bgr[2]});
  if (high - low < 70 || high - low < 0.55 * high) return false;
  const bool is_brown = bgr[2] == high && bgr[1] - bgr[0] > 0.25 * (high - low);
  return !is_brown;
}

struct RefinedSide {
  Segment2 side;
  double agreement = 0;  ///< share of the samples that see the rim there
  double sigma_px = 0;
};

struct RimPoint {
  double along = 0;   ///< 0..1 of the side
  double offset = 0;  ///< inwards, px
};

/// Offset from the side as it was, at its start and at its end.
struct RimLine {
  double from = 0, to = 0;
  double at(double along) const { return from + (to - from) * along; }
};

/// Least squares through the points within `tolerance` of the line.
std::optional<RimLine> fitted(const std::vector<RimPoint>& points, const RimLine& line, double tolerance) {
  double n = 0, s = 0, ss = 0, o = 0, so = 0;
  for (const auto& p : points)
    if (std::abs(line.at(p.along) - p.offset) <= tolerance)
      n += 1, s += p.along, ss += p.along * p.along, o += p.offset, so += p.along * p.offset;
  const double det = n * ss - s * s;
  if (n < 8 || std::abs(det) < 1e-9) return std::nullopt;
  const double slope = (n * so - s * o) / det, start = (o - slope * s) / n;
  return RimLine{start, start + slope};
}

double median_shift(const std::vector<RimPoint>& points, const RimLine& line) {
  std::vector<double> shifts;
  for (const auto& p : points) shifts.push_back(p.offset - line.at(p.along));
  return shifts.empty() ? 0 : median_of(std::move(shifts));
}

/// The line that most samples have a point near.
std::optional<RimLine> most_agreed(const std::vector<RimPoint>& points, int reach, int stride) {
  RimLine best;
  std::ptrdiff_t most = 0;
  for (int from = -reach; from <= reach; from += stride)
    for (int to = -reach; to <= reach; to += stride) {
      const RimLine line{static_cast<double>(from), static_cast<double>(to)};
      std::array<bool, kRimSamples> met{};
      for (const auto& p : points)
        if (std::abs(line.at(p.along) - p.offset) <= stride)
          met[static_cast<std::size_t>(p.along * kRimSamples)] = true;
      const auto count = std::count(met.begin(), met.end(), true);
      if (count > most) most = count, best = line;
    }
  if (static_cast<double>(most) < kAgreeing * kRimSamples) return std::nullopt;
  return fitted(points, best, 1.5 * stride);
}

/// All the steps along a side, from the outside inwards.
std::vector<RimLine> steps_along(std::vector<RimPoint> points, int reach) {
  const int stride = std::max(1, reach / 12);
  std::vector<RimLine> lines;
  for (int i = 0; i < kMostSteps; ++i) {
    const auto line = most_agreed(points, reach, stride);
    if (!line) break;
    lines.push_back(*line);
    std::erase_if(points, [&](const RimPoint& p) { return std::abs(line->at(p.along) - p.offset) <= 3 * stride; });
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const RimLine& a, const RimLine& b) { return a.from + a.to < b.from + b.to; });
  return lines;
}

/// One side of the sheet and what crosses it.
class RimSide {
 public:
  RimSide(const cv::Mat& bgr, const Segment2& side, const Point2& inward, double long_side_px)
      : bgr_(bgr),
        side_(side),
        inward_(inward),
        reach_(std::max(3, static_cast<int>(kRimReach * long_side_px))),
        strip_(std::max(7, static_cast<int>(kRimStrip * long_side_px))) {
    for (int i = 0; i < kRimSamples; ++i)
      profiles_.emplace_back(bgr, place((i + 0.5) / kRimSamples), inward, -reach_ - 2 * strip_, reach_ + 2 * strip_);
  }

  /// The side moved to the rim; as it was, where no step is seen.
  RefinedSide refined() const {
    const auto found = rim();
    if (!found) return {side_, 0, static_cast<double>(reach_) / 4};
    const RimLine* line = &found->line;
    const auto points = fine_points(*line);
    const double shift = median_shift(points, *line);
    const auto fine = fitted(points, {line->from + shift, line->to + shift}, 0.5 * strip_);
    const auto finer = fine ? fitted(points, *fine, kOnTheLinePx) : std::nullopt;
    const RimLine chosen = finer.value_or(*line);
    int on = 0;
    double squares = 0;
    for (const auto& p : points)
      if (const double off = chosen.at(p.along) - p.offset; std::abs(off) <= kOnTheLinePx)
        on += 1, squares += off * off;
    // Ends of a fitted line are off by twice the error of its mean.
    const double sigma = on > 8 ? 2 * std::sqrt(squares / on / on) : 1.5;
    return {{shifted(0, chosen), shifted(1, chosen)}, found->trust * on / kRimSamples, 0.5 + sigma};
  }

 private:
  struct Rim {
    RimLine line;
    double trust = 1;  ///< less where it may be the outer edge of a frame as bright as paper
  };

  static double along_side(double t) { return 0.03 + 0.94 * t; }
  Point2 place(double t) const { return side_.a + along_side(t) * (side_.b - side_.a); }
  /// Where the line is at an end of the side (0, 1), beyond the samples.
  Point2 shifted(double end, const RimLine& line) const {
    return side_.a + end * (side_.b - side_.a) + line.at((end - 0.03) / 0.94) * inward_;
  }

  std::optional<Rim> rim() const {
    std::vector<RimPoint> points;
    for (int i = 0; i < kRimSamples; ++i)
      for (const int at : changes(profiles_[static_cast<std::size_t>(i)], reach_, strip_))
        points.push_back({(i + 0.5) / kRimSamples, at - 0.5});
    const auto steps = steps_along(std::move(points), reach_);
    if (steps.empty()) return std::nullopt;
    std::size_t rim = 0;
    while (rim + 1 < steps.size() && leads_to_paper(steps[rim + 1])) rim += 1;
    const bool bright_frame = rim + 1 < steps.size() && !leads_to_print(steps[rim + 1]);
    return Rim{steps[rim], bright_frame ? kDoubtful : 1.0};
  }

  /// What most samples say of the colours outside and inside a step.
  template <typename Question>
  bool most_samples(const RimLine& step, const Question& question) const {
    int yes = 0, seen = 0;
    for (int i = 0; i < kRimSamples; ++i) {
      const int at = static_cast<int>(std::lround(step.at((i + 0.5) / kRimSamples)));
      if (std::abs(at) > reach_) continue;
      const auto& profile = profiles_[static_cast<std::size_t>(i)];
      const auto outside = profile.median(at - strip_ / 2, at), inside = profile.median(at, at + strip_);
      if (!outside || !inside) continue;
      seen += 1;
      yes += question(*outside, *inside);
    }
    return 2 * yes > seen;
  }
  /// From a picture frame, or a shadow, to paper: whiter inside (in the darkest channel), and outside nothing printed.
  bool leads_to_paper(const RimLine& step) const {
    return most_samples(step, [](const Colour& outside, const Colour& inside) {
      return !is_printed(outside) &&
             *std::min_element(inside.begin(), inside.end()) > *std::min_element(outside.begin(), outside.end());
    });
  }
  /// From a margin to a coloured header, or to a figure.
  bool leads_to_print(const RimLine& step) const {
    return most_samples(step, [](const Colour&, const Colour& inside) { return is_printed(inside); });
  }
  /// From a narrow printed border to paper: the rim is where the border begins.
  bool is_bordered(const RimLine& step) const {
    return most_samples(step, [](const Colour& outside, const Colour&) { return is_printed(outside); });
  }

  /// Where, coming from outside, the colours first leave those outside the step: a narrow printed border belongs to the
  /// sheet. To a fraction of a pixel, half way up.
  std::vector<RimPoint> fine_points(const RimLine& line) const {
    std::vector<RimPoint> points;
    const int around = is_bordered(line) ? 3 * strip_ / 2 : strip_ / 2 + 2;
    for (int i = 0; i < kRimSamples; ++i) {
      const double t = (i + 0.5) / kRimSamples, middle = line.at(t);
      const int at = static_cast<int>(std::lround(middle));
      if (std::abs(at) > reach_) continue;
      const auto outside = profiles_[static_cast<std::size_t>(i)].median(at - around - strip_ / 2, at - around);
      if (!outside) continue;
      const cv::Vec3d wall((*outside)[0], (*outside)[1], (*outside)[2]);
      std::vector<double> away;
      for (int k = -around; k <= around + 3; ++k)
        away.push_back(cv::norm(colour(place(t) + (middle + k) * inward_) - wall));
      const double high = *std::max_element(away.begin(), away.end());
      if (high < kRimStepGrey) continue;
      const auto first = std::find_if(away.begin(), away.end() - 3, [&](double a) { return a > kLeaves * high; });
      const double half = 0.5 * *std::max_element(first, first + 4);
      const auto above = std::find_if(first, first + 4, [&](double a) { return a >= half; });
      if (above == away.begin()) continue;
      const double part = std::clamp((*above - half) / std::max(1e-9, *above - *(above - 1)), 0.0, 1.0);
      points.push_back({t, middle - around + static_cast<double>(above - away.begin()) - part});
    }
    return points;
  }

  /// Mean of five pixels along the side: noise goes, the edge stays.
  cv::Vec3d colour(const Point2& p) const {
    const Point2 along = side_.direction();
    cv::Vec3d sum(0, 0, 0);
    for (int k = -2; k <= 2; ++k) {
      const Point2 q = p + k * along;
      const int x = std::clamp(static_cast<int>(std::floor(q.x())), 0, bgr_.cols - 2),
                y = std::clamp(static_cast<int>(std::floor(q.y())), 0, bgr_.rows - 2);
      const double u = std::clamp(q.x() - x, 0.0, 1.0), v = std::clamp(q.y() - y, 0.0, 1.0);
      const cv::Vec3d above =
                          (1 - u) * cv::Vec3d(bgr_.at<cv::Vec3b>(y, x)) + u * cv::Vec3d(bgr_.at<cv::Vec3b>(y, x + 1)),
                      below = (1 - u) * cv::Vec3d(bgr_.at<cv::Vec3b>(y + 1, x)) +
                              u * cv::Vec3d(bgr_.at<cv::Vec3b>(y + 1, x + 1));
      sum += (1 - v) * above + v * below;
    }
    return sum / 5;
  }

  const cv::Mat& bgr_;
  Segment2 side_;
  Point2 inward_;
  int reach_, strip_;
  std::vector<RimProfile> profiles_;
};

}  // namespace

RefinedSheet refine_sheet(const cv::Mat& bgr, const SheetCorners& corners_px) {
  double long_side = 0;
  for (std::size_t i = 0; i < 4; ++i) long_side = std::max(long_side, (corners_px[(i + 1) % 4] - corners_px[i]).norm());
  const RefinedSheet as_it_was{corners_px, 0, 0.25 * kRimReach * long_side};
  std::array<RefinedSide, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    const Segment2 side{corners_px[i], corners_px[(i + 1) % 4]};
    if (side.length() < 32) return as_it_was;
    Point2 inward = side.normal();
    if (inward.dot(corners_px[(i + 2) % 4] - side.a) < 0) inward = -inward;
    sides[i] = RimSide(bgr, side, inward, long_side).refined();
  }
  RefinedSheet refined{corners_px, 1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto p = line_intersection(sides[(i + 3) % 4].side, sides[i].side);
    if (!p || (*p - corners_px[i]).norm() > 3 * kRimReach * long_side) return as_it_was;
    refined.corners_px[i] = *p;
    refined.agreement = std::min(refined.agreement, sides[i].agreement);
    refined.sigma_px = std::max(refined.sigma_px, sides[i].sigma_px);
  }
  return refined;
}

}  // namespace smokemap
