#include "app/robot_link.hpp"

#include <spdlog/spdlog.h>

namespace smokemap::app {

void RobotLinkage::drive(const std::string& robot, double speed_mps, double turn_rate_radps) {
  std::shared_ptr<RobotGateway> gateway;
  {
    const std::lock_guard lock(mutex_);
    gateway = gateway_;
  }
  if (gateway) (void)gateway->drive(robot, speed_mps, turn_rate_radps);  // no subscriber yet: the robot stands anyway
}

Result<Ok> RobotLinkage::open(const GatewayParams& params, Engine& engine, std::shared_ptr<const Clock> clock) {
  RobotGateway::Callbacks callbacks;
  callbacks.on_scan = [&engine](const LaserScan& scan) { engine.add_scan(scan); };
  callbacks.on_odometry = [&engine](const Odometry& odometry) { engine.add_odometry(odometry); };
  callbacks.on_sweep = [&engine](const RadarSweep& sweep) { engine.add_sweep(sweep); };
  callbacks.on_alarm = [](const GatewayAlarm& alarm) { spdlog::warn("robot {}: {}", alarm.robot, alarm.text); };
  auto gateway = RobotGateway::open(params, std::move(callbacks), std::move(clock));
  if (!gateway) return gateway.error();
  const std::lock_guard lock(mutex_);
  gateway_ = std::move(*gateway);
  return Ok{};
}

void RobotLinkage::close() {
  std::shared_ptr<RobotGateway> gateway;
  {
    const std::lock_guard lock(mutex_);
    gateway = std::move(gateway_);
  }
  if (!gateway) return;
  for (const RobotLink& robot : gateway->robots()) (void)gateway->drive(robot.id, 0, 0);
}

}  // namespace smokemap::app
