#include "tests/support/mission.hpp"

#include <algorithm>

namespace smokemap::test {
namespace {

class DirectDrive final : public RobotCommands {
 public:
  explicit DirectDrive(SimulatedRobot& robot) : robot_(robot) {}
  void drive(const std::string&, double speed_mps, double turn_rate_radps) override {
    robot_.command(speed_mps, turn_rate_radps);
  }

 private:
  SimulatedRobot& robot_;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

class Mission {
 public:
  Mission(const DemoScenario& demo, const MissionParams& params)
      : demo_(demo),
        params_(params),
        world_(demo.world),
        layout_(params.layout.value_or(demo.truth.layout)),
        robot_(demo_robot_params(demo), demo.T_world_start),
        core_(FleetParams{}, std::make_shared<DirectDrive>(robot_)) {}

  MissionResult run() {
    begin();
    const Stamp start = robot_.now();
    while (to_seconds(robot_.now() - start) < params_.limit_s && !ended()) {
      step();
      const double t = to_seconds(robot_.now() - start);
      if (!asked_ && t >= params_.explore_s) ask_for_far_room();
    }
    return result(to_seconds(robot_.now() - start));
  }

 private:
  void begin() {
    ENGINE_EXPECT(core_.apply(SetLayout{"plan", layout_}, Origin::kLive).ok());
    ENGINE_EXPECT(
        core_.apply(SetStart{robot_.name(), demo_.start.layout_px, demo_.start.heading_rad}, Origin::kLive).ok());
    ENGINE_EXPECT(core_.apply(SetExploring{robot_.name(), true}, Origin::kLive).ok());
    merge();
    before_ = corner_errors(false);
  }

  void step() {
    const int bumps_before = robot_.drive().bumps();
    const RobotOutput out = robot_.step(world_);
    if (robot_.drive().bumps() > bumps_before)
      bumped_.push_back({static_cast<double>(steps_) * 0.01, robot_.true_pose()});
    for (const Odometry& odometry : out.odometry) feed(odometry);
    for (const RadarSweep& sweep : out.sweeps) feed(sweep);
    for (const LaserScan& scan : out.scans) feed(scan);
    ++steps_;
    if (steps_ % 10 == 0) core_.tick(robot_.now());
    if (steps_ % 50 == 0) way_.push_back(robot_.true_pose().translation());
    if (steps_ % 100 == 0) {
      if (params_.smoke_spreads) world_.smoke.advance(1.0);
      if (mapper_.optimize()) merge();
      if (params_.every_second) params_.every_second(core_, static_cast<double>(steps_) * 0.01);
    }
  }

  void feed(const SensorItem& item) {
    const auto report = mapper_.add(item);
    core_.heard(robot_.name(), robot_.now());
    if (report) core_.report(*report);
    mapper_.take(core_.floor());
  }

  void merge() { core_.take(merger_.run(core_.merge_input(mapper_.graph()))); }

  void ask_for_far_room() {
    asked_ = true;
    SetGoal set;
    set.goal.id = "far";
    set.goal.robot = robot_.name();
    set.goal.place = {PlaceFrame::kLayoutPx, demo_.far_room_px, 0};
    ENGINE_EXPECT(core_.apply(set, Origin::kLive).ok());
  }

  bool ended() const {
    const Snapshot snapshot = core_.snapshot(0);
    return asked_ && is_final(snapshot.goals.front().goal.state);
  }

  /// Where the plan's true corners are put, against where they are.
  std::vector<double> corner_errors(bool seen_only) const {
    const Snapshot snapshot = core_.snapshot(0);
    const LayoutMap& truth = demo_.truth.layout;
    std::vector<bool> exists(truth.corners.size(), false), seen(truth.corners.size(), true);
    for (std::size_t i = 0; i < truth.walls.size(); ++i)
      if (demo_.truth.wall_source[i] >= 0)
        exists[static_cast<std::size_t>(truth.walls[i].corner_a)] =
            exists[static_cast<std::size_t>(truth.walls[i].corner_b)] = true;
    if (seen_only)
      for (std::size_t i = 0; i < seen.size(); ++i)
        seen[i] = !params_.layout && i < snapshot.merged->corners.size() && snapshot.merged->corners[i].seen;
    std::vector<double> errors;
    for (std::size_t i = 0; i < truth.corners.size(); ++i) {
      if (!exists[i] || !seen[i]) continue;
      const Point2 p_map = snapshot.merged->layout_to_map(layout_.frame().to_metres(truth.corners[i].p_px));
      errors.push_back((p_map - demo_.to_map(demo_.truth.corner_world[i])).norm());
    }
    return errors;
  }

  MissionResult result(double time_s) const {
    const Snapshot snapshot = core_.snapshot(0);
    MissionResult r;
    r.time_s = time_s;
    r.merged = snapshot.merged;
    r.sensed = snapshot.sensed;
    r.way_world = way_;
    r.smoke = world_.smoke;
    r.corners = static_cast<int>(before_.size());
    r.before_median_m = median(before_);
    r.after_median_m = median(corner_errors(false));
    const std::vector<double> seen = corner_errors(true);
    r.seen = static_cast<int>(seen.size());
    r.after_seen_median_m = median(seen);
    r.bumps = robot_.drive().bumps();
    r.bumped = bumped_;
    const Pose2 T_map_true = demo_.T_world_start.inverse() * robot_.true_pose();
    if (!snapshot.robots.empty()) {
      const RobotStatus& said = snapshot.robots.front();
      r.pose_error_m = (said.T_map_robot.translation() - T_map_true.translation()).norm();
      r.pose_sigma_m = said.sigma_m;
    }
    if (!snapshot.goals.empty()) {
      r.goal = snapshot.goals.front().goal.state;
      r.reason = snapshot.goals.front().goal.reason;
      r.goal_error_m = (robot_.true_pose().translation() - demo_.p_world_far_room).norm();
    }
    return r;
  }

  const DemoScenario& demo_;
  const MissionParams& params_;
  SimulatedWorld world_;
  LayoutMap layout_;
  SimulatedRobot robot_;
  Mapper mapper_;
  Merger merger_;
  SessionCore core_;
  std::vector<double> before_;
  std::vector<Point2> way_;
  std::vector<Bump> bumped_;
  long steps_ = 0;
  bool asked_ = false;
};

}  // namespace

MissionResult run_mission(const DemoScenario& demo, const MissionParams& params) { return Mission(demo, params).run(); }

}  // namespace smokemap::test
