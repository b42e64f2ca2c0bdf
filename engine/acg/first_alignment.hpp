#pragma once

#include <optional>
#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"
#include "geometry/similarity2.hpp"

namespace smokemap {

/// Where to look for the plan, before anything of it is aligned.
struct AlignmentSearch {
  std::optional<Similarity2> guess;  ///< layout -> map; none: anywhere, any heading
  double sigma_m = 0.3;              ///< of the guess, at the robot's first pose
  double sigma_rad = 0.05;
  double scale_sigma = 0.08;
};

struct PlanAlignment {
  Similarity2 map_from_layout;
  double explained = 0;  ///< share of the hits within 20 cm of a wall's face
  double margin = 0;     ///< by how much it beats the best alignment somewhere else, as a share; 1 with a guess
};

/// The turn, scale and shift of the plan under which the hits of these nodes lie best on its walls: exhaustive, coarse to
/// fine, on a distance field. Only nodes within a few metres of way should be given: the plan is stretched.
/// kDegenerate without enough hits.
Result<PlanAlignment> align_plan(const PlanModel& plan, const std::vector<Point2>& hits_map, const Point2& robot_map,
                             const AlignmentSearch& search);

/// The hits of the nodes up to a given way from the first, thinned to a few hundred.
std::vector<Point2> first_hits(const std::vector<NodeView>& views, const GraphState& state, double way_m);

}  // namespace smokemap
