// Idea: what makes a dimension line is its ticks: short oblique strokes, all alike, with their middles on a line that
// begins and ends at them (ISO 129). They are looked for in the ink, along every thin stroke, because a tick where
// three lines cross is no clean stroke. Hatching leaves a face on one side only; walls run on beyond the ticks that end
// on them.
#include <algorithm>
#include <cmath>
#include <optional>

#include "layout/drafting.hpp"
#include "layout/gaps.hpp"

namespace smokemap {
namespace {

constexpr double kLongestTick = 0.02;     ///< of the picture's long side
constexpr double kThickestLine = 0.25;    ///< of the longest tick
constexpr double kLongerThanThick = 1.5;  ///< times the line's thickness: how far a tick reaches beside it
constexpr double kLopsided = 1.7;         ///< times longer one half of a tick may be than the other
constexpr double kOtherDiagonal = 0.5;    ///< of a tick's reach may be inked across it
constexpr double kLikeTick = 1.6;         ///< times longer or shorter
constexpr double kOnLine = 0.06;          ///< rad, between a line and the way to its next tick
constexpr double kSlip = 0.3;             ///< times a tick's length: a gap in the line
constexpr double kHiddenGap = 0.6;        ///< of a gap, below arrows and signs
constexpr double kOvershoot = 1.2;        ///< times a tick's length: how far dimension lines run on beyond one
constexpr double kLeadOvershoot = 0.8;    ///< the same for lines that lead to the building
constexpr double kLikeLine = 1.5;         ///< times as thick as the dimension line may be what leads to it
constexpr double kSquare = 1.2;           ///< rad, at least between the two

struct Tick {
  std::size_t line = 0;  ///< the stroke it is on
  Point2 p = Point2::Zero();
  double length = 0;
  int lean = 0;  ///< 1 or -1: to which side of the line's heading
};

/// Looks for ticks in the ink.
class TickFinder {
 public:
  TickFinder(const cv::Mat& ink, double longest_px) : ink_(ink), longest_px_(longest_px) {}

  void add(const InkStroke& line, std::size_t index, std::vector<Tick>& ticks) const {
    const double from = 0.5 * line.thickness_px * std::sqrt(2.0) + 1;
    const double least = std::max(4.0, kLongerThanThick * line.thickness_px);
    const Point2 u = line.axis.direction(), n = line.axis.normal();
    Tick best;
    for (double t = -2; t <= line.length() + 2; t += 1) {
      const Point2 p = line.axis.a + t * u;
      for (const int lean : {1, -1}) {
        const double reach = both_ways(p, (u + lean * n).normalized(), from);
        if (reach < least || both_ways(p, (u - lean * n).normalized(), from) > kOtherDiagonal * reach) continue;
        if (!slim(p, (u + lean * n).normalized(), from + 0.8 * reach, line.thickness_px)) continue;
        const double length = 2 * (from + reach);
        const bool same = best.length > 0 && (best.p - p).norm() < length;
        if (same && best.length >= length) continue;
        if (!same && best.length > 0) ticks.push_back(best);
        best = {index, p, length, lean};
      }
    }
    if (best.length > 0) ticks.push_back(best);
  }

 private:
  bool inked(const Point2& p) const {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    return x >= 0 && y >= 0 && x < ink_.cols && y < ink_.rows && ink_.at<uchar>(y, x) != 0;
  }
  /// Paper lies on both sides of both halves of the tick.
  bool slim(const Point2& p, const Point2& way, double at, double thickness_px) const {
    const Point2 aside = (0.5 * thickness_px + 2.5) * Point2(-way.y(), way.x());
    for (const double end : {at, -at})
      if (inked(p + end * way + aside) || inked(p + end * way - aside)) return false;
    return true;
  }
  double run(const Point2& p, const Point2& way, double from) const {
    double reach = 0;
    while (reach < longest_px_ && inked(p + (from + reach) * way)) reach += 1;
    return reach;
  }
  /// How far ink reaches to the shorter of both sides; 0 if they are not alike, or longer than ticks are.
  double both_ways(const Point2& p, const Point2& way, double from) const {
    const double one = run(p, way, from);
    if (one < 1) return 0;
    const double two = run(p, -way, from);
    return std::max(one, two) > std::min(0.5 * longest_px_, kLopsided * std::min(one, two) + 1) ? 0
                                                                                                : std::min(one, two);
  }

  const cv::Mat& ink_;
  double longest_px_;
};

std::vector<Tick> find_ticks(const std::vector<InkStroke>& strokes, const cv::Mat& ink) {
  const double longest = kLongestTick * std::max(ink.rows, ink.cols);
  const TickFinder finder(ink, longest);
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (strokes[i].thickness_px < kThickestLine * longest && strokes[i].length() > longest)
      finder.add(strokes[i], i, ticks);
  return ticks;
}

class DimensionLines {
 public:
  DimensionLines(const std::vector<InkStroke>& strokes, const cv::Mat& ink, const cv::Mat& hidden)
      : strokes_(strokes), ink_(ink), hidden_(hidden), drop_(strokes.size(), false) {
    const auto ticks = find_ticks(strokes, ink);
    for (std::size_t a = 0; a < ticks.size(); ++a)
      for (std::size_t b = a + 1; b < ticks.size(); ++b)
        if (measure(ticks[a], ticks[b]) && ends_at_ticks(ticks[a], ticks[b])) {
          take(ticks[a], ticks[b]);
          for (const Tick& tick : ticks)
            if (distance({ticks[a].p, ticks[b].p}, tick.p) < 3) ticks_.push_back(tick);
        }
    for (const Tick& tick : ticks_) take_leads(tick);
  }
  bool holds(std::size_t stroke) const { return drop_[stroke]; }

