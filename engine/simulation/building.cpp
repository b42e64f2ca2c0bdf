#include "simulation/building.hpp"

#include <algorithm>
#include <map>

#include "core/expect.hpp"

namespace smokemap {
namespace {

constexpr double kSamePlace = 1e-4;

int corner_at(std::vector<Point2>& corners, const Point2& p) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    if ((corners[i] - p).norm() < kSamePlace) return static_cast<int>(i);
  corners.push_back(p);
  return static_cast<int>(corners.size()) - 1;
}

/// The corners that lie on the side from `a` to `b`, both ends included, in order.
std::vector<int> corners_along(const std::vector<Point2>& corners, int a, int b) {
  const Segment2 side{corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)]};
  std::vector<std::pair<double, int>> on_side;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (distance(side, corners[i]) < kSamePlace) on_side.emplace_back(along(side, corners[i]), static_cast<int>(i));
  std::sort(on_side.begin(), on_side.end());
  std::vector<int> order;
  for (const auto& entry : on_side) order.push_back(entry.second);
  return order;
}

/// Where a gap of `width_m` around `p` fits into the wall, as shares of its length.
Result<std::pair<double, double>> fit_gap(const FloorPlan& plan, int wall, const Point2& p, double width_m,
                                          double jamb_m) {
  const Segment2 line = plan.wall_line(wall);
  const auto& ends = plan.walls[static_cast<std::size_t>(wall)];
  const auto margin = [&](int corner) {
    double thickest = 0;
    for (std::size_t i = 0; i < plan.walls.size(); ++i)
      if (static_cast<int>(i) != wall && (plan.walls[i].corner_a == corner || plan.walls[i].corner_b == corner))
        thickest = std::max(thickest, plan.walls[i].thickness_m);
    return thickest / 2 + jamb_m;
  };
  const double length = line.length();
  const double low = margin(ends.corner_a) + width_m / 2, high = length - margin(ends.corner_b) - width_m / 2;
  if (low > high) return fail(Errc::kDegenerate, "the wall is too short for an opening of this width");
  const double center = std::clamp(along(line, p) * length, low, high);
  return std::pair{(center - width_m / 2) / length, (center + width_m / 2) / length};
}

Result<int> wall_through(const FloorPlan& plan, const Point2& p) {
  int best = -1;
  double nearest = 0.05;
  for (std::size_t i = 0; i < plan.walls.size(); ++i) {
    const double away = distance(plan.wall_line(static_cast<int>(i)), p);
    if (away >= nearest) continue;
    nearest = away;
    best = static_cast<int>(i);
  }
  if (best >= 0) return best;
  return fail(Errc::kNotFound, "no wall passes through this place");
}

}  // namespace

Segment2 FloorPlan::wall_line(int wall) const {
  const PlanWall& w = walls[static_cast<std::size_t>(wall)];
  return {corners[static_cast<std::size_t>(w.corner_a)], corners[static_cast<std::size_t>(w.corner_b)]};
}

Segment2 FloorPlan::door_gap(int door) const {
  const PlanDoor& d = doors[static_cast<std::size_t>(door)];
  const Segment2 line = wall_line(d.wall);
  return {line.a + d.from * (line.b - line.a), line.a + d.to * (line.b - line.a)};
}

std::vector<Segment2> FloorPlan::wall_pieces(int wall) const {
  std::vector<std::pair<double, double>> gaps;
  for (const PlanDoor& door : doors)
    if (door.wall == wall) gaps.emplace_back(door.from, door.to);
  std::sort(gaps.begin(), gaps.end());
  gaps.emplace_back(1.0, 1.0);
  const Segment2 line = wall_line(wall);
  std::vector<Segment2> pieces;
  double from = 0;
  for (const auto& [begin, end] : gaps) {
    if (begin > from) pieces.push_back({line.a + from * (line.b - line.a), line.a + begin * (line.b - line.a)});
    from = end;
  }
  return pieces;
}

Polygon FloorPlan::outline(int room) const {
  Polygon ring;
  for (const int corner : rooms[static_cast<std::size_t>(room)].ring)
    ring.push_back(corners[static_cast<std::size_t>(corner)]);
  return ring;
}

int FloorPlan::room_at(const Point2& p) const {
  for (std::size_t i = 0; i < rooms.size(); ++i)
    if (contains(outline(static_cast<int>(i)), p)) return static_cast<int>(i);
  return -1;
}

std::pair<int, int> FloorPlan::rooms_beside(int wall) const {
  const PlanWall& w = walls[static_cast<std::size_t>(wall)];
  std::pair<int, int> beside{-1, -1};
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const std::vector<int>& ring = rooms[i].ring;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int a = ring[k], b = ring[(k + 1) % ring.size()];
      if (a == w.corner_a && b == w.corner_b)
        beside.first = static_cast<int>(i);  // counter-clockwise: room on the left
      if (b == w.corner_a && a == w.corner_b) beside.second = static_cast<int>(i);
    }
  }
  return beside;
}

Result<FloorPlan> wall_in(const std::vector<RoomOutline>& rooms, const WallStyle& style) {
  FloorPlan plan;
  std::vector<std::vector<int>> rings;
  for (const RoomOutline& room : rooms) {
    if (room.outline.size() < 3 || signed_area(room.outline) <= 0)
      return fail(Errc::kInvalidArgument,
                  "room " + room.name + " is no counter-clockwise ring of three or more corners");
    rings.emplace_back();
    for (const Point2& p : room.outline) rings.back().push_back(corner_at(plan.corners, p));
  }
  std::map<std::pair<int, int>, int> wall_between;  // smaller corner first
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    PlanRoom room{rooms[i].name, {}, rooms[i].corridor};
    for (std::size_t k = 0; k < rings[i].size(); ++k) {
      const std::vector<int> pieces = corners_along(plan.corners, rings[i][k], rings[i][(k + 1) % rings[i].size()]);
      for (std::size_t j = 0; j + 1 < pieces.size(); ++j) {
        room.ring.push_back(pieces[j]);
        const auto [a, b] = std::minmax(pieces[j], pieces[j + 1]);
        const auto [known, is_new] = wall_between.try_emplace({a, b}, static_cast<int>(plan.walls.size()));
        if (is_new)
          plan.walls.push_back({pieces[j], pieces[j + 1], style.outer_thickness_m, style.outer_material, true});
        else  // seen from its second room
          plan.walls[static_cast<std::size_t>(known->second)] = {a, b, style.inner_thickness_m, style.inner_material,
                                                                 false};
      }
    }
    plan.rooms.push_back(std::move(room));
  }
  return plan;
}

Result<Ok> add_door(FloorPlan& plan, const Point2& p, double width_m, double jamb_m) {
  const auto wall = wall_through(plan, p);
  if (!wall) return wall.error();
  const auto gap = fit_gap(plan, *wall, p, width_m, jamb_m);
  if (!gap) return gap.error();
  for (const PlanDoor& door : plan.doors)
    if (door.wall == *wall && door.from < gap->second && gap->first < door.to)
      return fail(Errc::kConflict, "there is a door already");
  PlanDoor door;
  door.wall = *wall;
  door.from = gap->first;
  door.to = gap->second;
  plan.doors.push_back(door);
  return Ok{};
}

Result<Ok> add_window(FloorPlan& plan, const Point2& p, double width_m) {
  const auto wall = wall_through(plan, p);
  if (!wall) return wall.error();
  const auto gap = fit_gap(plan, *wall, p, width_m, 0.2);
  if (!gap) return gap.error();
  plan.windows.push_back({*wall, gap->first, gap->second});
  return Ok{};
}

}  // namespace smokemap
