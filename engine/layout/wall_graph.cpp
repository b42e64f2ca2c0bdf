#include "layout/wall_graph.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace smokemap {
namespace {

constexpr double kCrossingAngle = 0.3;                // rad: flatter crossings are continuations
constexpr double kLikeConfidence = 0.3;               // of walls that become one: what signs hide stays doubtful
constexpr double kLeastBend = 0.07, kMostBend = 0.6;  // rad: between chords of one curved wall

/// A stroke whose ends may have moved, with the places where others meet it.
struct GraphStroke {
  Segment2 axis;
  double thickness_px = 0;
  double confidence = 0;
  std::vector<double> cuts;  ///< distances from axis.a
};

double confidence_of(const InkStroke& s) { return std::clamp(s.coverage * std::min(1.0, 0.35 + s.darkness), 0.0, 1.0); }

/// How far beyond (or before) its end the stroke meets the other's line; the nearest one wins.
Point2 snapped_end(const std::vector<InkStroke>& strokes, std::size_t self, bool at_b, double snap_px) {
  const auto& s = strokes[self];
  const Point2 end = at_b ? s.axis.b : s.axis.a;
  const Point2 outward = at_b ? s.axis.direction() : Point2(-s.axis.direction());
  double best = 1e300;
  Point2 target = end;
  for (std::size_t j = 0; j < strokes.size(); ++j) {
    if (j == self) continue;
    const auto& o = strokes[j];
    const double turn = line_angle_between(s.axis.heading(), o.axis.heading());
    const double half = 0.5 * o.thickness_px;
    if (turn > kCrossingAngle) {
      const auto meeting = line_intersection(s.axis, o.axis);
      if (!meeting) continue;
      const double ahead = (*meeting - end).dot(outward);
      const double steep = std::max(0.3, std::sin(turn));
      if (ahead > (half + snap_px) / steep || ahead < -(half + snap_px) / steep || -ahead > 0.6 * s.length()) continue;
      const double beyond = distance(o.axis, *meeting);
      if (beyond > 0.5 * s.thickness_px + snap_px) continue;
      const double cost = std::abs(ahead) + beyond;
      if (cost < best) best = cost, target = *meeting;
    } else {
      for (const Point2& other_end : {o.axis.a, o.axis.b}) {
        const double ahead = (other_end - end).dot(outward);
        if (std::abs(ahead) > snap_px ||
            std::abs(signed_line_distance(s.axis, other_end)) > 0.7 * std::max(s.thickness_px, o.thickness_px))
          continue;
        const bool faces = (o.axis.midpoint() - other_end).dot(outward) > 0;
        const double cost = (other_end - end).norm() + snap_px * 0.5;
        if (faces && cost < best) best = cost, target = 0.5 * (other_end + end);
      }
    }
  }
  return target;
}

/// One end of a stroke where the wall bends.
struct Bend {
  std::size_t stroke = 0;
  bool at_b = false;
};

/// A curved wall comes as a chain of chords that overlap or nearly touch: neighbours are cut, or carried on, to where
/// they cross. Chords of a gentle bend only; sharper turns are corners.
std::vector<InkStroke> joined_at_bends(std::vector<InkStroke> strokes) {
  struct Joint {
    Bend one, two;
    Point2 p = Point2::Zero();
    double moved_px = 0;
  };
  std::vector<Joint> joints;
  const auto end_near = [&](std::size_t i, const Point2& p) {
    return Bend{i, (strokes[i].axis.b - p).squaredNorm() < (strokes[i].axis.a - p).squaredNorm()};
  };
  const auto end_of = [&](const Bend& b) { return b.at_b ? strokes[b.stroke].axis.b : strokes[b.stroke].axis.a; };
  const auto may_move = [&](const Bend& b, const Point2& p) {
    const auto& s = strokes[b.stroke];
    const Point2 outward = b.at_b ? s.axis.direction() : Point2(-s.axis.direction());
    const double ahead = (p - end_of(b)).dot(outward);
    return s.length() > 2.5 * s.thickness_px && ahead < 1.5 * s.thickness_px + 2 && -ahead < 0.45 * s.length();
  };
  for (std::size_t i = 0; i < strokes.size(); ++i)
    for (std::size_t j = i + 1; j < strokes.size(); ++j) {
      const double turn = line_angle_between(strokes[i].axis.heading(), strokes[j].axis.heading());
      if (turn < kLeastBend || turn > kMostBend) continue;
      const auto p = line_intersection(strokes[i].axis, strokes[j].axis);
      if (!p) continue;
      const Bend one = end_near(i, *p), two = end_near(j, *p);
      if (!may_move(one, *p) || !may_move(two, *p)) continue;
      joints.push_back({one, two, *p, (end_of(one) - *p).norm() + (end_of(two) - *p).norm()});
    }
  std::stable_sort(joints.begin(), joints.end(),
                   [](const Joint& a, const Joint& b) { return a.moved_px < b.moved_px; });
  std::set<std::pair<std::size_t, bool>> used;
  for (const auto& joint : joints) {
    if (used.count({joint.one.stroke, joint.one.at_b}) || used.count({joint.two.stroke, joint.two.at_b})) continue;
    for (const Bend& b : {joint.one, joint.two}) {
      used.insert({b.stroke, b.at_b});
      (b.at_b ? strokes[b.stroke].axis.b : strokes[b.stroke].axis.a) = joint.p;
    }
  }
  return strokes;
}

void cut_where_others_meet(std::vector<GraphStroke>& strokes) {
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    auto& s = strokes[i];
    const double length = s.axis.length();
    s.cuts = {0, length};
    for (std::size_t j = 0; j < strokes.size(); ++j) {
      if (i == j) continue;
      const auto& o = strokes[j];
      if (const auto p = intersection(s.axis, o.axis);
          p && line_angle_between(s.axis.heading(), o.axis.heading()) > kCrossingAngle)
        s.cuts.push_back(along(s.axis, *p) * length);
      for (const Point2& end : {o.axis.a, o.axis.b})
        if (distance(s.axis, end) < 1.5) s.cuts.push_back(std::clamp(along(s.axis, end) * length, 0.0, length));
    }
    std::sort(s.cuts.begin(), s.cuts.end());
  }
}

