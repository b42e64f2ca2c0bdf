// Idea: a door is drawn as its open leaf and the way of its tip, a quarter of a circle about the hinge from the tip to
// the other jamb. No wall has such an arc, so where leaves are as thick as walls the arc tells them. A photograph may
// make an ellipse of it. The leaf stops at the face of the wall, the hinge lies anywhere in it.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "layout/drafting.hpp"
#include "layout/median.hpp"

namespace smokemap {
namespace {

constexpr double kLongestLeaf = 0.08;   ///< of the picture's long side
constexpr double kShortestLeafPx = 12;  ///< shorter arcs are no more than blots
constexpr double kSlenderLeaf = 4;      ///< times its thickness
constexpr double kDeepestHinge = 0.35;  ///< of the leaf's length: how far the hinge may lie beyond its end in the wall
constexpr double kMostSquashed = 0.24;  ///< of the radius
constexpr double kFrom = 0.2, kTo = 1.3, kStep = 0.05;  ///< rad from the leaf: where the arc must be drawn
constexpr int kMostMissing = 4;                         ///< of those places
constexpr int kLeastSeen = 9;                           ///< of those places: arrows and signs may lie over the others
constexpr int kSeenForOneMissing = 5;
constexpr double kWidestArc = 0.12;    ///< of its radius
constexpr double kThickerThanArc = 2;  ///< times: that is a stub of a wall beside a door
constexpr double kOffArcPx = 3.5;

/// The way of the tip: c + cos t * leaf + sin t * across, t from 0 to a right angle.
struct DoorArc {
  Point2 hinge = Point2::Zero(), leaf = Point2::Zero(), across = Point2::Zero();

  Point2 at(double t) const { return hinge + std::cos(t) * leaf + std::sin(t) * across; }
  /// The stroke lies on it.
  bool holds(const InkStroke& s) const {
    const double reach = kOffArcPx + 0.5 * s.thickness_px;
    const auto near = [&](const Point2& p) {
      const double x = (p - hinge).dot(leaf) / leaf.squaredNorm(), y = (p - hinge).dot(across) / across.squaredNorm();
      return x > -0.1 && y > -0.1 && std::abs(std::hypot(x, y) - 1) * leaf.norm() < reach;
    };
    return s.length() < 1.2 * leaf.norm() && near(s.axis.a) && near(s.axis.b) && near(s.axis.midpoint());
  }
};

class ArcFinder {
 public:
  ArcFinder(const cv::Mat& ink, const cv::Mat& hidden) : ink_(ink), hidden_(hidden) {}

  /// The arc of a leaf from about `hinge_end` to the tip: the one of which most is drawn.
  std::optional<DoorArc> find(const Point2& hinge_end, const Point2& tip, double thickness_px) const {
    const double length = (tip - hinge_end).norm();
    const Point2 u = (tip - hinge_end) / length;
    if (inked(tip + (1.5 * thickness_px + 4) * u)) return std::nullopt;  // it goes on, or ends at a wall
    const double band = std::max(2.0, 0.5 * thickness_px + 1);
    std::optional<DoorArc> best;
    int least = kMostMissing + 1;
    for (double deep = -thickness_px; deep <= kDeepestHinge * length; deep += 2)
      for (const double beyond : {-0.5, 0.0, 0.5, 1.0}) {  // a stroke may stop where it meets the arc
        const double radius = length + deep + beyond * thickness_px;
        for (double squashed = -kMostSquashed; squashed <= kMostSquashed; squashed += 0.04)
          for (const int side : {-1, 1}) {
            const Point2 across = side * (1 + squashed) * radius * Point2(-u.y(), u.x());
            const DoorArc arc{hinge_end - deep * u, radius * u, across};
            if (const int missed = missing(arc, band, least); missed < least) least = missed, best = arc;
          }
      }
    if (!best) return std::nullopt;
    const double arc_px = width(*best);
    if (thickness_px > kThickerThanArc * arc_px + 1 || arc_px > kWidestArc * best->leaf.norm()) return std::nullopt;
    return best;
  }

 private:
  static bool is_set(const cv::Mat& mask, const Point2& p) {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
  }
  bool inked(const Point2& p) const { return is_set(ink_, p); }
  /// At how many places that can be seen no thin line runs along it, ink with paper to both sides; `limit` if at so
  /// many or too little can be seen.
  int missing(const DoorArc& arc, double band_px, int limit) const {
    const double radius = arc.leaf.norm(), beside = (2 * band_px + 2) / radius;
    int missed = 0, seen = 0;
    for (double t = kFrom; t < kTo; t += kStep) {
      const Point2 p = arc.at(t), away = p - arc.hinge;
      if (is_set(hidden_, p)) continue;
      const bool line = inked(p) || inked(p + away / radius) || inked(p - away / radius);
      if (line && !inked(p + beside * away) && !inked(p - beside * away))
        ++seen;
      else if (++missed >= limit)
        return limit;
    }
    return seen >= std::max(kLeastSeen, kSeenForOneMissing * missed) ? missed : limit;
  }

  /// Of the line along it.
  double width(const DoorArc& arc) const {
    const double radius = arc.leaf.norm();
    std::vector<double> widths;
    for (double t = kFrom; t < kTo; t += kStep) {
      const Point2 p = arc.at(t), out = (p - arc.hinge) / radius;
      double inked_px = 0;
      for (double off = -0.2 * radius; off <= 0.2 * radius; off += 1) inked_px += inked(p + off * out);
      if (inked_px > 0) widths.push_back(inked_px);
    }
    return widths.empty() ? 0 : median_of(std::move(widths));
  }

  const cv::Mat &ink_, &hidden_;
};

}  // namespace

std::vector<bool> door_leaves(const std::vector<InkStroke>& strokes, const cv::Mat& ink, const cv::Mat& hidden) {
  const ArcFinder finder(ink, hidden);
  const double longest = kLongestLeaf * std::max(ink.rows, ink.cols);
  std::vector<DoorArc> arcs;
  std::vector<bool> found(strokes.size(), false);
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const auto& s = strokes[i];
    if (s.length() > longest || s.length() < std::max(kShortestLeafPx, kSlenderLeaf * s.thickness_px)) continue;
    for (const bool from_a : {true, false}) {
      const auto arc = finder.find(from_a ? s.axis.a : s.axis.b, from_a ? s.axis.b : s.axis.a, s.thickness_px);
      if (!arc) continue;
      found[i] = true;
      arcs.push_back(*arc);
      break;
    }
  }
  for (std::size_t i = 0; i < strokes.size(); ++i)
    found[i] = found[i] || std::any_of(arcs.begin(), arcs.end(), [&](const DoorArc& a) { return a.holds(strokes[i]); });
  return found;
}

}  // namespace smokemap
