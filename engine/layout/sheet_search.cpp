// Idea: the sides of a sheet are the only four long straight lines whose two banks differ along their whole length, and
// that end where they meet. Lines inside the sheet have paper on both banks; the outer edge of a picture frame has no
// paper behind it; the lower edge of a coloured header is no side, because the sheet's left and right edges go on
// beyond it.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "geometry/segment2.hpp"
#include "layout/sheet.hpp"

namespace smokemap {
namespace {

constexpr double kSearchSidePx = 900;
constexpr std::size_t kMostSides = 14;  ///< lines of each direction that are tried
constexpr int kSideSamples = 48;
constexpr double kSameLineDeg = 1.0, kSameLinePx = 2.5;
constexpr double kUnseenRim = 0.4;        ///< confidence left where one side's rim is not seen at full size
constexpr double kPerhapsFramed = 0.6;    ///< the most that is said of corners that may be a bright frame's
constexpr double kSeenRim = 0.75;         ///< share of a side at which its rim is seen, for full confidence
constexpr double kUnknownSigma = 0.25;    ///< of the picture, where nothing stands out
constexpr double kVanishingSigma = 0.05;  ///< of the picture: what a rectangle of the drawing says of the sheet's rim
constexpr double kStepGrey = 18;          ///< the least difference of two banks, any channel

/// A long edge; its ends are where it was seen.
struct SideLine {
  Segment2 seen;
  double length_px = 0;    ///< of the pieces it is made of
  bool is_border = false;  ///< of the picture itself: the sheet may go on outside
};

/// Pieces on one line become one, longest first.
std::vector<SideLine> joined_lines(std::vector<Segment2> pieces) {
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Segment2& a, const Segment2& b) { return a.length() > b.length(); });
  std::vector<SideLine> lines;
  for (const Segment2& piece : pieces) {
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const SideLine& line) {
      return line_angle_between(line.seen.heading(), piece.heading()) < radians(kSameLineDeg) &&
             std::abs(signed_line_distance(line.seen, piece.a)) < kSameLinePx &&
             std::abs(signed_line_distance(line.seen, piece.b)) < kSameLinePx;
    });
    if (same == lines.end()) {
      lines.push_back({piece, piece.length(), false});
      continue;
    }
    const double length = same->seen.length();
    const double low = along(same->seen, piece.a), high = along(same->seen, piece.b);
    const Segment2 old = same->seen;
    if (std::min(low, high) * length < -1) same->seen.a = low < high ? piece.a : piece.b;
    if (std::max(low, high) * length > length + 1) same->seen.b = low < high ? piece.b : piece.a;
    if (same->seen.length() < old.length()) same->seen = old;
    same->length_px += piece.length();
  }
  return lines;
}

/// Straight edges of any channel.
std::vector<Segment2> straight_pieces(const cv::Mat& small) {
  const double side = std::max(small.rows, small.cols);
  const auto detector = cv::createLineSegmentDetector(cv::LSD_REFINE_STD);
  std::vector<Segment2> pieces;
  for (int channel = 0; channel < 3; ++channel) {
    cv::Mat gray;
    cv::extractChannel(small, gray, channel);
    std::vector<cv::Vec4f> found;
    detector->detect(gray, found);
    for (const auto& l : found)
      if (const Segment2 s{Point2(l[0], l[1]), Point2(l[2], l[3])}; s.length() > 0.03 * side) pieces.push_back(s);
  }
  return pieces;
}

std::vector<SideLine> long_lines(std::vector<Segment2> pieces, double side) {
  auto lines = joined_lines(std::move(pieces));
  std::erase_if(lines, [&](const SideLine& line) { return line.seen.length() < 0.15 * side; });
  std::stable_sort(lines.begin(), lines.end(),
                   [](const SideLine& a, const SideLine& b) { return a.length_px > b.length_px; });
  return lines;
}

class SheetSearch {
 public:
  explicit SheetSearch(cv::Mat small)
      : small_(std::move(small)), side_(std::max(small_.rows, small_.cols)), step_(side_ / 300.0) {}

  struct Found {
    SheetCorners corners;
    double score = 0;
    double weakest_side = 0;
  };

  std::optional<Found> best(const std::vector<Segment2>& pieces) const {
    std::vector<SideLine> rows, columns;
    for (const SideLine& line : long_lines(pieces, side_)) {
      auto& family = line_angle_between(line.seen.heading(), 0) < radians(45) ? rows : columns;
      if (family.size() < kMostSides) family.push_back(line);
    }
    add_borders(rows, columns);
    std::optional<Found> best;
    for (const auto& [top, bottom] : pairs(rows, true))
      for (const auto& [left, right] : pairs(columns, false)) {
        const auto found = quad(*top, *right, *bottom, *left);
        if (found && (!best || found->score > best->score)) best = found;
      }
    return best;
  }

