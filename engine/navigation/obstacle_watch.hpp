#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "maps/laser_scan.hpp"
#include "maps/radar_sweep.hpp"

namespace smokemap {

struct ObstacleParams {
  double near_m = 1.2;         ///< what is farther away stops nobody yet
  double half_width_m = 0.03;  ///< beams that pass this near to an echo judge it
  double behind_m = 0.10;      ///< a beam that goes on this far past the place went through it
  double most_through = 0.30;  ///< share of beams that may pass through an obstacle (edges, glass)
  int scans = 6;               ///< looked back on
  double sweep_valid_s = 1.5;  ///< an older radar turn says nothing about smoke now
  Result<Ok> validate() const;
};

/// Tells obstacles from smoke for the reflex stop: an echo is an obstacle when the beams of the last scans end there,
/// and smoke when beams keep going through the place, or the radar does. One robot; no clock.
class ObstacleWatch {
 public:
  explicit ObstacleWatch(const ObstacleParams& params = {}) : params_(params) {}

  void add_sweep(const RadarSweep& sweep, const Pose2& T_odom_robot);
  void add_scan(const LaserScan& scan, const Pose2& T_odom_robot);
  /// In the frame of the robot at the latest scan.
  std::vector<Point2> obstacles_robot() const;

 private:
  struct Beam {
    double angle_rad;  ///< in the laser frame
    double range_m;    ///< up to here the way is free; 0 = says nothing
    bool echo;         ///< something solid ended it
  };
  struct Look {
    Pose2 T_odom_laser;
    double angle_min_rad = 0, angle_increment_rad = 0;
    std::vector<Beam> beams;
  };
  bool is_solid(const Point2& p_odom) const;

  ObstacleParams params_;
  std::deque<Look> looks_;
  Pose2 T_odom_robot_;
  std::optional<RadarSweep> sweep_;
  Pose2 T_odom_sweep_;
};

}  // namespace smokemap
