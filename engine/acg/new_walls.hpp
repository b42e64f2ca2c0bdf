#pragma once

#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"

namespace smokemap {

/// A wall that sensors saw and the plan lacks; centre line in map.
struct NewWall {
  Segment2 segment_map;
  double evidence_m = 0;  ///< length on which at least two nodes agree
  double confidence = 0;  ///< 0..1
};

/// Lines through the pieces that no wall of the plan explains: seen by two nodes or more, at least `new_wall_min_m`
/// long, and tied to other walls the way walls are; furniture stands free or close in front of a wall.
/// @param there per wall of the plan: false for one that is missing in reality and explains nothing
/// Ordered by position. Deterministic.
std::vector<NewWall> find_new_walls(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                    const PlanModel* plan, const GraphState& state, const std::vector<bool>& there,
                                    const AcgParams& params);

}  // namespace smokemap
