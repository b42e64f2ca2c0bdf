#include "slam/render_map.hpp"

#include <limits>

#include "core/check.hpp"

namespace smokemap {
namespace {

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
    const Drawn now{pose_of_node(graph, T_map_nodes, i), node.hits_robot, node.free_ends_robot};
    if (i < drawn_.size()) {
      const Pose2 moved = drawn_[i].T_map_robot.inverse() * now.T_map_robot;
      const bool same = moved.translation().norm() <= params_.moved_m && std::abs(moved.heading()) <= params_.moved_rad;
      if (same && drawn_[i].hits_robot == now.hits_robot && drawn_[i].free_ends_robot == now.free_ends_robot) continue;
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
    for (const auto& points : {graph.nodes[i].hits_robot, graph.nodes[i].free_ends_robot})
      if (points)
        for (const Point2& p : *points) include(T_map_node * p);
  }
  if (low.allFinite() && high.allFinite()) grid_.reserve(low, high);
}

void MapRenderer::draw(const Drawn& what, bool add) {
  const Point2 origin = what.T_map_robot.translation();
  const Eigen::Matrix2d R = what.T_map_robot.rotation();
  const auto each = [&](const auto& points, auto&& put) {
    if (!points) return;
    for (const Point2& p_robot : *points) put(Point2(R * p_robot + origin));
  };
  each(what.hits_robot, [&](const Point2& end) { add ? grid_.add_hit(origin, end) : grid_.remove_hit(origin, end); });
  each(what.free_ends_robot,
       [&](const Point2& end) { add ? grid_.add_free(origin, end) : grid_.remove_free(origin, end); });
}

OccupancyGrid render_map(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes, const RenderParams& params) {
  MapRenderer renderer(params);
  renderer.update(graph, T_map_nodes);
  return renderer.occupancy();
}

}  // namespace smokemap
