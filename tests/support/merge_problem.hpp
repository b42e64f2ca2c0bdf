#pragma once

#include <cstdint>
#include <vector>

#include "acg/auto_complete_graph.hpp"
#include "maps/layout_map.hpp"
#include "maps/pose_graph.hpp"
#include "simulation/building.hpp"

namespace smokemap::test {

/// How a small problem for the Auto-Complete Graph is made.
struct MergeProblemParams {
  std::uint64_t seed = 1;
  double stretch = 0.10;
  int missing_walls = 0;
  int phantom_walls = 0;
  double sigma_step_m = 0.004;  ///< odometry noise per step
  double sigma_step_rad = 0.002;
  double start_error_m = 0.2;
  double start_error_rad = 0.03;
  std::size_t max_stops = 100;  ///< places to visit
};

/// A building, a wrong plan of it, what a robot saw of it, and the truth in map (frame of the first pose).
struct MergeProblem {
  LayoutMap plan;
  PlanStart start;
  PoseGraph graph;
  std::vector<Pose2> true_poses;     ///< per node
  std::vector<Point2> true_corners;  ///< per plan corner
  std::vector<bool> wall_exists;     ///< per plan wall
};

MergeProblem make_merge_problem(const FloorPlan& building, const MergeProblemParams& params);

/// Plan walls of a drawing, cut at doors, in pixels. `corner_world` takes the true place of every corner.
LayoutMap to_layout(const FloorPlan& drawn, double metres_per_pixel);

/// The first `nodes` nodes and the edges among them.
PoseGraph first_nodes(const PoseGraph& graph, std::size_t nodes);

}  // namespace smokemap::test
