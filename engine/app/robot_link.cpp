#include "app/robot_link.hpp"

#include <spdlog/spdlog.h>

namespace smokemap::app {

std::shared_ptr<RobotGateway> RobotLinkage::gateway() const {
  const std::lock_guard lock(mutex_);
  return gateway_;
}

void RobotLinkage::drive(const std::string& robot, double speed_mps, double turn_rate_radps) {
  if (const auto here = gateway())
    (void)here->drive(robot, speed_mps, turn_rate_radps);  // no subscriber yet: the robot stands anyway
}

void RobotLinkage::stop(const std::string& robot) {
  if (const auto here = gateway()) (void)here->stop(robot);
}

bool RobotLinkage::navigates(const std::string& robot) const {
  const auto here = gateway();
  if (!here) return false;
  for (const RobotLink& link : here->robots())
    if (link.id == robot) return link.navigates || (link.takes_goals && !link.takes_velocity);
  return false;
}

void RobotLinkage::lead(const std::string& robot, const Pose2& T_robot_place) {
  const auto here = gateway();
  if (!here) return;
  const auto sent = here->send_goal_ahead(robot, T_robot_place);
  if (!sent) spdlog::warn("robot {}: {}", robot, sent.error().message);
  const std::lock_guard lock(mutex_);
  Given& given = given_[robot];
  // A report may have overtaken us: it is never older than what it is about.
  if (!sent)
    given.errand = Errand::kGivenUp;  // its number stays: late reports of older goals are still older
  else if (given.number < sent->number)
    given = {sent->number, Errand::kUnderWay};
}

Errand RobotLinkage::errand(const std::string& robot) const {
  const std::lock_guard lock(mutex_);
  const auto given = given_.find(robot);
  return given == given_.end() ? Errand::kNone : given->second.errand;
}

void RobotLinkage::heard(const NavigationReport& report) {
  const std::lock_guard lock(mutex_);
  Given& given = given_[report.robot];
  if (report.goal < given.number) return;  // of a goal that another one has replaced
  given.number = report.goal;
  given.errand = !is_final(report.state)                     ? Errand::kUnderWay
                 : report.state == NavigationState::kArrived ? Errand::kDone
                                                             : Errand::kGivenUp;
}

Result<Ok> RobotLinkage::open(const GatewayParams& params, Engine& engine, std::shared_ptr<const Clock> clock,
                              LiveRecorder* recorder) {
  const auto record = [recorder, clock](const LogItem& item) {
    if (recorder) recorder->add(item, clock->now());
  };
  RobotGateway::Callbacks callbacks;
  callbacks.on_scan = [&engine, record](const LaserScan& scan) { engine.add_scan(scan), record(scan); };
  callbacks.on_odometry = [&engine, record](const Odometry& odometry) {
    engine.add_odometry(odometry), record(odometry);
  };
  callbacks.on_sweep = [&engine, record](const RadarSweep& sweep) { engine.add_sweep(sweep), record(sweep); };
  callbacks.on_alarm = [](const GatewayAlarm& alarm) { spdlog::warn("robot {}: {}", alarm.robot, alarm.text); };
  callbacks.on_navigation = [this](const NavigationReport& report) {
    heard(report);
    spdlog::info("robot {}: goal {} {}", report.robot, report.goal, to_string(report.state));
  };
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
