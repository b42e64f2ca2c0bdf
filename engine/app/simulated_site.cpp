#include "app/simulated_site.hpp"

#include <spdlog/spdlog.h>

#include <chrono>

namespace smokemap::app {

SimulatedSite::SimulatedSite(const DemoScenario& demo, const SimulatedRobotParams& params)
    : params_(params), world_(demo.world), robot_(params, demo.T_world_start) {}

Result<std::unique_ptr<SimulatedSite>> SimulatedSite::start(const DemoScenario& demo, int ros_domain) {
  SimulatedRobotParams params = demo_robot_params(demo);
  params.start = SystemClock().now();
  auto site = std::unique_ptr<SimulatedSite>(new SimulatedSite(demo, params));
  RosRobotParams ros;
  ros.robot = params.name;
  ros.domain = ros_domain;
  SimulatedSite* self = site.get();
  RosRobotNode::Callbacks callbacks;
  callbacks.on_velocity = [self](double speed, double turn_rate) {
    const std::lock_guard lock(self->robot_mutex_);
    self->robot_.command(speed, turn_rate);
  };
  auto node = RosRobotNode::open(ros, std::move(callbacks));
  if (!node) return node.error();
  site->node_ = std::move(*node);
  site->thread_ = std::jthread([self](const std::stop_token& stop) { self->run(stop); });
  return site;
}

SimulatedSite::~SimulatedSite() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  node_.reset();  // its callbacks use the robot
}

void SimulatedSite::run(const std::stop_token& stop) {
  auto next = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    RobotOutput out;
    {
      const std::lock_guard lock(robot_mutex_);
      out = robot_.step(world_);
    }
    for (const Odometry& odometry : out.odometry) node_->publish(odometry);
    for (const LaserScan& scan : out.scans) node_->publish(scan);
    for (const RadarSweep& sweep : out.sweeps) node_->publish(sweep);
    next += std::chrono::nanoseconds(SimulatedRobot::kStep);
    const auto now = std::chrono::steady_clock::now();
    if (next < now - std::chrono::seconds(1)) next = now;  // a machine that was asleep does not rush
    std::this_thread::sleep_until(next);
  }
}

}  // namespace smokemap::app
