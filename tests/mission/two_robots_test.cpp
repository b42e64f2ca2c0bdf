// Two robots on one floor: the second is looked for in the map that the first one made, then both make it.
#include <gtest/gtest.h>

#include "session/mapper.hpp"
#include "session/merger.hpp"
#include "session/session_core.hpp"
#include "simulation/demo_scenario.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using Robots = std::map<std::string, SimulatedRobot>;

class DriveByName final : public RobotCommands {
 public:
  explicit DriveByName(Robots& robots) : robots_(robots) {}
  void drive(const std::string& robot, double speed_mps, double turn_rate_radps) override {
    robots_.at(robot).command(speed_mps, turn_rate_radps);
  }

 private:
  Robots& robots_;
};

class Floor {
 public:
  explicit Floor(const DemoScenario& demo) : demo_(demo) {
    add("robot1", demo.T_world_start, 1);
    ENGINE_EXPECT(core_.apply(SetLayout{"plan", demo.truth.layout}, Origin::kLive).ok());
    ENGINE_EXPECT(core_.apply(SetStart{"robot1", demo.start.layout_px, demo.start.heading_rad}, Origin::kLive).ok());
    merge();
  }

  void add(const std::string& name, const Pose2& T_world_start, std::uint64_t index) {
    SimulatedRobotParams params = demo_robot_params(demo_);
    params.name = name;
    params.index = index;
    params.start = robots_.empty() ? params.start : robots_.begin()->second.now();
    robots_.try_emplace(name, params, T_world_start);
    ENGINE_EXPECT(core_.apply(SetExploring{name, true}, Origin::kLive).ok());
  }

  /// A robot that is not localised is driven round by hand, as people do it.
  void drive_by_hand(const std::string& name) { by_hand_ = name; }

  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 100); ++i) {
      for (auto& [name, robot] : robots_) step(name, robot);
      ++steps_;
      if (steps_ % 10 == 0) core_.tick(robots_.begin()->second.now());
      if (steps_ % 10 == 0 && !by_hand_.empty() && !status(by_hand_).localized)
        robots_.at(by_hand_).command(0.2, steps_ / 300 % 2 == 0 ? 0.5 : -0.35);
      if (steps_ % 100 == 0 && mapper_.optimize()) merge();
    }
  }

  RobotStatus status(const std::string& name) const {
    for (const RobotStatus& s : core_.snapshot(0).robots)
      if (s.id == name) return s;
    return {};
  }
  Pose2 true_pose_in_map(const std::string& name) const {
    return demo_.T_world_start.inverse() * robots_.at(name).true_pose();
  }
  std::size_t nodes_of(const std::string& name) const {
    const auto& nodes = mapper_.graph().graph->nodes;
    return static_cast<std::size_t>(
        std::count_if(nodes.begin(), nodes.end(), [&](const PoseNode& n) { return n.robot == name; }));
  }
  SessionCore& core() { return core_; }

 private:
  void step(const std::string& name, SimulatedRobot& robot) {
    const RobotOutput out = robot.step(demo_.world);
    for (const Odometry& odometry : out.odometry) feed(name, odometry);
    for (const RadarSweep& sweep : out.sweeps) feed(name, sweep);
    for (const LaserScan& scan : out.scans) feed(name, scan);
  }
  void feed(const std::string& name, const SensorItem& item) {
    const auto report = mapper_.add(item);
    core_.heard(name, robots_.begin()->second.now());
    if (report) core_.report(*report);
    mapper_.take(core_.floor());
  }
  void merge() { core_.take(merger_.run(core_.merge_input(mapper_.graph()))); }

  const DemoScenario& demo_;
  Robots robots_;
  Mapper mapper_;
  Merger merger_;
  SessionCore core_{FleetParams{}, std::make_shared<DriveByName>(robots_)};
  std::string by_hand_;
  long steps_ = 0;
};

/// Where a finger puts the second robot on the plan.
SetStart finger_at(const DemoScenario& demo) { return {"robot2", demo.start.layout_px, demo.start.heading_rad}; }

TEST(TwoRobots, TheSecondOneIsNotLocalisedUntilItIsFoundAndThenHelps) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  Floor floor(*demo);
  floor.run(25);
  ASSERT_TRUE(floor.status("robot1").localized);
  floor.add("robot2", demo->T_world_start, 2);
  floor.run(1);
  EXPECT_FALSE(floor.status("robot2").localized) << "nobody said where it is, and it saw almost nothing";
  EXPECT_EQ(floor.nodes_of("robot2"), 0u);
  ASSERT_THAT(floor.core().apply(finger_at(*demo), Origin::kLive), test::IsOk());
  floor.drive_by_hand("robot2");
  floor.run(20);
  ASSERT_TRUE(floor.status("robot2").localized);
  EXPECT_GT(floor.nodes_of("robot2"), 3u);
  floor.run(15);
  // While a robot turns, the pose of its last scan is up to a tenth of a second, and as many radians, behind.
  ASSERT_THAT(floor.core().apply(EmergencyStop{}, Origin::kLive), test::IsOk());
  floor.run(1);
  for (const char* robot : {"robot1", "robot2"})
    EXPECT_THAT(floor.status(robot).T_map_robot, test::IsNear(floor.true_pose_in_map(robot), 0.3, 0.05)) << robot;
}

}  // namespace
}  // namespace smokemap
