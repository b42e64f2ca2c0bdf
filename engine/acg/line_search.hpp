#pragma once

#include <array>
#include <optional>
#include <vector>

#include "acg/line_chain.hpp"
#include "acg/sensed_faces.hpp"

namespace smokemap {

/// What holds drawn lines besides what sensors say.
struct LineHolds {
  std::vector<bool> gone;                ///< per wall: does not speak
  std::vector<int> held_corners;         ///< a person says that these are where they are
  std::optional<Point2> start_map;       ///< the robot's first pose, and
  Point2 start_layout = Point2::Zero();  ///< where it is on the plan,
  double start_sigma_m = 0.3;            ///< one standard deviation per coordinate
};

/// Looks for a better arrangement of all drawn lines, each axis by itself: walls that run square to it are held against
/// all sensed faces within 4 m of where the state has them (LineChain, SensedFaces). Poses and the other axis are taken
/// as they are. Cost: some 50 ms for 50 lines an axis.
std::array<std::vector<LineBelief>, 2> search_lines(const std::vector<NodeView>& views,
                                                    const std::vector<bool>& use_node, const PlanModel& plan,
                                                    const GraphState& state, const LineHolds& holds,
                                                    const AcgParams& params);

/// The lines of one axis, and the corners on them, moved: one distance per line.
void move_lines(const PlanModel& plan, std::size_t axis, const std::vector<double>& moves_m, GraphState& state);

}  // namespace smokemap
