#pragma once

#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"

namespace smokemap {

/// Which piece of which scan lies on which wall, with the estimates as they are now. A piece that runs over several
/// walls in line gives a link to each; of walls side by side the nearest gets it.
/// @param gate_m  per wall: pieces farther from the wall's face are not linked; <= 0 takes the wall out
/// Cost: pieces x walls, with a cheap test first.
std::vector<PieceLink> link_pieces(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                   const PlanModel& plan, const GraphState& state, const std::vector<double>& gate_m,
                                   const AcgParams& params);

/// How far a linked part is from its wall's face now: rms of both ends.
double misfit_m(const PieceLink& link, const PlanModel& plan, const GraphState& state);

/// Graduated non-convexity (Geman-McClure form): (c^2 / (c^2 + r^2))^2.
double robust_weight(double misfit_m, double c_m);

/// Length per wall, in map, on which links of at least this weight from two nodes or more speak.
std::vector<double> linked_length_m(const std::vector<PieceLink>& links, const PlanModel& plan, const GraphState& state,
                                    double min_weight = 0.5);

}  // namespace smokemap
