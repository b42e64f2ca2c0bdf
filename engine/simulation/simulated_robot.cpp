#include "simulation/simulated_robot.hpp"

#include "core/check.hpp"
#include "core/expect.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

enum RobotStream : std::uint64_t { kDriveStream = 1, kLidarStream = 2, kRadarStream = 3 };

}  // namespace

Result<Ok> SimulatedRobotParams::validate() const {
  for (const auto& part : {lidar.validate(), radar.validate(), drive.validate()})
    if (!part) return part.error();
  return ParamCheck("SimulatedRobotParams")
      .in_range("odometry_hz", odometry_hz, 0.1, 100)
      .require("name", !name.empty(), "must not be empty")
      .require("lidar.turn_s", lidar.turn_s >= to_seconds(SimulatedRobot::kStep), "must be at least one step of 10 ms")
      .result();
}

SimulatedRobot::SimulatedRobot(const SimulatedRobotParams& params, const Pose2& T_world_start)
    : params_(params),
      drive_(params.drive, T_world_start, random_stream(params.seed, params.index, kDriveStream)),
      now_(params.start),
      T_world_scan_start_(T_world_start),
      T_world_sweep_start_(T_world_start),
      scan_start_(params.start),
      sweep_start_(params.start),
      next_odometry_(params.start + from_seconds(1 / params.odometry_hz)) {
  ENGINE_EXPECT(params.validate().ok());
}

RobotOutput SimulatedRobot::step(const SimulatedWorld& world) {
  now_ += kStep;
  drive_.step(world.walls, kStep, now_);

  RobotOutput out;
  if (now_ >= next_odometry_) {
    Odometry odometry;
    odometry.stamp = now_;
    odometry.robot = params_.name;
    odometry.T_odom_robot = drive_.odometry_pose();
    odometry.speed_mps = drive_.speed_mps();
    odometry.turn_rate_radps = drive_.turn_rate_radps();
    out.odometry.push_back(odometry);
    next_odometry_ += from_seconds(1 / params_.odometry_hz);
  }
  if (params_.with_lidar && now_ - scan_start_ >= from_seconds(params_.lidar.turn_s)) {
    auto random = random_stream(params_.seed, params_.index, kLidarStream, scans_++);
    if (!params_.lidar.skew) {
      scan_start_ = now_;
      T_world_scan_start_ = true_pose();
    }
    SimulatedScan turn =
        simulate_scan(world.walls, world.smoke, T_world_scan_start_, true_pose(), scan_start_, params_.lidar, random);
    turn.scan.robot = params_.name;
    out.scans.push_back(std::move(turn.scan));
    scan_start_ = now_;
    T_world_scan_start_ = true_pose();
  }
  if (params_.with_radar && now_ - sweep_start_ >= from_seconds(params_.radar.turn_s)) {
    auto random = random_stream(params_.seed, params_.index, kRadarStream, sweeps_++);
    out.sweeps.push_back(
        simulate_sweep(world.walls, T_world_sweep_start_, true_pose(), sweep_start_, params_.radar, random));
    out.sweeps.back().robot = params_.name;
    sweep_start_ = now_;
    T_world_sweep_start_ = true_pose();
  }
  return out;
}

}  // namespace smokemap
