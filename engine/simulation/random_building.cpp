#include "simulation/random_building.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/check.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

double to_grid(double v) { return std::round(v * 20) / 20; }  // 5 cm: shared walls meet exactly

/// Cuts [low, high] into rooms of min..max each; the cuts, ends included.
std::vector<double> cuts(double low, double high, const RandomBuildingParams& params, std::mt19937_64& random) {
  const double length = high - low;
  const int fewest = std::max(1, static_cast<int>(std::ceil(length / params.max_room_m)));
  const int most = std::max(fewest, static_cast<int>(length / params.min_room_m));
  const int count =
      std::clamp(static_cast<int>(std::lround(2 * length / (params.min_room_m + params.max_room_m))), fewest, most);
  for (int attempt = 0; attempt < 60; ++attempt) {
    std::vector<double> widths;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
      widths.push_back(uniform(random, params.min_room_m, params.max_room_m));
      sum += widths.back();
    }
    std::vector<double> at{low};
    bool fits = true;
    for (int i = 0; i < count; ++i) {
      const double width = widths[static_cast<std::size_t>(i)] * length / sum;
      fits = fits && width >= params.min_room_m && width <= params.max_room_m;
      at.push_back(i + 1 == count ? high : to_grid(at.back() + width));
    }
    if (fits) return at;
  }
  std::vector<double> even;
  for (int i = 0; i <= count; ++i) even.push_back(i == count ? high : to_grid(low + length * i / count));
  return even;
}

struct Rooms {
  std::vector<RoomOutline> outlines;
  void add(const std::string& name, double x0, double y0, double x1, double y1, bool corridor = false) {
    outlines.push_back({name, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, corridor});
  }
};

/// A room of the building, perhaps divided into an outer part (towards the corridor) and an inner one.
void add_room(Rooms& rooms, char wing, Point2 low, Point2 high, const RandomBuildingParams& params,
              std::mt19937_64& random) {
  const auto name = [&] { return wing + std::to_string(100 + rooms.outlines.size()); };
  const Point2 size = high - low;
  const int axis = size.x() > size.y() ? 0 : 1;
  const bool split = uniform01(random) < params.split_share && size[axis] > 2 * 2.2;
  if (split) {
    const double at = to_grid(low[axis] + size[axis] * uniform(random, 0.45, 0.55));
    Point2 middle_high = high, middle_low = low;
    middle_high[axis] = middle_low[axis] = at;
    rooms.add(name(), low.x(), low.y(), middle_high.x(), middle_high.y());
    rooms.add(name(), middle_low.x(), middle_low.y(), high.x(), high.y());
    return;
  }
  rooms.add(name(), low.x(), low.y(), high.x(), high.y());
}

/// An L: the lower wing along x, the other one up its right end. Corridors first, then rooms row by row.
Rooms two_wings(const RandomBuildingParams& params, std::mt19937_64& random) {
  const auto depth = [&] { return to_grid(params.room_depth_m * uniform(random, 0.9, 1.1)); };
  const double length = to_grid(params.length_m), top = to_grid(params.depth_m);
  const double corridor_low = depth(), corridor_high = to_grid(corridor_low + params.corridor_m);
  const double wing_high = corridor_high + depth();
  const double east = length - depth(), west = to_grid(east - params.corridor_m), wing_left = west - depth();

  Rooms rooms;
  rooms.add("Corridor A", 0, corridor_low, east, corridor_high, true);
  rooms.add("Corridor B", west, corridor_high, east, top, true);
  auto lower = cuts(0, length, params, random);
  while (lower.size() > 2 && lower[lower.size() - 2] > east - 1.6) lower.erase(lower.end() - 2);  // needs the corridor
  for (std::size_t i = 0; i + 1 < lower.size(); ++i)
    add_room(rooms, 'A', {lower[i], 0}, {lower[i + 1], corridor_low}, params, random);
  const auto upper = cuts(0, west, params, random);
  for (std::size_t i = 0; i + 1 < upper.size(); ++i)
    add_room(rooms, 'A', {upper[i], corridor_high}, {upper[i + 1], wing_high}, params, random);
  const auto eastern = cuts(corridor_low, top, params, random);
  for (std::size_t i = 0; i + 1 < eastern.size(); ++i)
    add_room(rooms, 'B', {east, eastern[i]}, {length, eastern[i + 1]}, params, random);
  const auto western = cuts(wing_high, top, params, random);
  for (std::size_t i = 0; i + 1 < western.size(); ++i)
    add_room(rooms, 'B', {wing_left, western[i]}, {west, western[i + 1]}, params, random);
  return rooms;
}

