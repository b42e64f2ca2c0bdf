#include "simulation/recorded_run.hpp"

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr double kStandStillS = 0.5;  ///< the first scans are taken from the very pose that is the origin of the map

std::vector<Segment2> planned_walls(const DemoScenario& demo) {
  std::vector<Segment2> walls;
  const auto at = [&](int corner) { return demo.truth.corner_world[static_cast<std::size_t>(corner)]; };
  for (const LayoutWall& wall : demo.truth.layout.walls) walls.push_back({at(wall.corner_a), at(wall.corner_b)});
  return walls;
}

}  // namespace

Result<Ok> RunParams::validate() const {
  return ParamCheck("RunParams").in_range("max_duration_s", max_duration_s, 0.1, 36000).result();
}

Result<RecordedRun> record_run(const DemoScenario& demo, const RunParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  SimulatedRobotParams robot_params = demo_robot_params(demo);
  robot_params.with_radar = params.with_radar;
  robot_params.lidar.skew = params.skew;
  SimulatedRobot robot(robot_params, demo.T_world_start);
  PathDriver driver(demo.world.walls);
  const Point2 start = demo.T_world_start.translation();
  RecordedRun run;
  run.places = driver.visit(start, params.waypoints.empty() ? room_tour(demo.building, start) : params.waypoints);
  if (run.places == 0) return fail(Errc::kDegenerate, "the robot can reach none of the places it should visit");
  std::vector<Segment2> watched = planned_walls(demo);
  for (const int wall : demo.plan.missing)
    for (const Segment2& piece : demo.building.wall_pieces(wall)) run.unplanned.push_back(piece);
  watched.insert(watched.end(), run.unplanned.begin(), run.unplanned.end());
  run.witness = WallWitness(std::move(watched));
  run.visited.assign(demo.building.rooms.size(), false);

  const Pose2 T_map_world = demo.T_world_start.inverse();
  Pose2 T_world_turn = robot.true_pose(), T_odom_turn = robot.drive().odometry_pose(), before = robot.true_pose();
  while (!driver.done() && to_seconds(robot.now()) < params.max_duration_s) {
    if (to_seconds(robot.now()) >= kStandStillS) {
      const VelocityCommand command = driver.drive(robot.true_pose());
      robot.command(command.speed_mps, command.turn_rate_radps);
    }
    RobotOutput out = robot.step(demo.world);
    run.way_m += (robot.true_pose().translation() - before.translation()).norm();
    before = robot.true_pose();
    for (LaserScan& scan : out.scans) {
      if (!params.skew) {
        T_world_turn = robot.true_pose();
        T_odom_turn = robot.drive().odometry_pose();
      }
      run.witness.add(scan, T_world_turn, robot.true_pose());
      run.truth.push_back({scan.stamp, T_map_world * T_world_turn, Eigen::Matrix3d::Zero()});
      run.T_odom_scan.push_back(T_odom_turn);
      T_world_turn = robot.true_pose();
      const int room = demo.building.room_at(T_world_turn.translation());
      if (room >= 0) run.visited[static_cast<std::size_t>(room)] = true;
      T_odom_turn = robot.drive().odometry_pose();
      run.items.emplace_back(std::move(scan));
    }
    for (Odometry& odometry : out.odometry) run.items.emplace_back(std::move(odometry));
    for (RadarSweep& sweep : out.sweeps) run.items.emplace_back(std::move(sweep));
  }
  run.bumps = robot.drive().bumps();
  run.duration_s = to_seconds(robot.now());
  return run;
}

}  // namespace smokemap