 private:
  using Pair = std::pair<const SideLine*, const SideLine*>;

  void add_borders(std::vector<SideLine>& rows, std::vector<SideLine>& columns) const {
    const double w = small_.cols - 1, h = small_.rows - 1;
    rows.push_back({{Point2(0, 0), Point2(w, 0)}, w, true});
    rows.push_back({{Point2(0, h), Point2(w, h)}, w, true});
    columns.push_back({{Point2(0, 0), Point2(0, h)}, h, true});
    columns.push_back({{Point2(w, 0), Point2(w, h)}, h, true});
  }

  /// Two lines of one family far enough apart, the upper (or left) one first.
  std::vector<Pair> pairs(const std::vector<SideLine>& family, bool rows) const {
    std::vector<Pair> out;
    const Point2 middle(0.5 * small_.cols, 0.5 * small_.rows);
    const auto place = [&](const SideLine& line) {
      const Point2 foot = line.seen.a + along(line.seen, middle) * (line.seen.b - line.seen.a);
      return rows ? foot.y() : foot.x();
    };
    for (const auto& one : family)
      for (const auto& two : family)
        if (place(two) - place(one) > 0.35 * (rows ? small_.rows : small_.cols)) out.emplace_back(&one, &two);
    return out;
  }

  std::optional<Found> quad(const SideLine& top, const SideLine& right, const SideLine& bottom,
                            const SideLine& left) const {
    const std::array<const SideLine*, 4> sides{&top, &right, &bottom, &left};
    Found found;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto p = line_intersection(sides[(i + 3) % 4]->seen, sides[i]->seen);
      const double margin = 0.1 * side_;
      if (!p || p->x() < -margin || p->y() < -margin || p->x() > small_.cols + margin || p->y() > small_.rows + margin)
        return std::nullopt;
      found.corners[i] = *p;
    }
    double area = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Point2 &p = found.corners[i], &q = found.corners[(i + 1) % 4];
      area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    }
    const double share = area / (static_cast<double>(small_.rows) * small_.cols);
    if (share < 0.2) return std::nullopt;
    found.score = 0.8 * share;
    found.weakest_side = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      const Segment2 edge{found.corners[i], found.corners[(i + 1) % 4]};
      const double support = sides[i]->is_border ? 0.3 : bank_difference(edge, 0.03, 0.97);
      const double printed = sides[i]->is_border ? 0 : paper_outside(edge);
      if (support < 0.25 || printed > 0.5) return std::nullopt;
      found.weakest_side = std::min(found.weakest_side, support);
      found.score += support + 0.5 * paper_behind(edge) - 0.7 * printed;
      if (sides[i]->is_border) continue;
      const double more = 0.06 * side_ / edge.length();
      found.score -=
          0.8 * (bank_difference(edge, -more, -0.2 * more) + bank_difference(edge, 1 + 0.2 * more, 1 + more));
    }
    return found;
  }

  bool inside(const Point2& p) const {
    return p.x() >= 0 && p.y() >= 0 && p.x() <= small_.cols - 1 && p.y() <= small_.rows - 1;
  }
  /// The nearest pixel of the picture: a side may lie outside it.
  cv::Vec3i at(const Point2& p) const {
    const auto within = [](double value, int size) {
      return std::clamp(static_cast<int>(std::lround(value)), 0, size - 1);
    };
    return small_.at<cv::Vec3b>(within(p.y(), small_.rows), within(p.x(), small_.cols));
  }
  static int largest(const cv::Vec3i& d) { return std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}); }

  /// Share of the stretch (0 = a, 1 = b) along which the strips on both sides differ. 0 where less than a third of it
  /// is in the picture.
  double bank_difference(const Segment2& edge, double from, double to) const {
    const Point2 n = edge.normal();
    int seen = 0, differ = 0;
    for (int i = 0; i < kSideSamples; ++i) {
      const Point2 p = edge.a + (from + (to - from) * (i + 0.5) / kSideSamples) * (edge.b - edge.a);
      if (!inside(p + 3 * step_ * n) || !inside(p - 3 * step_ * n)) continue;
      seen += 1;
      cv::Vec3i wide(0, 0, 0);
      for (const double offset : {1.0, 2.0, 3.0}) wide += at(p + offset * step_ * n) - at(p - offset * step_ * n);
      const cv::Vec3i near = at(p + 2 * n) - at(p - 2 * n);
      differ += largest(wide) > 3 * kStepGrey && 2 * largest(near) > kStepGrey;
    }
    return 3 * seen < kSideSamples ? 0 : static_cast<double>(differ) / seen;
  }

  /// Share of the side behind which the same colour goes on inwards. A frame gives way to paper there.
  double paper_behind(const Segment2& edge) const {
    Point2 n = edge.normal();
    const Point2 centre(0.5 * small_.cols, 0.5 * small_.rows);
    if (n.dot(centre - edge.midpoint()) < 0) n = -n;
    int seen = 0, alike = 0;
    for (int i = 0; i < kSideSamples; ++i) {
      const Point2 p = edge.a + (0.05 + 0.9 * (i + 0.5) / kSideSamples) * (edge.b - edge.a);
      const Point2 shallow = p + 3.5 * step_ * n, deep = p + 14 * step_ * n;
      if (!inside(shallow) || !inside(deep)) continue;
      seen += 1;
      alike += largest(at(shallow) - at(deep)) < 1.4 * kStepGrey;
    }
    return 3 * seen < kSideSamples ? 0 : static_cast<double>(alike) / seen;
  }

  /// Share of the side beyond which it looks like what is well inside, or brighter (in the darkest channel): that is
  /// the paper, and what lies inside was printed on it.
  double paper_outside(const Segment2& edge) const {
    Point2 n = edge.normal();
    const Point2 centre(0.5 * small_.cols, 0.5 * small_.rows);
    if (n.dot(centre - edge.midpoint()) < 0) n = -n;
    const auto darkest = [](const cv::Vec3i& c) { return std::min({c[0], c[1], c[2]}); };
    int seen = 0, brighter = 0;
    for (int i = 0; i < kSideSamples; ++i) {
      const Point2 p = edge.a + (0.05 + 0.9 * (i + 0.5) / kSideSamples) * (edge.b - edge.a);
      const std::array<Point2, 2> beyond{Point2(p - 2 * step_ * n), Point2(p - 5 * step_ * n)};  // past a thick wall
      if (!inside(beyond[0]) || !inside(beyond[1])) continue;
      int behind = 0;
      bool alike = false;
      for (const double depth : {14.0, 24.0, 34.0})  // a header may come first
        if (const Point2 deep = p + depth * step_ * n; inside(deep)) {
          behind = std::max(behind, darkest(at(deep)));
          for (const Point2& out : beyond) alike = alike || largest(at(out) - at(deep)) < kStepGrey;
        }
      seen += 1;
      brighter += alike || std::max(darkest(at(beyond[0])), darkest(at(beyond[1]))) > behind - 3;
    }
    return 3 * seen < kSideSamples ? 0 : static_cast<double>(brighter) / seen;
  }

  cv::Mat small_;
  double side_;
  double step_;  ///< a third of a percent of the side: how far from the line its banks are looked at
};