void mirror(Rooms& rooms, int axis, double extent) {
  for (RoomOutline& room : rooms.outlines) {
    for (Point2& p : room.outline) p[axis] = extent - p[axis];
    std::reverse(room.outline.begin(), room.outline.end());
  }
}

class DoorMaker {
 public:
  DoorMaker(FloorPlan& plan, const RandomBuildingParams& params, std::mt19937_64& random)
      : plan_(plan), params_(params), random_(random), reached_(plan.rooms.size(), false) {
    for (std::size_t i = 0; i < plan.walls.size(); ++i) beside_.push_back(plan.rooms_beside(static_cast<int>(i)));
  }

  /// Every room gets a way to a corridor: directly where it borders one, else through a neighbour.
  void connect() {
    add_between(0, 1, 1.4);
    reached_[0] = reached_[1] = true;
    for (std::size_t room = 2; room < plan_.rooms.size(); ++room)
      reached_[room] =
          add_between(static_cast<int>(room), 0, width()) || add_between(static_cast<int>(room), 1, width());
    for (bool more = true; more;) {
      more = false;
      for (std::size_t room = 2; room < plan_.rooms.size(); ++room)
        if (!reached_[room] && add_to_reached(static_cast<int>(room))) reached_[room] = more = true;
    }
  }

  void add_second_doors() {
    for (std::size_t room = 2; room < plan_.rooms.size(); ++room) {
      if (uniform01(random_) >= params_.double_door_share) continue;
      const std::size_t other = uniform_index(random_, plan_.rooms.size());
      if (other != room) add_between(static_cast<int>(room), static_cast<int>(other), width());
    }
  }

  bool add_between(int room, int other, double width_m) {
    int best = -1;
    for (std::size_t i = 0; i < plan_.walls.size(); ++i) {
      if (beside_[i] != std::pair(room, other) && beside_[i] != std::pair(other, room)) continue;
      const auto wall = static_cast<int>(i);
      if (best < 0 || plan_.wall_line(wall).length() > plan_.wall_line(best).length()) best = wall;
    }
    if (best < 0) return false;
    const Segment2 line = plan_.wall_line(best);
    const Point2 p = line.a + uniform(random_, 0.15, 0.85) * (line.b - line.a);
    if (!add_door(plan_, p, width_m)) return false;
    PlanDoor& door = plan_.doors.back();
    door.hinge_at_to = uniform01(random_) < 0.5;
    door.swings_left = beside_[static_cast<std::size_t>(best)].first == room;  // into the room, not the corridor
    door.has_leaf = other >= 0 && uniform01(random_) < params_.leaf_share;
    door.open_rad = uniform(random_, 0.5, 0.6) * kPi;
    return true;
  }

 private:
  double width() { return to_grid(uniform(random_, params_.min_door_m, params_.max_door_m)); }

  bool add_to_reached(int room) {
    for (std::size_t other = 0; other < plan_.rooms.size(); ++other)
      if (reached_[other] && add_between(room, static_cast<int>(other), width())) return true;
    return false;
  }

  FloorPlan& plan_;
  const RandomBuildingParams& params_;
  std::mt19937_64& random_;
  std::vector<std::pair<int, int>> beside_;
  std::vector<bool> reached_;
};

/// Exits at the far ends of the corridors, shut.
void add_exits(FloorPlan& plan, const Point2& end_a, const Point2& end_b) {
  for (const Point2& end : {end_a, end_b}) {
    if (!add_door(plan, end, 1.2)) continue;
    plan.doors.back().has_leaf = true;
    plan.doors.back().swings_left = plan.rooms_beside(plan.doors.back().wall).first < 0;  // outwards
  }
}

void add_windows(FloorPlan& plan) {
  for (std::size_t i = 0; i < plan.walls.size(); ++i) {
    if (!plan.walls[i].outer) continue;
    const auto [left, right] = plan.rooms_beside(static_cast<int>(i));
    if (plan.rooms[static_cast<std::size_t>(std::max(left, right))].corridor) continue;
    const Segment2 line = plan.wall_line(static_cast<int>(i));
    if (line.length() > 2.2) (void)add_window(plan, line.midpoint(), std::min(0.5 * line.length(), 1.8)).ok();
  }
}

