#include "core/expect.hpp"
#include "simulation/building.hpp"

namespace smokemap {
namespace {

Polygon box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

FloorPlan walled(const char* title, const std::vector<RoomOutline>& rooms, const std::vector<Point2>& doors) {
  auto plan = wall_in(rooms);
  ENGINE_EXPECT(plan.ok());
  plan->title = title;
  for (const Point2& p : doors) ENGINE_EXPECT(add_door(*plan, p, 1.0).ok());
  return std::move(*plan);
}

}  // namespace

FloorPlan one_room_building() { return walled("One room", {{"Room", box(0, 0, 6, 4)}}, {}); }

FloorPlan two_room_building() {
  return walled("Two rooms", {{"West", box(0, 0, 4, 4)}, {"East", box(4, 0, 8, 4)}}, {{4, 1.5}});
}

FloorPlan corridor_building() {
  return walled("Corridor",
                {{"Corridor", box(0, 5, 14, 7), true},
                 {"S1", box(0, 0, 4, 5)},
                 {"S2", box(4, 0, 9, 5)},
                 {"S3", box(9, 0, 14, 5)},
                 {"N1", box(0, 7, 6, 11)},
                 {"N2", box(6, 7, 10, 11)},
                 {"N3", box(10, 7, 14, 11)}},
                {{1, 5}, {6, 5}, {12, 5}, {4, 7}, {8, 7}, {13, 7}, {4, 2}});
}

FloorPlan slanted_building() {
  const Pose2 turn(0, 0, kPi / 6);
  const Point2 a(0, 0), b(7, 0), c(7, 5), d(0, 5);
  const Point2 e = b + turn * Point2(6, 0), f = e + turn * Point2(0, 6), g = c + Point2(-2, 4);
  return walled("Slanted", {{"Square", {a, b, c, d}}, {"Wedge", {b, e, f, c}}, {"Tent", {d, c, g}}},
                {{7, 2.5}, {3, 5}});
}

}  // namespace smokemap