 private:
  double thickest_beside(const Tick& tick) const { return kLikeLine * strokes_[tick.line].thickness_px + 0.5; }

  /// Nothing carries the line on within so far of its end.
  bool in_the_air(const Point2& end, const Point2& outward, double far_px) const {
    for (double ahead = 2; ahead < far_px; ahead += 1) {
      const Point2 p = end + ahead * outward;
      const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
      if (x >= 0 && y >= 0 && x < ink_.cols && y < ink_.rows && ink_.at<uchar>(y, x)) return false;
    }
    return true;
  }

  /// Both are alike and on one line.
  bool measure(const Tick& one, const Tick& two) const {
    const Segment2 way{one.p, two.p};
    const double longer = std::max(one.length, two.length);
    if (way.length() < 1.2 * longer || longer > kLikeTick * std::min(one.length, two.length)) return false;
    const Segment2 &first = strokes_[one.line].axis, &second = strokes_[two.line].axis;
    // Turning a line round does not change to which side its ticks lean.
    return one.lean == two.lean && line_angle_between(first.heading(), way.heading()) < kOnLine &&
           line_angle_between(second.heading(), way.heading()) < kOnLine;
  }

  /// From where to where ink runs along the way without a gap longer than a slip of the pen; 0 = its first end, 1 = its
  /// last. Nothing if there is one between them.
  std::optional<std::pair<double, double>> extent(const Segment2& way, double slip_px, double thickest_px) const {
    std::vector<std::pair<double, double>> pieces;
    for (const auto& s : strokes_)
      if (runs_along(s, way, thickest_px)) pieces.push_back(std::minmax(along(way, s.axis.a), along(way, s.axis.b)));
    std::sort(pieces.begin(), pieces.end());
    const double gap = slip_px / way.length();
    double from = 0, until = -1e300;
    for (const auto& [low, high] : pieces) {
      if (low > until + gap && !(until > -1e200 && is_hidden(way, until, low))) {
        if (until > 1) break;
        from = low;
      }
      until = std::max(until, high);
    }
    if (from > gap || until < 1 - gap) return std::nullopt;
    return std::pair{from, until};
  }

  /// An arrow or a sign lies over that part of the way.
  bool is_hidden(const Segment2& way, double from, double to) const {
    const Point2 d = way.b - way.a;
    return !hidden_.empty() && covered_share({way.a + from * d, way.a + to * d}, hidden_) > kHiddenGap;
  }

  /// Walls that dimension lines end at run on beyond their ticks.
  bool ends_at_ticks(const Tick& one, const Tick& two) const {
    const Segment2 way{one.p, two.p};
    const double longer = std::max(one.length, two.length), beyond = kOvershoot * longer / way.length();
    const auto whole = extent(way, kSlip * longer, thickest_beside(one));
    return whole && whole->first > -beyond && whole->second < 1 + beyond;
  }

  static bool runs_along(const InkStroke& stroke, const Segment2& way, double thickest_px) {
    const double off = stroke.thickness_px + 2;
    return stroke.thickness_px < thickest_px && line_angle_between(stroke.axis.heading(), way.heading()) < kOnLine &&
           std::abs(signed_line_distance(way, stroke.axis.a)) < off &&
           std::abs(signed_line_distance(way, stroke.axis.b)) < off;
  }

  /// Both ticks, and the strokes between them that do not run on much farther than dimension lines do.
  void take(const Tick& one, const Tick& two) {
    const Segment2 way{one.p, two.p};
    const double beyond = kOvershoot * std::max(one.length, two.length) / way.length();
    for (std::size_t i = 0; i < strokes_.size(); ++i) {
      if (!runs_along(strokes_[i], way, thickest_beside(one))) continue;
      const double a = along(way, strokes_[i].axis.a), b = along(way, strokes_[i].axis.b);
      if (std::min(a, b) > -beyond && std::max(a, b) < 1 + beyond) drop_[i] = true;
    }
  }

  /// The tick itself, and lines that run through it and end just beyond: they lead to what is measured.
  void take_leads(const Tick& tick) {
    for (std::size_t i = 0; i < strokes_.size(); ++i) {
      const auto& s = strokes_[i];
      if (drop_[i] || distance(s.axis, tick.p) > 0.3 * tick.length) continue;
      const double to_a = (s.axis.a - tick.p).norm(), to_b = (s.axis.b - tick.p).norm();
      const double turn = line_angle_between(s.axis.heading(), strokes_[tick.line].axis.heading());
      const bool leads =
          turn > kSquare && s.thickness_px < thickest_beside(tick) &&
          std::min(to_a, to_b) < kLeadOvershoot * tick.length &&
          in_the_air(to_a < to_b ? s.axis.a : s.axis.b, (to_a < to_b ? -1 : 1) * s.axis.direction(), 0.3 * tick.length);
      if (leads || std::max(to_a, to_b) < 0.8 * tick.length) drop_[i] = true;
    }
  }

  const std::vector<InkStroke>& strokes_;
  const cv::Mat &ink_, &hidden_;
  std::vector<bool> drop_;
  std::vector<Tick> ticks_;
};

}  // namespace

std::vector<InkStroke> without_dimensions(const std::vector<InkStroke>& strokes, const cv::Mat& ink,
                                          const cv::Mat& hidden) {
  const DimensionLines dimensions(strokes, ink, hidden);
  std::vector<InkStroke> kept;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!dimensions.holds(i)) kept.push_back(strokes[i]);
  return kept;
}

}  // namespace smokemap