/// Boxes with their back to a wall, away from doors.
void furnish(FloorPlan& plan, int count, std::mt19937_64& random) {
  for (int attempt = 0; attempt < 20 * count && static_cast<int>(plan.furniture.size()) < count; ++attempt) {
    const auto wall = static_cast<int>(uniform_index(random, plan.walls.size()));
    const auto beside = plan.rooms_beside(wall);
    const bool left = uniform01(random) < 0.5;
    const int room = left ? beside.first : beside.second;
    const double width = uniform(random, 0.5, 1.2), depth = uniform(random, 0.35, 0.6);
    const Segment2 line = plan.wall_line(wall);
    if (room < 0 || plan.rooms[static_cast<std::size_t>(room)].corridor || line.length() < width + 0.8) continue;
    const Point2 u = line.direction(), inward = left ? line.normal() : Point2(-line.normal());
    const Point2 back = line.a + uniform(random, 0.4, line.length() - width - 0.4) * u +
                        plan.walls[static_cast<std::size_t>(wall)].thickness_m / 2 * inward;
    const Point2 center = back + width / 2 * u + depth / 2 * inward;
    bool in_the_way = false;
    for (std::size_t d = 0; d < plan.doors.size(); ++d)
      in_the_way = in_the_way || (plan.door_gap(static_cast<int>(d)).midpoint() - center).norm() < 1.7;
    for (const Polygon& other : plan.furniture) in_the_way = in_the_way || (centroid(other) - center).norm() < 2.0;
    if (!in_the_way)
      plan.furniture.push_back({back, back + width * u, back + width * u + depth * inward, back + depth * inward});
  }
}

}  // namespace

Result<Ok> RandomBuildingParams::validate() const {
  return ParamCheck("RandomBuildingParams")
      .in_range("length_m", length_m, 12, 200)
      .in_range("corridor_m", corridor_m, 1.8, 6)
      .in_range("room_depth_m", room_depth_m, 2.5, 12)
      .in_range("depth_m", depth_m, 2.2 * room_depth_m + corridor_m + min_room_m, 200)
      .in_range("min_room_m", min_room_m, 2.2, 20)
      .in_range("max_room_m", max_room_m, 1.5 * min_room_m, 40)
      .in_range("min_door_m", min_door_m, 0.7, 1.6)
      .in_range("max_door_m", max_door_m, min_door_m, 1.6)
      .in_range("double_door_share", double_door_share, 0, 1)
      .in_range("split_share", split_share, 0, 1)
      .in_range("leaf_share", leaf_share, 0, 1)
      .in_range("furniture", furniture, 0, 500)
      .result();
}

Result<FloorPlan> random_building(const RandomBuildingParams& params, std::mt19937_64& random) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  Rooms rooms = two_wings(params, random);
  if (uniform01(random) < 0.5) mirror(rooms, 0, to_grid(params.length_m));
  if (uniform01(random) < 0.5) mirror(rooms, 1, to_grid(params.depth_m));
  auto plan = wall_in(rooms.outlines, params.walls);
  if (!plan) return plan.error();
  plan->title = "Two-wing building";

  // Corridor A runs along x from the outside to wing B, corridor B along y from A to the outside.
  const Polygon &a = rooms.outlines[0].outline, &b = rooms.outlines[1].outline;
  const double b_x = centroid(b).x(), a_y = centroid(a).y();
  Point2 end_a = centroid(a), end_b = centroid(b);
  for (const Point2& p : a)
    if (std::abs(p.x() - b_x) > std::abs(end_a.x() - b_x)) end_a.x() = p.x();
  for (const Point2& p : b)
    if (std::abs(p.y() - a_y) > std::abs(end_b.y() - a_y)) end_b.y() = p.y();
  DoorMaker doors(*plan, params, random);
  doors.connect();
  doors.add_second_doors();
  add_exits(*plan, end_a, end_b);
  add_windows(*plan);
  furnish(*plan, params.furniture, random);
  return std::move(*plan);
}

}  // namespace smokemap