class CornerSet {
 public:
  explicit CornerSet(double radius_px) : radius_px_(radius_px) {}
  int at(const Point2& p) {
    int nearest = -1;
    double best = radius_px_;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const double d = (corners_[i].p_px - p).norm();
      if (d < best) best = d, nearest = static_cast<int>(i);
    }
    if (nearest >= 0) return nearest;
    LayoutCorner corner;
    corner.p_px = p;
    corners_.push_back(corner);
    return static_cast<int>(corners_.size()) - 1;
  }
  std::vector<LayoutCorner> take() { return std::move(corners_); }

 private:
  double radius_px_;
  std::vector<LayoutCorner> corners_;
};

}  // namespace

LayoutMap build_wall_graph(const std::vector<InkStroke>& chosen, double thickness_px, const LayoutParams& params) {
  const auto walls = joined_at_bends(chosen);
  const double snap_px = std::max(3.0, params.snap_walls * 0.5 * thickness_px);
  std::vector<GraphStroke> strokes;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Segment2 axis{snapped_end(walls, i, false, snap_px), snapped_end(walls, i, true, snap_px)};
    if (axis.length() > 1) strokes.push_back({axis, walls[i].thickness_px, confidence_of(walls[i]), {}});
  }
  cut_where_others_meet(strokes);
  LayoutMap map;
  CornerSet corners(std::max(2.0, 0.5 * thickness_px));
  // Crossings first: a loose end joins a crossing, not the other way round.
  for (const auto& s : strokes)
    for (std::size_t c = 1; c + 1 < s.cuts.size(); ++c) corners.at(s.axis.a + s.cuts[c] * s.axis.direction());
  std::set<std::pair<int, int>> seen;
  for (const auto& s : strokes)
    for (std::size_t c = 1; c < s.cuts.size(); ++c) {
      const int a = corners.at(s.axis.a + s.cuts[c - 1] * s.axis.direction());
      const int b = corners.at(s.axis.a + s.cuts[c] * s.axis.direction());
      if (a == b || !seen.insert({std::min(a, b), std::max(a, b)}).second) continue;
      map.walls.push_back({a, b, s.thickness_px, s.confidence, false});
    }
  map.corners = corners.take();
  for (const auto& w : map.walls) {
    map.corners[static_cast<std::size_t>(w.corner_a)].degree += 1;
    map.corners[static_cast<std::size_t>(w.corner_b)].degree += 1;
  }
  return map;
}

