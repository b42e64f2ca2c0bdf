#include "tests/support/merge_problem.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "simulation/path_driver.hpp"
#include "simulation/plan_distortion.hpp"

namespace smokemap::test {
namespace {

constexpr double kMetresPerPixel = 0.02;
constexpr double kMargin_px = 50;
constexpr double kStep_m = 0.4;

/// Cuts the walls of a drawing at its doors; the same cuts in a second drawing with the same walls give true places.
struct Cutter {
  LayoutMap map;
  std::vector<Point2> truth;
  Point2 low = Point2::Zero();
  int height_px = 0;

  int corner(const Point2& drawn, const Point2& true_place) {
    const PixelFrame frame{height_px, kMetresPerPixel};
    const Point2 px = frame.to_pixels(drawn - low) + Point2(kMargin_px, -kMargin_px);
    for (std::size_t i = 0; i < map.corners.size(); ++i)
      if ((map.corners[i].p_px - px).norm() < 0.5) return static_cast<int>(i);
    LayoutCorner c;
    c.p_px = px;
    map.corners.push_back(c);
    truth.push_back(true_place);
    return static_cast<int>(map.corners.size()) - 1;
  }
};

Cutter cut(const FloorPlan& drawn, const std::vector<Point2>& corner_world, const std::vector<int>& wall_source,
           MergeProblem* problem) {
  Cutter out;
  Point2 high = drawn.corners.front();
  out.low = high;
  for (const Point2& p : drawn.corners) out.low = out.low.cwiseMin(p), high = high.cwiseMax(p);
  out.map.width_px = static_cast<int>((high - out.low).x() / kMetresPerPixel + 2 * kMargin_px);
  out.map.height_px = out.height_px = static_cast<int>((high - out.low).y() / kMetresPerPixel + 2 * kMargin_px);
  out.map.scale = LayoutScale{kMetresPerPixel, 0.05, true};
  for (std::size_t w = 0; w < drawn.walls.size(); ++w) {
    std::vector<double> stops{0};
    for (const PlanDoor& d : drawn.doors)
      if (d.wall == static_cast<int>(w)) stops.push_back(d.from), stops.push_back(d.to);
    stops.push_back(1);
    std::sort(stops.begin(), stops.end());
    const PlanWall& wall = drawn.walls[w];
    const auto at = [&](const std::vector<Point2>& corners, double s) -> Point2 {
      return corners[static_cast<std::size_t>(wall.corner_a)] +
             s * (corners[static_cast<std::size_t>(wall.corner_b)] - corners[static_cast<std::size_t>(wall.corner_a)]);
    };
    for (std::size_t k = 0; k + 1 < stops.size(); k += 2) {
      LayoutWall piece;
      piece.corner_a = out.corner(at(drawn.corners, stops[k]), at(corner_world, stops[k]));
      piece.corner_b = out.corner(at(drawn.corners, stops[k + 1]), at(corner_world, stops[k + 1]));
      piece.thickness_px = wall.thickness_m / kMetresPerPixel;
      out.map.walls.push_back(piece);
      if (problem != nullptr) problem->wall_exists.push_back(wall_source[w] >= 0);
    }
  }
  return out;
}

std::vector<Pose2> drive_through(const SegmentWorld& world, const FloorPlan& building, std::size_t max_stops) {
  const PathDriver driver(world);
  std::vector<Point2> stops = room_tour(building, building.outline(0).front());
  stops.resize(std::min(stops.size(), max_stops));
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const auto way = driver.plan(stops[i], stops[i + 1]);
    if (!way) continue;
    for (std::size_t k = 0; k + 1 < way->size(); ++k) {
      const Segment2 leg{(*way)[k], (*way)[k + 1]};
      for (double s = 0; s < leg.length(); s += 0.05) {
        const Point2 p = leg.a + s * leg.direction();
        if (poses.empty() || (poses.back().translation() - p).norm() >= kStep_m) poses.emplace_back(p, leg.heading());
      }
    }
  }
  return poses;
}

PoseNode look_around(const SegmentWorld& world, const Pose2& pose, int id, std::mt19937_64& random) {
  auto hits = std::make_shared<std::vector<Point2>>(), free_ends = std::make_shared<std::vector<Point2>>();
  for (int i = 0; i < 360; ++i) {
    const double bearing = i * kPi / 180;
    const auto hit = world.cast(pose.translation(), pose.heading() + bearing, 12);
    const double range = hit ? hit->range_m + normal(random, 0.015) : 12;
    (hit ? hits : free_ends)->emplace_back(range * std::cos(bearing), range * std::sin(bearing));
  }
  PoseNode node;
  node.id = id;
  node.robot = "robot";
  node.stamp = from_seconds(id);
  node.hits_robot = hits;
  node.free_ends_robot = free_ends;
  return node;
}

}  // namespace

