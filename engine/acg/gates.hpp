#pragma once

#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "maps/merged_map.hpp"

namespace smokemap {

/// How far each wall may be from where it is expected: little beside walls that are known already, more the farther
/// away the nearest known wall of its direction is (the plan may be stretched in between). Cost: walls squared.
std::vector<double> wall_gates_m(const PlanModel& plan, const std::vector<WallState>& walls,
                                 const std::vector<double>& linked_m, const AcgParams& params);

/// Walls that their links hold in a place that the plan finds hard to believe: turned by more than three sigma.
std::vector<bool> tense_walls(const PlanModel& plan, const GraphState& state, const AcgParams& params);

/// Mean over walls of how many squared sigmas their length and direction differ from the drawing.
double plan_tension(const PlanModel& plan, const GraphState& state, const AcgParams& params);

/// Evidence over which length lets a wall move by itself.
bool mature(const PlanEdge& wall, double linked_m, const AcgParams& params);

/// Partial views bend no wall: links to walls without mature evidence get no weight.
void drop_immature(const std::vector<double>& linked_m, const PlanModel& plan, const AcgParams& params,
                   std::vector<PieceLink>& links);
void drop_immature(const std::vector<double>& linked_m, const PlanModel& plan, const AcgParams& params,
                   std::vector<CornerLink>& links);

}  // namespace smokemap
