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

/// Lidar beams that end in smoke. Such an echo is neither a wall nor proof of free space. Two signs, either is enough:
///  * It lies on no surface: the beams beside it end elsewhere, and the radar has no echo there. Smoke answers from a
///    depth, each beam from another one; walls, jambs and furniture go on for some beams. Right in front of the robot,
///    where most echoes of smoke come from and the radar is blind, this alone decides.
///  * The radar, whom smoke does not hinder, sees nothing at the lidar's range but something well behind it, and so it
///    is for most beams around: radars miss weak targets now and then, a single disagreement decides nothing, the share
///    within a sector of +-10 degrees does.
/// The share over the whole scan says how much the lidar is still worth.
///
/// Measured on the simulated building, by density of the smoke and range below 3 m: 0 to 7 % of the echoes of smoke are
/// taken for walls, and at most 0.5 % of those of walls for smoke (9 to 20 % at 0.3 to 0.5 m in the thickest). The
/// reflex stop does not rely on it (navigation/obstacle_watch).
/// @param T_now_then  pose of the robot at the sweep, seen from the robot at the scan
/// Source: the lidar-radar ratio of Fritsche et al. (2016), per beam instead of per scan; the first sign is our own.
SmokeView look_for_smoke(const LaserScan& scan, const BeamConvention& convention, const RadarSweep& sweep,
                         const Pose2& T_now_then, const RadarParams& params);

}  // namespace smokemap