LayoutMap to_layout(const FloorPlan& drawn, double) { return cut(drawn, drawn.corners, {}, nullptr).map; }

MergeProblem make_merge_problem(const FloorPlan& building, const MergeProblemParams& params) {
  MergeProblem out;
  auto random = random_stream(params.seed, 1);
  PlanDistortionParams wrong;
  wrong.sigma_stretch = params.stretch;
  wrong.missing_walls = params.missing_walls;
  wrong.phantom_walls = params.phantom_walls;
  const DistortedPlan plan = *distort(building, wrong, random);
  Cutter cutter = cut(plan.drawn, plan.corner_world, plan.wall_source, &out);
  out.plan = cutter.map;

  const SegmentWorld world = build_world(building);
  const std::vector<Pose2> way = drive_through(world, building, params.max_stops);
  const Pose2 T_map_world = way.front().inverse();
  for (const Point2& p : cutter.truth) out.true_corners.push_back(T_map_world * p);
  Pose2 drifted;
  for (std::size_t i = 0; i < way.size(); ++i) {
    PoseNode node = look_around(world, way[i], static_cast<int>(i), random);
    if (i > 0) {
      const Pose2 step = way[i - 1].inverse() * way[i];
      const Pose2 noisy(step.x() + normal(random, params.sigma_step_m), step.y() + normal(random, params.sigma_step_m),
                        step.heading() + normal(random, params.sigma_step_rad));
      drifted = drifted * noisy;
      PoseEdge edge;
      edge.from = static_cast<int>(i) - 1;
      edge.to = static_cast<int>(i);
      edge.T_from_to = noisy;
      edge.sqrt_information =
          Eigen::Vector3d(1 / std::max(0.002, params.sigma_step_m), 1 / std::max(0.002, params.sigma_step_m),
                          1 / std::max(0.001, params.sigma_step_rad))
              .asDiagonal();
      out.graph.edges.push_back(edge);
    }
    node.T_map_robot = node.T_odom_robot = drifted;
    out.graph.nodes.push_back(node);
    out.true_poses.push_back(T_map_world * way[i]);
  }
  const PixelFrame frame = out.plan.frame();
  const Point2 start_drawn = plan.warp(way.front().translation()) - cutter.low;
  const Point2 start_px =
      PixelFrame{cutter.height_px, kMetresPerPixel}.to_pixels(start_drawn) + Point2(kMargin_px, -kMargin_px);
  out.start.T_layout_robot = Pose2(
      frame.to_metres(start_px) + Point2(normal(random, params.start_error_m), normal(random, params.start_error_m)),
      way.front().heading() + normal(random, params.start_error_rad));
  out.start.sigma_m = std::max(0.1, params.start_error_m);
  out.start.sigma_rad = std::max(0.02, params.start_error_rad);
  return out;
}

PoseGraph first_nodes(const PoseGraph& graph, std::size_t nodes) {
  PoseGraph out;
  out.nodes.assign(graph.nodes.begin(),
                   graph.nodes.begin() + static_cast<std::ptrdiff_t>(std::min(nodes, graph.nodes.size())));
  for (const PoseEdge& e : graph.edges)
    if (static_cast<std::size_t>(std::max(e.from, e.to)) < nodes) out.edges.push_back(e);
  return out;
}

}  // namespace smokemap::test
