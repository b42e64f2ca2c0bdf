#pragma once

#include <string>
#include <vector>

#include "core/time.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// One turn of a spinning radar: received power over azimuth and range.
struct RadarSweep {
  Stamp stamp = 0;  ///< of the first azimuth
  double duration_s = 0.4;
  std::string robot;
  double azimuth_min_rad = 0;
  double azimuth_increment_rad = 0;
  double range_min_m = 0;         ///< of bin 0's centre
  double range_resolution_m = 0;  ///< per bin
  int azimuths = 0;
  int bins = 0;
  std::vector<float> power;  ///< azimuths x bins, row-major, linear, mean receiver noise = 1
  Pose2 T_robot_radar;
};

}  // namespace smokemap
