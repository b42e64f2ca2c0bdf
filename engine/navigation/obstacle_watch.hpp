#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "maps/laser_scan.hpp"
#include "maps/radar_sweep.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

struct ObstacleParams {
  double near_m = 1.2;           ///< what is farther away stops nobody yet
  double body_m = 0.20;          ///< what is nearer than this would stand within the robot: smoke
  double together_m = 0.08;      ///< echoes of one obstacle over the last scans ...
  int least_together = 4;        ///< ... are at least so many: where smoke is thick some of its echoes look solid
  double half_width_m = 0.02;    ///< beams that pass this near to an echo judge it
  double behind_m = 0.06;        ///< a beam that goes on this far past the place went through it
  double most_through = 0.30;    ///< share of beams that may pass through an obstacle (edges, glass)
  int scans = 6;                 ///< looked back on
  double sweep_valid_s = 1.5;    ///< an older radar turn says nothing about smoke now
  double smoky_share = 0.30;     ///< from this share of beams lost in smoke on the radar's echoes are obstacles too ...
  int sweeps = 10;               ///< ... of so many turns, each from another place:
  double sweep_every_m = 0.08;   ///< what came nearer than the radar sees is remembered by the way, not by the clock
  double radar_behind_m = 0.30;  ///< a later turn that sees only what is farther by this saw through the place
  Result<Ok> validate() const;
};

/// Tells obstacles from smoke for the reflex stop. An echo of the lidar is an obstacle when the beams of the last scans
/// end there, and smoke when beams keep going through the place, or look_for_smoke says so. Where smoke blinds the
/// lidar the radar's nearest echoes are obstacles as well, unless the lidar or a later turn of the radar sees through
/// them. One robot; no clock.
class ObstacleWatch {
 public:
  explicit ObstacleWatch(const ObstacleParams& params = {}) : params_(params) {}

  /// Poses are those at the stamps; the twist straightens the turn.
  void add_sweep(const RadarSweep& sweep, const Pose2& T_odom_robot, const Twist2& twist = {});
  void add_scan(const LaserScan& scan, const Pose2& T_odom_robot, const Twist2& twist = {});
  /// In the frame of the robot where it is now.
  std::vector<Point2> obstacles_robot(const Pose2& T_odom_robot) const;
  /// Of the beams that should have ended at a wall near, those that did not: the mean of the last scans, 0 without a
  /// radar.
  double smoke_share() const { return smoke_share_; }

 private:
  struct Look {
    Pose2 T_odom_laser;
    double angle_min_rad = 0, angle_increment_rad = 0;
    std::vector<float> range_m;     ///< up to here the way is free; 0 = says nothing
    std::vector<Point2> near_odom;  ///< echoes that something solid may have sent, within near_m
  };
  struct Turn {
    Pose2 T_odom_robot;
    std::vector<double> nearest_m;  ///< echo by bearing seen from the robot, 0 = none
    std::vector<Point2> near_odom;
  };
  /// Of the lidar's echoes, in odom: those that are solid and not alone.
  std::vector<Point2> solid_echoes() const;
  bool lidar_stops_at(const Point2& p_odom, bool says_radar) const;
  bool radar_saw_through(const Point2& p_odom, std::size_t after_turn) const;

  ObstacleParams params_;
  std::deque<Look> looks_;
  std::deque<Turn> turns_;
  std::optional<RadarSweep> sweep_;
  Pose2 T_odom_sweep_;
  double smoke_share_ = 0;
};

}  // namespace smokemap
