#pragma once

#include <random>

#include "core/result.hpp"
#include "core/time.hpp"
#include "geometry/pose2.hpp"
#include "maps/odometry.hpp"
#include "simulation/segment_world.hpp"

namespace smokemap {

struct DriveParams {
  double radius_m = 0.25;  ///< the robot is a disc
  double max_speed_mps = 0.7;
  double max_turn_rate_radps = 1.5;
  double acceleration_mps2 = 0.8;
  double turn_acceleration_radps2 = 4.0;
  double dead_man_s = 0.5;  ///< brakes when no command came for so long

  // Odometry. Noise grows with the square root of the way, so that it does not depend on the step.
  double sigma_turn_per_turn = 0.03;    ///< rad per sqrt(rad)   (alpha 1)
  double sigma_turn_per_metre = 0.01;   ///< rad per sqrt(m)     (alpha 2)
  double sigma_way_per_metre = 0.02;    ///< m per sqrt(m)       (alpha 3)
  double sigma_way_per_turn = 0.005;    ///< m per sqrt(rad)     (alpha 4)
  double sigma_scale = 0.02;            ///< systematic, drawn once a robot: wheel size
  double sigma_turn_scale = 0.02;       ///< systematic: wheel distance
  double sigma_bend_rad_per_m = 0.005;  ///< systematic: unequal wheels
  Result<Ok> validate() const;
};

/// A differential drive in a world with walls.
///
/// Limits: speed, turn rate and their rates of change. A step that would bring the disc into a wall is not taken: the
/// robot bumps, stands, and may turn or back off. Odometry reports the way of the wheels with noise and a bias.
class RobotDrive {
 public:
  RobotDrive(const DriveParams& params, const Pose2& T_world_start, std::mt19937_64 random);

  /// What the robot is told; forgotten after `dead_man_s`.
  void command(double speed_mps, double turn_rate_radps, Stamp now);
  /// Moves for `dt` ending at `now`.
  void step(const SegmentWorld& world, Stamp dt, Stamp now);

  const Pose2& true_pose() const { return T_world_robot_; }
  const Pose2& odometry_pose() const { return T_odom_robot_; }
  double speed_mps() const { return speed_; }
  double turn_rate_radps() const { return turn_rate_; }
  int bumps() const { return bumps_; }       ///< counted once per touch
  bool braking() const { return braking_; }  ///< the dead-man timer ran out

 private:
  void measure(double way_m, double turn_rad);

  DriveParams params_;
  std::mt19937_64 random_;
  Pose2 T_world_robot_, T_odom_robot_;
  double scale_ = 1, turn_scale_ = 1, bend_ = 0;
  double wanted_speed_ = 0, wanted_turn_ = 0, speed_ = 0, turn_rate_ = 0;
  Stamp last_command_ = 0;
  bool commanded_ = false, braking_ = true, touching_ = false;
  int bumps_ = 0;
};

}  // namespace smokemap
