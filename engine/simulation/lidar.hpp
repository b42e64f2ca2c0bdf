#pragma once

#include <random>

#include "maps/laser_scan.hpp"
#include "simulation/segment_world.hpp"
#include "simulation/smoke.hpp"

namespace smokemap {

/// What a driver writes where there was no echo; all of these occur in real bags.
enum class NoEcho { kInfinity, kZero, kNan, kMaxPlusOne };

/// A 2D lidar, SICK / VLP-16 class. Source of the numbers: power budget of a 905 nm scanner, 100 m on 10 % in clear
/// air.
struct LidarParams {
  int beams = 360;
  double angle_min_rad = -3.14159265358979323846;
  double field_of_view_rad = 2 * 3.14159265358979323846;
  double range_min_m = 0.08;
  double range_max_m = 15.0;
  double turn_s = 0.1;  ///< from the first beam to the next turn's first
  bool skew = true;     ///< false: all beams at the moment of the stamp
  double sigma_range_m = 0.01;
  double dropout = 0.005;         ///< share of echoes lost in clear air
  double beam_width_rad = 0.003;  ///< mixed ranges at edges
  double margin_db = 40.0;        ///< at 1 m on 10 % reflectance
  double sigma_margin_db = 1.5;
  double smoke_echo = 0.3;  ///< 0.3 strongest-return, 0.8 first-return scanners
  NoEcho no_echo = NoEcho::kInfinity;
  Pose2 T_robot_laser;
  Result<Ok> validate() const;
};

/// What truly happened to a beam; for tests and for judging.
enum class BeamFate { kWall, kSmoke, kLost };
struct SimulatedScan {
  LaserScan scan;
  std::vector<BeamFate> fate;
};

/// One turn while the robot moves from T_world_start to T_world_end (straight, constant speed).
/// Smoke: power margin in dB = margin - 20 log10 r - 8.686 * integral + 10 log10(reflectance / 0.1); no echo below
/// zero; a false echo at s with density alpha(s) exp(-2 integral) / max(s, 0.5)^2 and total probability 1 -
/// exp(-smoke_echo * integral).
SimulatedScan simulate_scan(const SegmentWorld& world, const SmokeField& smoke, const Pose2& T_world_start,
                            const Pose2& T_world_end, Stamp stamp, const LidarParams& params, std::mt19937_64& random);

/// Share of 905 nm light that comes back diffusely.
double reflectance(Material material);

}  // namespace smokemap
