#pragma once

#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "acg/new_walls.hpp"
#include "acg/wall_evidence.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"

namespace smokemap {

/// What one solved graph knows, gathered for reading out.
struct SolvedPlan {
  const LayoutMap* layout = nullptr;
  const PlanModel* plan = nullptr;
  const GraphState* state = nullptr;
  std::vector<WallEvidence> evidence;  ///< per wall
  std::vector<double> linked_m;        ///< per wall
  std::vector<WallState> wall_states;  ///< per wall
  std::vector<double> doubt;           ///< per wall: probability that it is really elsewhere; may be empty
  std::vector<double> corner_sigma_m;  ///< per corner
  std::vector<CornerLink> links;
};

/// State of a wall from what beams say, without people's word.
/// @param linked_m  length on which pieces lie on it; near_m: the same for pieces anywhere within its gate
WallState judge_wall_state(const WallEvidence& evidence, double linked_m, double near_m, const AcgParams& params);

/// Where a wall with a door is missing, the short rest of it beyond the door (under 0.5 m) is missing too: echoes so
/// near the wall that it was drawn to meet cannot tell. Changes `states`.
void stubs_go_with_their_walls(const PlanModel& plan, std::vector<WallState>& states);

/// Walls, corners, links and the deformation of a solved plan, into `out`.
void read_out_plan(const SolvedPlan& solved, const AcgParams& params, MergedMap& out);
void read_out_new_walls(const std::vector<NewWall>& walls, MergedMap& out);

}  // namespace smokemap
