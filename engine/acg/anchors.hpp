#pragma once

#include <optional>
#include <vector>

#include "acg/graph_state.hpp"
#include "geometry/similarity2.hpp"

namespace smokemap {

/// Which of the pairs a person must have got wrong: those that contradict what most of the others agree on (a
/// similarity through two of them, with allowance for the plan's local stretch). Two against one is not enough to tell:
/// three or more must agree, else none is flagged. p_a: map, p_b: layout (metres).
/// @param witness  a pair from elsewhere (the robot's start) that takes part but is not judged
/// Cost: pairs cubed.
std::vector<bool> outlying_pairs(const std::vector<PointPair>& pairs, const std::optional<PointPair>& witness = {});

/// The pairs that are not flagged.
std::vector<PointPair> trusted_pairs(const std::vector<PointPair>& pairs, const std::vector<bool>& outlying);

/// A place of the plan as a mixture of its three nearest corners that are not in line. None in a plan without them.
std::optional<AnchorLink> anchor_link(const PlanModel& plan, const Point2& p_layout, const Point2& p_map);

/// Where the state has the link's place now, from where the person says it is.
double residual_m(const AnchorLink& link, const GraphState& state);

}  // namespace smokemap
