#pragma once

#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"
#include "maps/merged_map.hpp"

namespace smokemap {

/// Per wall: how far beside it (across, metres) something else stands that was seen on as much of its length and that
/// no other wall of the plan explains; 0 where nothing does. Which of the two is the drawn wall, sensors cannot tell: a
/// wall that nobody drew stands half a metre before one that is seen from the next room. Walls square to neither axis
/// and those that are not confirmed have none. Cost: as one search of lines.
std::vector<double> wall_rivals_m(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                  const PlanModel& plan, const GraphState& state, const std::vector<WallState>& walls);

}  // namespace smokemap
