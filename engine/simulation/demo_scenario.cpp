#include "simulation/demo_scenario.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/random.hpp"
#include "simulation/path_driver.hpp"

namespace smokemap {
namespace {

enum DemoStream : std::uint64_t { kBuildingStream = 11, kPlanStream = 12, kPictureStream = 13, kStartStream = 14 };

/// Just inside the exit of corridor A, looking along the corridor.
Pose2 place_robot(const FloorPlan& building) {
  const Polygon ring = building.outline(0);
  const Point2 middle = centroid(ring);
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const auto [left, right] = building.rooms_beside(building.doors[i].wall);
    if (std::min(left, right) != -1 || std::max(left, right) != 0) continue;
    const Segment2 gap = building.door_gap(static_cast<int>(i));
    const Point2 inward = left == 0 ? gap.normal() : Point2(-gap.normal());
    return {gap.midpoint() + 1.5 * inward, std::atan2(inward.y(), inward.x())};
  }
  return {middle, 0};
}

/// The way to every room that can be reached, longest first.
struct Way {
  double length_m = 0;
  int room = -1;
  std::vector<Point2> path;
};
std::vector<Way> ways_to_rooms(const FloorPlan& building, const SegmentWorld& world, const Point2& start) {
  const PathDriver driver(world);
  std::vector<Way> ways;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    if (building.rooms[i].corridor) continue;
    auto path = driver.plan(start, centroid(building.outline(static_cast<int>(i))));
    if (!path) continue;
    Way way{0, static_cast<int>(i), std::move(*path)};
    for (std::size_t k = 1; k < way.path.size(); ++k) way.length_m += (way.path[k] - way.path[k - 1]).norm();
    ways.push_back(std::move(way));
  }
  std::sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.length_m > b.length_m; });
  return ways;
}

double thickest_smoke(const SmokeField& smoke, const std::vector<Point2>& path) {
  double most = 0;
  for (const Point2& p : path) most = std::max(most, smoke.extinction_at(p));
  return most;
}

/// The farthest room whose way leads through haze but not through dense smoke; the clearest way if there is none.
const Way& choose_goal(const std::vector<Way>& ways, const SmokeField& smoke, const SegmentWorld& world,
                       const Point2& start) {
  constexpr double kHaze = 0.4;  // visibility of about 8 m
  const Way* clearest = &ways.back();
  for (const Way& way : ways) {
    const double here = thickest_smoke(smoke, way.path);
    if (here < kHaze && !world.sees(start, way.path.back())) return way;
    if (here < thickest_smoke(smoke, clearest->path)) clearest = &way;
  }
  return *clearest;
}

}  // namespace

RandomBuildingParams DemoParams::demo_building() {
  RandomBuildingParams params;
  params.furniture = 6;
  return params;
}

PlanDistortionParams DemoParams::demo_distortion() {
  PlanDistortionParams params;
  params.missing_walls = 1;
  params.phantom_walls = 1;
  return params;
}

Result<Ok> DemoParams::validate() const {
  for (const auto& part : {building.validate(), distortion.validate()})
    if (!part) return part.error();
  return ParamCheck("DemoParams")
      .in_range("burning_s", burning_s, 0, 36000)
      .in_range("sigma_start_m", sigma_start_m, 0, 3)
      .in_range("sigma_start_rad", sigma_start_rad, 0, 1)
      .result();
}

Result<DemoScenario> make_demo(std::uint64_t seed, const DemoParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  auto random = random_stream(seed, kBuildingStream);
  auto building = random_building(params.building, random);
  if (!building) return building.error();
  return make_demo_in(std::move(*building), std::nullopt, seed, params);
}

Result<DemoScenario> make_demo_in(FloorPlan building, const std::optional<Pose2>& T_world_start, std::uint64_t seed,
                                  const DemoParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  DemoScenario demo;
  demo.seed = seed;
  demo.building = std::move(building);

  auto random = random_stream(seed, kPlanStream);
  auto plan = distort(demo.building, params.distortion, random);
  if (!plan) return plan.error();
  demo.plan = std::move(*plan);

  demo.world.walls = build_world(demo.building);
  demo.T_world_start = T_world_start.value_or(place_robot(demo.building));
  const Point2 start = demo.T_world_start.translation();
  const std::vector<Way> ways = ways_to_rooms(demo.building, demo.world.walls, start);
  if (ways.size() < 2) return fail(Errc::kDegenerate, "no room of this building can be reached");
  demo.p_world_fire = ways.front().path.back();
  if (params.fire) {
    demo.world.smoke = SmokeField(demo.world.walls, SmokeParams{}, {SmokeSource{demo.p_world_fire}});
    demo.world.smoke.advance(params.burning_s);
  }
  const Way& goal = choose_goal(ways, demo.world.smoke, demo.world.walls, start);
  demo.far_room = demo.building.rooms[static_cast<std::size_t>(goal.room)].name;
  demo.p_world_far_room = goal.path.back();

  random = random_stream(seed, kPictureStream);
  PlanPictureParams drawing;
  drawing.you_are_here = demo.plan.warp(demo.T_world_start * Point2(3.0, 0));
  auto picture = draw_plan(demo.plan.drawn, drawing, random);
  if (!picture) return picture.error();
  demo.picture = std::move(*picture);
  demo.truth = true_layout(demo.plan, demo.picture);
  demo.far_room_px = demo.picture.to_pixels(demo.plan.warp(demo.p_world_far_room));

  random = random_stream(seed, kStartStream);
  demo.true_start = point_on_plan(demo, demo.T_world_start);
  demo.start = demo.true_start;
  const double finger_px = params.sigma_start_m / demo.picture.metres_per_pixel;
  demo.start.layout_px += Point2(normal(random, finger_px), normal(random, finger_px));
  demo.start.heading_rad = wrap_angle(demo.start.heading_rad + normal(random, params.sigma_start_rad));
  return demo;
}

StartHint point_on_plan(const DemoScenario& demo, const Pose2& T_world_robot) {
  const Point2 here = demo.plan.warp(T_world_robot.translation());
  const Point2 ahead = demo.plan.warp(T_world_robot * Point2(0.5, 0));
  return {demo.picture.to_pixels(here), std::atan2(ahead.y() - here.y(), ahead.x() - here.x())};
}

SimulatedRobotParams demo_robot_params(const DemoScenario& demo) {
  SimulatedRobotParams params;
  params.seed = demo.seed;
  return params;
}

}  // namespace smokemap
