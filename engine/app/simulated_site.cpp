#include "app/simulated_site.hpp"

#include <spdlog/spdlog.h>

#include <chrono>

namespace smokemap::app {

Result<std::unique_ptr<SimulatedSite>> SimulatedSite::start(const DemoScenario& demo, std::vector<FleetMember> members,
                                                            int ros_domain) {
  for (FleetMember& member : members) member.params.start = SystemClock().now();
  auto site = std::unique_ptr<SimulatedSite>(new SimulatedSite(demo, members));
  SimulatedSite* self = site.get();
  for (std::size_t i = 0; i < members.size(); ++i) {
    RosRobotParams ros;
    ros.robot = members[i].params.name;
    ros.domain = ros_domain;
    RosRobotNode::Callbacks callbacks;
    callbacks.on_velocity = [self, i](double speed, double turn_rate) {
      const std::lock_guard lock(self->mutex_);
      self->fleet_.robot(i).command(speed, turn_rate);
    };
    auto node = RosRobotNode::open(ros, std::move(callbacks));
    if (!node) return node.error();
    site->nodes_.push_back(std::move(*node));
  }
  site->thread_ = std::jthread([self](const std::stop_token& stop) { self->run(stop); });
  return site;
}

SimulatedSite::~SimulatedSite() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  nodes_.clear();  // their callbacks use the robots
}

void SimulatedSite::run(const std::stop_token& stop) {
  auto next = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    std::vector<RobotOutput> outputs;
    {
      const std::lock_guard lock(mutex_);
      outputs = fleet_.step();
    }
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      for (const Odometry& odometry : outputs[i].odometry) nodes_[i]->publish(odometry);
      for (const LaserScan& scan : outputs[i].scans) nodes_[i]->publish(scan);
      for (const RadarSweep& sweep : outputs[i].sweeps) nodes_[i]->publish(sweep);
    }
    next += std::chrono::nanoseconds(SimulatedRobot::kStep);
    const auto now = std::chrono::steady_clock::now();
    if (next < now - std::chrono::seconds(1)) next = now;  // a machine that was asleep does not rush
    std::this_thread::sleep_until(next);
  }
}

}  // namespace smokemap::app
