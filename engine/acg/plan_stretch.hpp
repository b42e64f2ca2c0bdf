#pragma once

#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "maps/merged_map.hpp"

namespace smokemap {

/// Length of confirmed walls with pieces on them, per drawn line of an axis.
std::vector<double> seen_on_lines_m(const PlanModel& plan, std::size_t axis, const std::vector<WallState>& walls,
                                    const std::vector<double>& linked_m);

/// From it on, a line counts as seen.
inline constexpr double kLineSeen_m = 0.8;

/// How much this plan is stretched, as one standard deviation of the local stretch: from the distances between drawn
/// lines that were seen, and, as long as these are few, from what plans are like (`sigma_wall_log_length`). Rooms that
/// nobody saw are stretched like those that somebody saw, so their sigmas follow from it.
double learnt_stretch(const PlanModel& plan, const GraphState& state, const std::vector<WallState>& walls,
                      const std::vector<double>& linked_m, const AcgParams& params);

}  // namespace smokemap
