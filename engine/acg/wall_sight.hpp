#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "acg/scan_pieces.hpp"
#include "geometry/segment2.hpp"

namespace smokemap {

/// A place where the echoes of a wall's face stop and the next beam passes; robot frame, on the face.
struct SeenEnd {
  Point2 end_robot = Point2::Zero();
  double sigma_m = 0.05;  ///< along the wall: half the gap between the two beams
};

/// What the beams of one node say about one wall.
struct WallSight {
  int wall = 0;
  Segment2 wall_robot;            ///< where the wall's centre line was when the beams were read
  std::vector<std::int8_t> bins;  ///< along a -> b: +1 an echo from the face, -1 a beam through it, 0 nothing
  std::array<std::vector<SeenEnd>, 2> ends;  ///< near corner a and b, where these stand free
};

/// Reads the beams in the wall's sector. Pure: the same rays and the same wall in the robot's frame say the same.
/// @param free_end  at a and b: no other wall goes on there, so that an end (a door jamb) may be seen
/// Cost: the beams in the sector.
WallSight see_wall(const std::vector<ScanRay>& rays, int wall, const Segment2& wall_robot, double half_thickness_m,
                   std::size_t bins, const std::array<bool, 2>& free_end);

}  // namespace smokemap
