#pragma once

#include <string>
#include <vector>

#include "simulation/lidar.hpp"
#include "simulation/radar.hpp"
#include "simulation/robot_drive.hpp"
#include "simulation/smoke.hpp"

namespace smokemap {

/// What robots share: walls, doors, smoke.
struct SimulatedWorld {
  SegmentWorld walls;
  SmokeField smoke;

  void set_door(int door, double open_rad) {
    walls.set_door(door, open_rad);
    smoke.read_walls(walls);
  }
};

struct SimulatedRobotParams {
  std::string name = "robot1";
  std::uint64_t index = 1;  ///< its noise streams: adding a robot does not change another's noise
  std::uint64_t seed = 1;
  LidarParams lidar;
  RadarSimParams radar;
  DriveParams drive;
  bool with_lidar = true;
  bool with_radar = true;
  double odometry_hz = 20;
  Stamp start = 0;  ///< of the robot's clock
  Result<Ok> validate() const;
};

/// What left the robot during one step, in time order per sensor.
struct RobotOutput {
  std::vector<LaserScan> scans;
  std::vector<RadarSweep> sweeps;
  std::vector<Odometry> odometry;
};

/// A robot on an integer clock of 10 ms steps. Same seed, index and commands at the same steps: the same bytes.
/// A scan is delivered when its turn ends, stamped with its first beam (without skew: taken and stamped there). Truth
/// is separate: nothing of it is in the output.
class SimulatedRobot {
 public:
  static constexpr Stamp kStep = 10'000'000;

  SimulatedRobot(const SimulatedRobotParams& params, const Pose2& T_world_start);

  void command(double speed_mps, double turn_rate_radps) { drive_.command(speed_mps, turn_rate_radps, now_); }
  RobotOutput step(const SimulatedWorld& world);

  Stamp now() const { return now_; }
  const std::string& name() const { return params_.name; }
  const SimulatedRobotParams& params() const { return params_; }
  const Pose2& true_pose() const { return drive_.true_pose(); }
  const RobotDrive& drive() const { return drive_; }

 private:
  SimulatedRobotParams params_;
  RobotDrive drive_;
  Stamp now_ = 0;
  Pose2 T_world_scan_start_, T_world_sweep_start_;
  Stamp scan_start_ = 0, sweep_start_ = 0, next_odometry_ = 0;
  std::uint64_t scans_ = 0, sweeps_ = 0;
};

}  // namespace smokemap
