#pragma once

#include <vector>

#include "maps/laser_scan.hpp"
#include "maps/radar_sweep.hpp"
#include "slam/slam_params.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// What the radar says about a lidar scan.
struct SmokeView {
  std::vector<bool> beams;  ///< one flag a beam of the scan: it ended in smoke
  double share = 0;         ///< of the beams that should have shown a wall the radar sees near, those that did not
};

/// Lidar beams that end in smoke: the radar, whom smoke does not hinder, sees nothing at the lidar's range but
/// something well behind it, and so it is for most beams around. Such an echo is neither a wall nor proof of free
/// space.
///
/// Radars miss weak targets now and then: a single disagreement decides nothing, the share within a sector of +-10
/// degrees does. The share over the whole scan says how much the lidar is still worth.
/// @param T_now_then  pose of the robot at the sweep, seen from the robot at the scan
/// Source: the lidar-radar ratio of Fritsche et al. (2016), per beam instead of per scan.
SmokeView look_for_smoke(const LaserScan& scan, const BeamConvention& convention, const RadarSweep& sweep,
                         const Pose2& T_now_then, const RadarParams& params);

}  // namespace smokemap