LayoutMap without_straight_corners(LayoutMap map) {
  std::vector<std::vector<std::size_t>> walls_at(map.corners.size());
  for (std::size_t w = 0; w < map.walls.size(); ++w)
    for (const int c : {map.walls[w].corner_a, map.walls[w].corner_b})
      walls_at[static_cast<std::size_t>(c)].push_back(w);
  std::vector<bool> gone(map.walls.size(), false);
  const auto other_end = [&](std::size_t wall, int corner) {
    return map.walls[wall].corner_a == corner ? map.walls[wall].corner_b : map.walls[wall].corner_a;
  };
  for (std::size_t c = 0; c < map.corners.size(); ++c) {
    if (walls_at[c].size() != 2) continue;
    const int corner = static_cast<int>(c);
    const std::size_t one = walls_at[c][0], two = walls_at[c][1];
    const int from = other_end(one, corner), to = other_end(two, corner);
    const Segment2 first = map.wall_px(static_cast<int>(one)), second = map.wall_px(static_cast<int>(two));
    const Segment2 whole{map.corners[static_cast<std::size_t>(from)].p_px,
                         map.corners[static_cast<std::size_t>(to)].p_px};
    const auto& p = map.corners[c].p_px;
    const double thick = std::max(map.walls[one].thickness_px, map.walls[two].thickness_px);
    if (std::abs(map.walls[one].confidence - map.walls[two].confidence) > kLikeConfidence) continue;
    if (from == to || (whole.a - p).dot(whole.b - p) > 0 || distance(whole, p) > 0.2 * thick ||
        line_angle_between(first.heading(), second.heading()) > 0.5 * kLeastBend)
      continue;
    const double share = first.length() / std::max(1e-9, first.length() + second.length());
    auto& kept = map.walls[one];
    const auto& lost = map.walls[two];
    kept.thickness_px = share * kept.thickness_px + (1 - share) * lost.thickness_px;
    kept.confidence = share * kept.confidence + (1 - share) * lost.confidence;
    kept.by_person |= lost.by_person;
    kept.corner_a = from, kept.corner_b = to;
    gone[two] = true;
    walls_at[c].clear();
    std::replace(walls_at[static_cast<std::size_t>(to)].begin(), walls_at[static_cast<std::size_t>(to)].end(), two,
                 one);
  }
  LayoutMap out = map;
  out.corners.clear(), out.walls.clear();
  std::vector<int> place(map.corners.size(), -1);
  for (std::size_t c = 0; c < map.corners.size(); ++c) {
    if (walls_at[c].empty()) continue;
    place[c] = static_cast<int>(out.corners.size());
    out.corners.push_back(map.corners[c]);
    out.corners.back().degree = static_cast<int>(walls_at[c].size());
  }
  for (std::size_t w = 0; w < map.walls.size(); ++w)
    if (!gone[w]) {
      LayoutWall wall = map.walls[w];
      wall.corner_a = place[static_cast<std::size_t>(wall.corner_a)];
      wall.corner_b = place[static_cast<std::size_t>(wall.corner_b)];
      out.walls.push_back(wall);
    }
  return out;
}

}  // namespace smokemap
