#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "recording/live_recorder.hpp"
#include "robots/gateway.hpp"
#include "session/engine.hpp"

namespace smokemap::app {

/// Ties robots on the ROS network to the engine: their data in; velocities out, or places for those that navigate by
/// themselves. What comes in is recorded on the way.
class RobotLinkage final : public RobotCommands {
 public:
  void drive(const std::string& robot, double speed_mps, double turn_rate_radps) override;
  /// Stands, and a navigator of the robot's own gives up its goals.
  void stop(const std::string& robot) override;
  /// It offers NavigateToPose, or takes goals and no velocities.
  bool navigates(const std::string& robot) const override;
  void lead(const std::string& robot, const Pose2& T_robot_place) override;
  Errand errand(const std::string& robot) const override;
  /// Opens the network; from then on data flow. The engine, and `recorder` where there is one, must outlive this
  /// object's `close`.
  Result<Ok> open(const GatewayParams& params, Engine& engine, std::shared_ptr<const Clock> clock,
                  LiveRecorder* recorder = nullptr);
  /// Sends zeros to every robot and leaves the network.
  void close();

 private:
  /// The goal that a robot was given last. One without reports (goal_pose) stays under way for ever: whether the robot
  /// gets there is then seen by where it is.
  struct Given {
    std::uint64_t number = 0;
    Errand errand = Errand::kUnderWay;
  };
  std::shared_ptr<RobotGateway> gateway() const;
  void heard(const NavigationReport& report);

  mutable std::mutex mutex_;
  std::shared_ptr<RobotGateway> gateway_;
  std::map<std::string, Given> given_;  ///< by robot
};

}  // namespace smokemap::app