SheetCorners whole_picture(cv::Size size) {
  const double w = size.width - 1, h = size.height - 1;
  return {Point2(0, 0), Point2(w, 0), Point2(w, h), Point2(0, h)};
}

}  // namespace

SheetProposal propose_sheet(const cv::Mat& bgr) {
  SheetProposal proposal{whole_picture(bgr.size()), 0, kUnknownSigma * std::max(bgr.rows, bgr.cols)};
  const double shrink = std::max(1.0, std::max(bgr.rows, bgr.cols) / kSearchSidePx);
  if (std::min(bgr.rows, bgr.cols) / shrink < 16) return proposal;
  cv::Mat small;
  cv::resize(bgr, small, {}, 1 / shrink, 1 / shrink, cv::INTER_AREA);
  cv::GaussianBlur(small, small, {3, 3}, 0.8);
  const double shrink_x = static_cast<double>(bgr.cols) / small.cols,
               shrink_y = static_cast<double>(bgr.rows) / small.rows;
  const auto enlarge = [&](SheetCorners corners) {
    for (auto& p : corners) p = {(p.x() + 0.5) * shrink_x - 0.5, (p.y() + 0.5) * shrink_y - 0.5};
    return corners;
  };
  const auto pieces = straight_pieces(small);
  const auto found = SheetSearch(small).best(pieces);
  if (found && found->weakest_side > 0.3) {
    const RefinedSheet refined = refine_sheet(bgr, enlarge(found->corners));
    proposal.corners_px = refined.corners_px;
    proposal.sigma_px = refined.sigma_px;
    proposal.confidence = std::clamp((found->weakest_side - 0.3) / 0.6, 0.0, 1.0) *
                          (kUnseenRim + (1 - kUnseenRim) * std::min(1.0, refined.agreement / kSeenRim));
    if (may_be_framed(bgr, proposal.corners_px)) proposal.confidence = std::min(proposal.confidence, kPerhapsFramed);
  } else if (const auto vanishing = propose_by_vanishing_points(pieces, small.size())) {
    proposal = {enlarge(vanishing->corners_px), vanishing->confidence, kVanishingSigma * std::max(bgr.rows, bgr.cols)};
  }
  return proposal;
}

}  // namespace smokemap
