#pragma once

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "maps/laser_scan.hpp"

namespace smokemap {

/// One set for all maps. Lengths in metres, angles in radians, sigmas are standard deviations.
struct SlamParams {
  BeamConvention beams;
  Pose2 T_map_start;  ///< of the first scan's robot pose
  Result<Ok> validate() const;
};

}  // namespace smokemap
