#pragma once

#include <vector>

#include "simulation/demo_scenario.hpp"
#include "simulation/simulated_robot.hpp"

namespace smokemap {

/// A robot of a fleet before it starts.
struct FleetMember {
  SimulatedRobotParams params;
  Pose2 T_world_start;
  StartHint start;  ///< as the commander would say it
};

constexpr int kMostRobots = 8;

/// `robots` robots for the demo, robot1 ... : the first is the demo's own, the others wait one behind the other on the
/// first metres of its way to the far room. kInvalidArgument outside 1..kMostRobots; kDegenerate where they do not fit.
Result<std::vector<FleetMember>> demo_fleet(const DemoScenario& demo, int robots, const DemoParams& params = {});

/// Robots in one world, on one clock. Smoke spreads; every robot's lidar sees the bodies of the others. The same
/// members and commands at the same steps give the same bytes, and a further robot does not change another's noise.
class SimulatedFleet {
 public:
  /// @param smoke_spreads false: smoke stays as it is
  SimulatedFleet(SimulatedWorld world, const std::vector<FleetMember>& members, bool smoke_spreads = true);

  std::size_t size() const { return robots_.size(); }
  SimulatedRobot& robot(std::size_t i) { return robots_[i]; }
  const SimulatedRobot& robot(std::size_t i) const { return robots_[i]; }
  const SimulatedWorld& world() const { return world_; }

  /// Everything moves on by SimulatedRobot::kStep. One output a robot.
  std::vector<RobotOutput> step();

 private:
  void show_bodies(std::size_t seer, LaserScan& scan) const;

  SimulatedWorld world_;
  std::vector<SimulatedRobot> robots_;
  std::vector<Pose2> T_world_last_scan_;  ///< where the turn that is now running began
  bool smoke_spreads_;
  Stamp since_smoke_ = 0;
};

}  // namespace smokemap
