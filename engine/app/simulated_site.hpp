#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/result.hpp"
#include "robots/ros_robot.hpp"
#include "simulation/simulated_fleet.hpp"

namespace smokemap::app {

/// The demo's building with its robots, running in real time on a thread of its own while the smoke spreads. Each is a
/// ROS 2 robot like any other: what it measures goes out over DDS, commands come in over DDS, and nothing of the truth
/// crosses.
class SimulatedSite {
 public:
  static Result<std::unique_ptr<SimulatedSite>> start(const DemoScenario& demo, std::vector<FleetMember> members,
                                                      int ros_domain);
  ~SimulatedSite();
  SimulatedSite(const SimulatedSite&) = delete;
  SimulatedSite& operator=(const SimulatedSite&) = delete;

 private:
  SimulatedSite(const DemoScenario& demo, const std::vector<FleetMember>& members) : fleet_(demo.world, members) {}
  void run(const std::stop_token& stop);

  std::mutex mutex_;  ///< of the fleet
  SimulatedFleet fleet_;
  std::vector<std::unique_ptr<RosRobotNode>> nodes_;
  std::jthread thread_;  // last: ends before what it uses
};

}  // namespace smokemap::app
