// Idea: people lift the pen too early, overshoot, and leave doors open. Every loose end of a wall stroke looks for what
// it was meant to meet. What is near is joined; what is a little further is an opening.
#include "sketch/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace smokemap {
namespace {

struct End {
  std::size_t stroke = 0;
  bool last = false;
  Point2 p = Point2::Zero();
  Point2 outward = Point2::Zero();
};

/// Direction in which the pen was moving when it left: over the last few pens' width, so that a hook does not mislead.
Point2 tangent_at(const Stroke& stroke, bool last, double reach_px) {
  const auto& points = stroke.points_px;
  const Point2 end = last ? points.back() : points.front();
  const std::size_t n = points.size();
  for (std::size_t i = 1; i < n; ++i) {
    const Point2 d = end - points[last ? n - 1 - i : i];
    if (d.norm() >= reach_px || i + 1 == n) return d.norm() > 0 ? Point2(d.normalized()) : Point2(Point2::Zero());
  }
  return Point2::Zero();
}

struct Meeting {
  Point2 p = Point2::Zero();
  double gap = 0;
};

class GapFinder {
 public:
  GapFinder(const std::vector<Stroke>& walls, double extent, const SketchParams& params)
      : walls_(walls), extent_(extent), params_(params) {
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      if (walls_[i].points_px.size() < 2) continue;
      for (const bool last : {false, true})
        ends_.push_back({i, last, last ? walls_[i].points_px.back() : walls_[i].points_px.front(),
                         tangent_at(walls_[i], last, params.join_share * extent_)});
    }
  }

  std::vector<SketchGap> find() const {
    std::vector<SketchGap> gaps;
    for (const auto& end : ends_) {
      const auto near = nearest(end, params_.close_gap_share * extent_, -1.0);
      if (near && near->gap <= 1.5 * walls_[end.stroke].width_px) continue;  // touches already
      if (overshoots(end)) continue;
      if (near) {
        add(gaps, {{end.p, near->p}, true});
        continue;
      }
      if (const auto far = nearest(end, params_.report_gap_share * extent_, 0.5)) add(gaps, {{end.p, far->p}, false});
    }
    return gaps;
  }

 private:
  /// True where the pen only ran on a little past the line that it was to meet.
  bool overshoots(const End& end) const {
    const auto& points = walls_[end.stroke].points_px;
    const std::size_t n = points.size();
    const double reach = params_.close_gap_share * extent_;
    double walked = 0;
    for (std::size_t k = 0; k + 1 < n && walked < reach; ++k) {
      Segment2 piece{points[end.last ? n - 1 - k : k], points[end.last ? n - 2 - k : k + 1]};
      if (walked + piece.length() > reach) piece.b = piece.a + (reach - walked) * piece.direction();
      walked += piece.length();
      for (std::size_t j = 0; j < walls_.size(); ++j) {
        if (j == end.stroke) continue;
        const auto& others = walls_[j].points_px;
        const double touch = 0.5 * (walls_[j].width_px + walls_[end.stroke].width_px);
        for (std::size_t i = 0; i + 1 < others.size(); ++i) {
          const Segment2 other{others[i], others[i + 1]};
          if (intersection(piece, other) || distance(other, piece.b) < touch) return true;
        }
      }
    }
    return false;
  }

  /// Nearest place of another stroke (or of its own, far along it) within reach, and within the cone ahead.
  std::optional<Meeting> nearest(const End& end, double reach, double min_cosine) const {
    std::optional<Meeting> best;
    const auto consider = [&](const Point2& p, double handicap) {
      const Point2 d = p - end.p;
      const double gap = d.norm();
      if (gap > reach || (gap > 1e-9 && d.dot(end.outward) < min_cosine * gap)) return;
      if (!best || gap * handicap < best->gap) best = Meeting{p, gap * handicap};
    };
    for (std::size_t j = 0; j < walls_.size(); ++j) {
      const auto& points = walls_[j].points_px;
      double walked = 0;  // along its own stroke, from this end
      const std::size_t n = points.size();
      for (std::size_t k = 0; k + 1 < n; ++k) {
        const std::size_t i = end.last ? n - 2 - k : k;
        const Segment2 piece{points[i], points[i + 1]};
        walked += piece.length();
        if (j == end.stroke && walked < 3 * (piece.midpoint() - end.p).norm()) continue;  // still its own tail
        if (j == end.stroke && walked - piece.length() < 0.5 * reach) continue;
        consider(closest_point(piece, end.p), 1.0);
      }
      if (n == 1) consider(points.front(), 1.0);
    }
    for (const auto& other : ends_)
      if (other.stroke != end.stroke || other.last != end.last) {
        if (other.stroke == end.stroke && walls_[end.stroke].points_px.size() < 4) continue;
        consider(other.p, 0.85);  // an end that faces an end is meant to meet it
      }
    if (best) best->gap = (best->p - end.p).norm();
    return best;
  }
  /// The same opening seen from both sides counts once.
  void add(std::vector<SketchGap>& gaps, const SketchGap& gap) const {
    const double same = 0.5 * gap.gap_px.length() + params_.join_share * extent_ * 0.5;
    const bool there = std::any_of(gaps.begin(), gaps.end(), [&](const SketchGap& g) {
      return (g.gap_px.midpoint() - gap.gap_px.midpoint()).norm() < 0.5 * same && g.closed_by_us == gap.closed_by_us;
    });
    if (!there) gaps.push_back(gap);
  }

  const std::vector<Stroke>& walls_;
  double extent_;
  const SketchParams& params_;
  std::vector<End> ends_;
};

}  // namespace

std::vector<SketchGap> find_gaps(const std::vector<Stroke>& walls, double extent_px, const SketchParams& params) {
  return GapFinder(walls, extent_px, params).find();
}

}  // namespace smokemap
