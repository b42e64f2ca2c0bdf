#pragma once

#include <vector>

#include "core/result.hpp"
#include "grids/log_odds_grid.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

struct RenderParams {
  double resolution_m = 0.05;
  LogOddsParams evidence;
  double moved_m = 0.02;  ///< a node whose pose moved less keeps what it drew
  double moved_rad = 0.003;
  Result<Ok> validate() const;
};

/// What the sensors saw, drawn from the graph: every hit of every node traced from where the robot stood.
/// @param T_map_nodes  one pose a node, in the order of graph.nodes; empty = the poses in the graph
/// Cost: about 0.1 ms a node (180 beams of 5 m at 0.05 m).
OccupancyGrid render_map(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes = {},
                         const RenderParams& params = {});

/// The same kept up to date: draws new nodes, and nodes that moved by more than the tolerance again (their old beams
/// are taken back exactly), nothing else. After any updates with zero tolerance the grid equals a full drawing.
class MapRenderer {
 public:
  explicit MapRenderer(const RenderParams& params = {});
  /// @return number of nodes drawn
  int update(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes = {});
  OccupancyGrid occupancy() const { return grid_.occupancy(); }

 private:
  struct Drawn {
    Pose2 T_map_robot;
    std::shared_ptr<const std::vector<Point2>> hits_robot, radar_hits_robot, free_ends_robot;
  };
  void make_room(const PoseGraph& graph, const std::vector<Pose2>& T_map_nodes);
  void draw(const Drawn& what, bool add);

  RenderParams params_;
  LogOddsGrid grid_;
  std::vector<Drawn> drawn_;
};

}  // namespace smokemap
