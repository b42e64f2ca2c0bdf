#pragma once

#include <vector>

#include "maps/laser_scan.hpp"
#include "maps/radar_sweep.hpp"
#include "slam/hit_ranges.hpp"
#include "slam/slam_params.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// What the radar says about a lidar scan.
struct SmokeView {
  std::vector<bool> beams;  ///< one flag a beam of the scan: it ended in smoke
  double share = 0;         ///< of the beams that should have shown a wall the radar sees near, those that did not
};

/// The scans before, and where the robot is now.
struct EarlierScans {
  const ScanMemory* memory = nullptr;
  Pose2 T_odom_robot;  ///< at the scan that is asked about
};

/// Lidar beams that end in smoke. Such an echo is neither a wall nor proof of free space. Two signs, either is enough:
///  * It lies on no surface: the beams beside it end elsewhere, and the radar has no echo there. Smoke answers from a
///    depth, each beam from another one; walls, jambs and furniture go on for some beams. Right in front of the robot,
///    where most echoes of smoke come from and the radar is blind, this alone decides.
///  * The radar, whom smoke does not hinder, sees nothing at the lidar's range but something well behind it, and so it
///    is for most beams around: radars miss weak targets now and then, a single disagreement decides nothing, the share
///    within a sector of +-10 degrees does.
/// The scans just before settle doubts farther away than two metres, where echoes of smoke are too rare to come twice
/// from one place: what was hit twice before stays, and is no smoke; what lies on no surface and was not there in any
/// of them is smoke without the radar's word, up to four metres. The share over the whole scan says how much the lidar
/// is still worth.
///
/// Measured in 20 burning buildings (`bench smoke-beams`), without and with the scans before; of the echoes of smoke
/// found: below 2 m 98 %, at 2 to 3 m 92 %, at 3 to 4 m 68 and 85 %, beyond, where they are one in a thousand, half; of
/// the walls' mistaken for smoke: 0.02 to 0.2 % at 0.5 to 2 m, 1.3 and 0.1 % at 2 to 3 m, 2.0 and 0.5 % at 3 to 4
/// m, 4.6 and 0.7 % at 4 to 6 m. Nearer than 0.5 m 2 % (up to 20 % in the thickest smoke): the reflex stop does not
/// rely on it (navigation/obstacle_watch).
/// @param T_now_then  pose of the robot at the sweep, seen from the robot at the scan
/// @param earlier  without it, or with fewer than three fresh scans, each scan is judged by itself
/// Source: the lidar-radar ratio of Fritsche et al. (2016), per beam instead of per scan; the rest is our own.
SmokeView look_for_smoke(const LaserScan& scan, const BeamConvention& convention, const RadarSweep& sweep,
                         const Pose2& T_now_then, const RadarParams& params, const EarlierScans& earlier = {});

}  // namespace smokemap
