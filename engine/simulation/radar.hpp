#pragma once

#include <random>

#include "maps/laser_scan.hpp"
#include "maps/radar_sweep.hpp"
#include "simulation/segment_world.hpp"

namespace smokemap {

/// A spinning FMCW radar of the MPR class (Fritsche et al. 2016: 94 GHz, 2.5 turns a second). Smoke does not matter to
/// it.
struct RadarSimParams {
  int azimuths = 200;
  int bins = 400;
  double bin_m = 0.0375;
  double turn_s = 0.40;
  double beam_width_rad = 0.0436;  ///< half power, 2.5 deg
  double side_lobe_db = -22;
  double snr_db = 25;          ///< brick, square on, at 5 m, over the receiver's noise
  double diffuse = 0.02;       ///< share of the echo that does not depend on incidence
  double transmission = 0.30;  ///< through a wall of plasterboard or wood
  double ghost_share = 0.18;   ///< of beams that show a mirror image
  double ghost_db = -12;
  double saturation_db = 55;  ///< receiver clips above
  double blind_m = 0.5;
  Pose2 T_robot_radar;
  Result<Ok> validate() const;
};

/// One turn while the robot moves from T_world_start to T_world_end; every azimuth at its own pose.
/// Power of a bin: exponential with the mean (echo + 1), as the sum of speckle and receiver noise is.
RadarSweep simulate_sweep(const SegmentWorld& world, const Pose2& T_world_start, const Pose2& T_world_end, Stamp stamp,
                          const RadarSimParams& params, std::mt19937_64& random);

/// The strongest bin of every azimuth as a scan, as some drivers deliver it; no echo below `floor_db` = infinity.
LaserScan strongest_returns(const RadarSweep& sweep, double floor_db = 12);

}  // namespace smokemap
