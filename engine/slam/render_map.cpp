#include "slam/render_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr double kSurfaceM = 0.5;  // hits farther apart are not of one surface
constexpr double kMostGrazedM = 0.5;

/// How far before its end a beam runs within `cell_m` of the surface that it hits, by the hits before and after.
double grazed_m(const std::vector<Point2>& hits, std::size_t i, const Point2& p_sensor, double cell_m) {
  const Point2 beam = (hits[i] - p_sensor).normalized();
  double most_square = 0;  // sine of the angle between beam and surface
  bool surface = false;
  for (const std::size_t j : {i - 1, i + 1}) {
    if (j >= hits.size()) continue;  // i - 1 of the first, too
    const Point2 along = hits[j] - hits[i];
    const double length = along.norm();
    if (length < 1e-6 || length > kSurfaceM) continue;
    surface = true;
    most_square = std::max(most_square, std::abs(beam.x() * along.y() - beam.y() * along.x()) / length);
  }
  return surface ? std::min(kMostGrazedM, cell_m / std::max(most_square, 1e-3)) : 0;
}

const Pose2& pose_of_node(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes, std::size_t i) {
  return T_map_nodes.empty() ? graph.nodes[i].T_map_robot : T_map_nodes[i];
}

}  // namespace

Result<Ok> RenderParams::validate() const {
  return ParamCheck("RenderParams")
      .in_range("resolution_m", resolution_m, 0.005, 5)
      .positive("evidence.hit", evidence.hit)
      .require("evidence.pass", evidence.pass < 0, "must be negative")
      .positive("evidence.clamp", evidence.clamp)
      .in_range("moved_m", moved_m, 0, 10)
      .in_range("moved_rad", moved_rad, 0, kPi)
      .result();
}

MapRenderer::MapRenderer(const RenderParams& params) : params_(params), grid_(params.resolution_m, params.evidence) {}

int MapRenderer::update(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes) {
  ENGINE_EXPECT(T_map_nodes.empty() || T_map_nodes.size() == graph.nodes.size());
  if (graph.nodes.size() < drawn_.size()) {  // another graph
    grid_.clear();
    drawn_.clear();
  }
  if (drawn_.empty()) make_room(graph, T_map_nodes);
  int count = 0;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const PoseNode& node = graph.nodes[i];
    const Drawn now{pose_of_node(graph, T_map_nodes, i), node.hits_robot, node.radar_hits_robot, node.free_ends_robot};
    if (i < drawn_.size()) {
      const Pose2 moved = drawn_[i].T_map_robot.inverse() * now.T_map_robot;
      const bool same = moved.translation().norm() <= params_.moved_m && std::abs(moved.heading()) <= params_.moved_rad;
      const bool all_drawn = drawn_[i].hits_robot == now.hits_robot &&
                             drawn_[i].radar_hits_robot == now.radar_hits_robot &&
                             drawn_[i].free_ends_robot == now.free_ends_robot;
      if (same && all_drawn) continue;
      draw(drawn_[i], false);
      drawn_[i] = now;
    } else {
      drawn_.push_back(now);
    }
    draw(now, true);
    ++count;
  }
  return count;
}

/// All at once: a grid that grows while it is drawn needs twice the memory.
void MapRenderer::make_room(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes) {
  Point2 low = Point2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto include = [&](const Point2& p) {
    if (!p.allFinite()) return;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const Pose2& T_map_node = pose_of_node(graph, T_map_nodes, i);
    include(T_map_node.translation());
    for (const auto& points :
         {graph.nodes[i].hits_robot, graph.nodes[i].radar_hits_robot, graph.nodes[i].free_ends_robot})
      if (points)
        for (const Point2& p : *points) include(T_map_node * p);
  }
  if (low.allFinite() && high.allFinite()) grid_.reserve(low, high);
}

void MapRenderer::draw(const Drawn& what, bool add) {
  const Point2 origin = what.T_map_robot.translation();
  const Eigen::Matrix2d R = what.T_map_robot.rotation();
  if (what.hits_robot)
    for (std::size_t i = 0; i < what.hits_robot->size(); ++i) {
      const Point2 end = R * (*what.hits_robot)[i] + origin;
      const double grazed = grazed_m(*what.hits_robot, i, Point2::Zero(), params_.resolution_m);
      add ? grid_.add_hit(origin, end, grazed) : grid_.remove_hit(origin, end, grazed);
    }
  const auto each = [&](const auto& points, auto&& put) {
    if (!points) return;
    for (const Point2& p_robot : *points) put(Point2(R * p_robot + origin));
  };
  each(what.radar_hits_robot,
       [&](const Point2& end) { add ? grid_.add_hit(origin, end) : grid_.remove_hit(origin, end); });
  each(what.free_ends_robot,
       [&](const Point2& end) { add ? grid_.add_free(origin, end) : grid_.remove_free(origin, end); });
}

OccupancyGrid render_map(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes, const RenderParams& params) {
  MapRenderer renderer(params);
  renderer.update(graph, T_map_nodes);
  return renderer.occupancy();
}

}  // namespace smokemap
