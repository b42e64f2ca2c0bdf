#pragma once

#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"

namespace smokemap {

/// A free sector between two neighbouring walls of a corner, as the plan has it now.
struct CornerSector {
  int corner = 0;
  int wall_a = 0, wall_b = 0;          ///< free space lies counter-clockwise from a to b
  double orientation_rad = 0;          ///< bisector, map
  double opening_rad = 0;              ///< 0..2 pi
  Point2 offset_map = Point2::Zero();  ///< from the crossing of the two faces to the corner
};

/// All sectors of all corners with two walls or more; those nearly straight have no certain place and are left out.
std::vector<CornerSector> corner_sectors(const PlanModel& plan, const GraphState& state);

/// Which corner of which scan is which corner of the plan, with the estimates as they are now: like orientation and
/// like opening (both within 45 degrees, by amount), each the other's nearest, within the gate of its walls. A link
/// that no other link of the same node bears out (they agree about the shift between scan and plan) is left with a
/// tenth of its weight. Sources: Robotics 2019 8(2) 40, sect. 3 (orientation test; differs: by amount, both ways, and
/// opening too); Wang, Marcotte, Olson, IROS 2019 (pairwise consistency).
/// @param gate_m  per wall; <= 0 takes its corners out
std::vector<CornerLink> link_corners(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                     const PlanModel& plan, const GraphState& state, const std::vector<double>& gate_m);

/// How far a link's corner is from the plan's now.
double misfit_m(const CornerLink& link, const GraphState& state);

}  // namespace smokemap
