#pragma once

#include "simulation/lidar.hpp"

namespace smokemap::test {

/// A scanner as the logs of universities have it: 180 beams forward over half a turn, 30 m, all at once.
inline LidarParams half_turn_lidar() {
  LidarParams lidar;
  lidar.beams = 180;
  lidar.angle_min_rad = -0.5 * kPi;
  lidar.field_of_view_rad = kPi;
  lidar.range_max_m = 30;
  lidar.skew = false;
  return lidar;
}

}  // namespace smokemap::test
