#pragma once

#include <optional>
#include <vector>

#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"
#include "geometry/similarity2.hpp"

namespace smokemap {

/// Where to look for the plan, before anything of it is aligned.
struct StartSearch {
  std::optional<Similarity2> guess;  ///< layout -> map; none: anywhere, any heading
  double sigma_m = 0.3;              ///< of the guess, at the robot's first pose
  double sigma_rad = 0.05;
  double scale_sigma = 0.08;
};

/// Layout -> map with a scale of its own along each of the plan's main directions.
struct PlanPlacement {
  double turn_rad = 0;
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();
  double axis_rad = 0;                ///< PlanModel::axis_rad
  Point2 shift_map = Point2::Zero();  ///< where the layout's origin lies
  Point2 operator*(const Point2& p_layout) const;
  Point2 inverse(const Point2& p_map) const;
  static PlanPlacement from(const Similarity2& map_from_layout, double axis_rad);
};

struct PlanAlignment {
  PlanPlacement placement;
  double explained = 0;  ///< share of the hits within 20 cm of a wall's face
  double margin = 1;     ///< without a guess: by how much it beats the best alignment somewhere else, as a share
};

/// The turn, scale and shift of the plan under which the hits of these nodes lie best on its walls: exhaustive, coarse
/// to fine, on a distance field. Only nodes within a few metres of way should be given: the plan is stretched.
/// kDegenerate without enough hits.
Result<std::vector<PlanAlignment>> align_plan(const PlanModel& plan, const std::vector<Point2>& hits_map,
                                              const Point2& robot_map, const StartSearch& search);

/// Points on the pieces seen by the nodes up to a given way from the first, not farther than `reach_m` from the robot,
/// thinned to a few hundred.
std::vector<Point2> first_hits(const std::vector<NodeView>& views, const GraphState& state, double way_m,
                               double reach_m);

}  // namespace smokemap
