#pragma once

#include <array>
#include <vector>

#include "acg/acg_params.hpp"
#include "core/result.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// A wall of the plan, or a door's gap between two wall ends, in `layout` (metres, y up).
struct PlanEdge {
  int corner_a = 0;
  int corner_b = 0;
  double length_m = 0;
  double heading_rad = 0;  ///< of a -> b
  double half_thickness_m = 0;
  bool usable = true;  ///< false for a stroke without length
};

/// The plan as the solver sees it. Besides its walls it knows the plan's *drawn lines*: along the plan's two main
/// directions, corners that share a coordinate (within a few centimetres) belong to one line, because somebody drew, or
/// built, them in line.
struct PlanModel {
  std::vector<Point2> corners;
  std::vector<PlanEdge> walls;  ///< same order as LayoutMap::walls
  std::vector<PlanEdge> gaps;
  double axis_rad = 0;                             ///< main direction of the plan; the other is 90 degrees to the left
  std::array<std::vector<double>, 2> lines;        ///< coordinate of each line along axis 0 and 1, ascending
  std::array<std::vector<int>, 2> line_of_corner;  ///< index into lines, per corner
  std::vector<int> degree;                         ///< walls at each corner
  /// Corners and lines where the pull of the lines and that of the walls' shape cancel: what the solver expects, so
  /// that an uneven drawing by itself neither turns nor shrinks the plan. Empty: as drawn.
  std::vector<Point2> even_corners;
  std::array<std::vector<double>, 2> even_lines;
  double metres_per_pixel = 1;
  double scale_sigma = 0.1;

  /// Which of the two axes measures the offset of this wall: 1 for a wall along axis 0. -1 for a slanting wall.
  int offset_axis(const PlanEdge& wall) const;
};

/// kDegenerate when there is no wall of any length.
Result<PlanModel> make_plan_model(const LayoutMap& plan, const AcgParams& params);

}  // namespace smokemap
