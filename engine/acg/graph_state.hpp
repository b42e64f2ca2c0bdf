#pragma once

#include <array>
#include <vector>

#include "acg/plan_model.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// Everything that is estimated, as the solver wants it.
struct GraphState {
  std::vector<std::array<double, 3>> poses;    ///< T_map_robot per node
  std::vector<std::array<double, 2>> corners;  ///< of the plan, in map
  double turn = 0;                             ///< of the plan in map
  double log_scale = 0;                        ///< against the plan's metres per pixel
  std::array<std::vector<double>, 2> lines;    ///< drawn lines: coordinate along the turned axes, map

  Pose2 pose(std::size_t i) const { return {poses[i][0], poses[i][1], poses[i][2]}; }
  Point2 corner(int i) const {
    const auto& c = corners[static_cast<std::size_t>(i)];
    return {c[0], c[1]};
  }
  Segment2 segment(const PlanEdge& edge) const { return {corner(edge.corner_a), corner(edge.corner_b)}; }
};

/// A part of a scan piece on one face of a wall.
struct PieceLink {
  std::size_t node = 0;
  int wall = 0;
  Segment2 part_robot;
  double side = 1;      ///< +1: the sensor stands left of the wall
  double misfit_m = 0;  ///< rms of both ends when linked
  double weight = 1;    ///< 0..1
};

/// The end of a wall as one node saw it.
struct EndLink {
  std::size_t node = 0;
  int wall = 0;
  int corner = 0;        ///< at the end
  int other_corner = 0;  ///< the wall's other one
  Point2 end_robot = Point2::Zero();
  double sigma_m = 0.05;
  double misfit_m = 0;  ///< along the wall when linked, signed, outwards positive
  double weight = 1;
};

/// Two faces meet where the plan has a corner.
struct CornerLink {
  std::size_t node = 0;
  int corner = 0;
  std::array<int, 2> walls{};          ///< whose faces meet
  Point2 seen_robot = Point2::Zero();  ///< crossing of the faces
  Point2 offset_map = Point2::Zero();  ///< from there to the crossing of the centre lines
  double misfit_m = 0;
  double borne_out = 1;  ///< less when no other link of its node agrees
  double weight = 1;
};

/// What a person vouches for, in the frames of the solver.
struct AnchorLink {
  std::array<int, 3> corners{};
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();
  Point2 p_map = Point2::Zero();
};
struct CornerPin {
  int corner = 0;
  Point2 p_map = Point2::Zero();
};
/// The robot's first pose: where it is in map, and where a person says it is on the plan.
struct StartHold {
  Pose2 T_map_robot, T_layout_robot;
  double sigma_m = 0.3, sigma_rad = 0.05;
};
struct WallLength {
  int wall = 0;
  double length_m = 0;
};

}  // namespace smokemap
