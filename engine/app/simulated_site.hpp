#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "core/result.hpp"
#include "robots/ros_robot.hpp"
#include "simulation/demo_scenario.hpp"

namespace smokemap::app {

/// The demo's building with its robot, running in real time on a thread of its own. The robot is a ROS 2 robot like any
/// other: what it measures goes out over DDS, commands come in over DDS, and nothing of the truth crosses.
class SimulatedSite {
 public:
  static Result<std::unique_ptr<SimulatedSite>> start(const DemoScenario& demo, int ros_domain);
  ~SimulatedSite();
  SimulatedSite(const SimulatedSite&) = delete;
  SimulatedSite& operator=(const SimulatedSite&) = delete;

  const std::string& robot_name() const { return params_.name; }

 private:
  SimulatedSite(const DemoScenario& demo, const SimulatedRobotParams& params);
  void run(const std::stop_token& stop);

  SimulatedRobotParams params_;
  SimulatedWorld world_;
  SimulatedRobot robot_;
  std::mutex robot_mutex_;
  std::unique_ptr<RosRobotNode> node_;
  std::jthread thread_;  // last: ends before what it uses
};

}  // namespace smokemap::app
