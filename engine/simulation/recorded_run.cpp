#include "simulation/recorded_run.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "simulation/simulated_fleet.hpp"

namespace smokemap {
namespace {

constexpr double kStandStillS = 0.5;  ///< the first scans are taken from the very pose that is the origin of the map
constexpr double kMeetingM = 0.9;

std::vector<Segment2> planned_walls(const DemoScenario& demo) {
  std::vector<Segment2> walls;
  const auto at = [&](int corner) { return demo.truth.corner_world[static_cast<std::size_t>(corner)]; };
  for (const LayoutWall& wall : demo.truth.layout.walls) walls.push_back({at(wall.corner_a), at(wall.corner_b)});
  return walls;
}

/// A robot on its tour.
struct Tourist {
  PathDriver driver;
  Pose2 T_world_turn, T_odom_turn;  ///< when the present turn of its lidar began
  Pose2 before;
  Trajectory truth;
};

class Recorder {
 public:
  Recorder(const DemoScenario& demo, const RunParams& params, const std::vector<FleetMember>& members)
      : demo_(demo), params_(params), fleet_(demo.world, members, params.smoke_spreads) {
    const PathDriver driver(demo.world.walls);
    for (const FleetMember& member : members) {
      tourists_.push_back({driver, member.T_world_start, {}, member.T_world_start, {}});
      starts_.push_back(member.T_world_start.translation());
    }
  }

  Result<RecordedRun> run() {
    share_places();
    if (run_.places == 0) return fail(Errc::kDegenerate, "the robot can reach none of the places it should visit");
    std::vector<Segment2> watched = planned_walls(demo_);
    for (const int wall : demo_.plan.missing)
      for (const Segment2& piece : demo_.building.wall_pieces(wall)) run_.unplanned.push_back(piece);
    watched.insert(watched.end(), run_.unplanned.begin(), run_.unplanned.end());
    run_.witness = WallWitness(std::move(watched));
    run_.visited.assign(demo_.building.rooms.size(), false);
    const auto now_s = [&] { return to_seconds(fleet_.robot(0).now()); };
    while (!everybody_is_done() && now_s() < params_.max_duration_s) {
      for (std::size_t i = 0; now_s() >= kStandStillS && i < fleet_.size(); ++i) drive(i);
      std::vector<RobotOutput> outputs = fleet_.step();
      for (std::size_t i = 0; i < fleet_.size(); ++i) record(i, std::move(outputs[i]));
    }
    for (std::size_t i = 0; i < fleet_.size(); ++i) run_.bumps += fleet_.robot(i).drive().bumps();
    run_.duration_s = now_s();
    run_.truth = std::move(tourists_.front().truth);
    for (std::size_t i = 1; i < fleet_.size(); ++i) run_.others[fleet_.robot(i).name()] = std::move(tourists_[i].truth);
    return std::move(run_);
  }

 private:
  void share_places() {
    std::vector<std::vector<Point2>> places(fleet_.size());
    if (params_.waypoints.empty()) places = room_tours(demo_.building, starts_);
    for (std::size_t i = 0; i < params_.waypoints.size(); ++i)
      places[i % fleet_.size()].push_back(params_.waypoints[i]);
    for (std::size_t i = 0; i < fleet_.size(); ++i) run_.places += tourists_[i].driver.visit(starts_[i], places[i]);
  }

  bool everybody_is_done() const {
    return std::all_of(tourists_.begin(), tourists_.end(), [](const Tourist& t) { return t.driver.done(); });
  }

  /// Of two robots that meet the one with the higher number waits.
  bool waits(std::size_t i) const {
    const Pose2 T_robot_world = fleet_.robot(i).true_pose().inverse();
    for (std::size_t other = 0; other < i; ++other) {
      const Point2 p = T_robot_world * fleet_.robot(other).true_pose().translation();
      if (p.norm() < kMeetingM && p.x() > 0) return true;
    }
    return false;
  }

  void drive(std::size_t i) {
    VelocityCommand command = tourists_[i].driver.drive(fleet_.robot(i).true_pose());
    if (waits(i)) command = {};
    fleet_.robot(i).command(command.speed_mps, command.turn_rate_radps);
  }

  void record(std::size_t i, RobotOutput out) {
    const SimulatedRobot& robot = fleet_.robot(i);
    Tourist& tourist = tourists_[i];
    const Pose2 T_map_world = demo_.T_world_start.inverse();
    run_.way_m += (robot.true_pose().translation() - tourist.before.translation()).norm();
    tourist.before = robot.true_pose();
    for (LaserScan& scan : out.scans) {
      if (!params_.skew) {
        tourist.T_world_turn = robot.true_pose();
        tourist.T_odom_turn = robot.drive().odometry_pose();
      }
      run_.witness.add(scan, tourist.T_world_turn, robot.true_pose());
      tourist.truth.push_back({scan.stamp, T_map_world * tourist.T_world_turn, Eigen::Matrix3d::Zero()});
      run_.T_odom_scan.push_back(tourist.T_odom_turn);
      tourist.T_world_turn = robot.true_pose();
      tourist.T_odom_turn = robot.drive().odometry_pose();
      const int room = demo_.building.room_at(robot.true_pose().translation());
      if (room >= 0) run_.visited[static_cast<std::size_t>(room)] = true;
      run_.items.emplace_back(std::move(scan));
    }
    for (Odometry& odometry : out.odometry) run_.items.emplace_back(std::move(odometry));
    for (RadarSweep& sweep : out.sweeps) run_.items.emplace_back(std::move(sweep));
  }

  const DemoScenario& demo_;
  const RunParams& params_;
  SimulatedFleet fleet_;
  std::vector<Tourist> tourists_;
  std::vector<Point2> starts_;
  RecordedRun run_;
};

}  // namespace

Result<Ok> RunParams::validate() const {
  return ParamCheck("RunParams")
      .in_range("max_duration_s", max_duration_s, 0.1, 36000)
      .in_range("robots", robots, 1, kMostRobots)
      .result();
}

Result<RecordedRun> record_run(const DemoScenario& demo, const RunParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  auto members = demo_fleet(demo, params.robots);
  if (!members) return members.error();
  for (FleetMember& member : *members) {
    member.params.with_radar = params.with_radar;
    member.params.lidar.skew = params.skew;
  }
  Recorder recorder(demo, params, *members);
  return recorder.run();
}

}  // namespace smokemap
