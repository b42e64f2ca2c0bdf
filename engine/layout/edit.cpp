#include "layout/edit.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace smokemap {
namespace {

int nearest_corner(const LayoutMap& map, const Point2& p, double reach_px) {
  int nearest = -1;
  double best = reach_px;
  for (std::size_t i = 0; i < map.corners.size(); ++i) {
    const double d = (map.corners[i].p_px - p).norm();
    if (d <= best) best = d, nearest = static_cast<int>(i);
  }
  return nearest;
}

int add_corner(LayoutMap& map, const Point2& p) {
  LayoutCorner corner;
  corner.p_px = p;
  map.corners.push_back(corner);
  return static_cast<int>(map.corners.size()) - 1;
}

/// The corner for an end: one that is there, a cut through a wall nearby, or a new one.
int corner_for(LayoutMap& map, const Point2& p, double snap_px) {
  if (const int there = nearest_corner(map, p, snap_px); there >= 0) return there;
  int cut = -1;
  double best = snap_px;
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const double d = distance(map.wall_px(static_cast<int>(w)), p);
    if (d <= best) best = d, cut = static_cast<int>(w);
  }
  if (cut < 0) return add_corner(map, p);
  const int middle = add_corner(map, closest_point(map.wall_px(cut), p));
  LayoutWall rest = map.walls[static_cast<std::size_t>(cut)];
  rest.corner_a = middle;
  map.walls[static_cast<std::size_t>(cut)].corner_b = middle;
  map.walls.push_back(rest);
  return middle;
}

}  // namespace

LayoutMap with_degrees(LayoutMap layout) {
  for (auto& c : layout.corners) c.degree = 0;
  for (const auto& w : layout.walls) {
    layout.corners[static_cast<std::size_t>(w.corner_a)].degree += 1;
    layout.corners[static_cast<std::size_t>(w.corner_b)].degree += 1;
  }
  return layout;
}

Result<LayoutMap> add_wall(LayoutMap layout, const Segment2& wall_px, double snap_px, double thickness_px) {
  if (!wall_px.a.allFinite() || !wall_px.b.allFinite())
    return fail(Errc::kInvalidArgument, "a wall end is not a number");
  if (!(snap_px >= 0) || !(thickness_px > 0))
    return fail(Errc::kInvalidArgument, "snap and thickness of a wall must be positive");
  const int a = corner_for(layout, wall_px.a, snap_px);
  const int b = corner_for(layout, wall_px.b, snap_px);
  if (a == b) return fail(Errc::kInvalidArgument, "both ends of the wall fall on the same corner");
  const bool there = std::any_of(layout.walls.begin(), layout.walls.end(), [&](const LayoutWall& w) {
    return (w.corner_a == a && w.corner_b == b) || (w.corner_a == b && w.corner_b == a);
  });
  if (there) return fail(Errc::kConflict, "this wall is in the plan already");
  layout.walls.push_back({a, b, thickness_px, 1.0, true});
  return with_degrees(std::move(layout));
}

Result<LayoutMap> remove_wall(LayoutMap layout, int wall) {
  if (wall < 0 || wall >= static_cast<int>(layout.walls.size()))
    return fail(Errc::kNotFound, "there is no wall " + std::to_string(wall));
  layout.walls.erase(layout.walls.begin() + wall);
  layout = with_degrees(std::move(layout));
  std::vector<int> place(layout.corners.size(), -1);
  std::vector<LayoutCorner> kept;
  for (std::size_t c = 0; c < layout.corners.size(); ++c) {
    if (layout.corners[c].degree == 0) continue;
    place[c] = static_cast<int>(kept.size());
    kept.push_back(layout.corners[c]);
  }
  layout.corners = std::move(kept);
  for (auto& w : layout.walls) {
    w.corner_a = place[static_cast<std::size_t>(w.corner_a)];
    w.corner_b = place[static_cast<std::size_t>(w.corner_b)];
  }
  return layout;
}

Result<LayoutMap> set_scale(LayoutMap layout, const Point2& a_px, const Point2& b_px, double length_m) {
  if (!(length_m > 0) || !std::isfinite(length_m)) return fail(Errc::kInvalidArgument, "the length must be positive");
  const double span_px = (a_px - b_px).norm();
  if (!(span_px >= 1) || !std::isfinite(span_px)) return fail(Errc::kInvalidArgument, "the two points are the same");
  // Each tap is off by about two pixels.
  layout.scale = LayoutScale{length_m / span_px, std::max(0.005, 2.8 / span_px), true};
  return layout;
}

}  // namespace smokemap
