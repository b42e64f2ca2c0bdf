#pragma once

#include <memory>
#include <mutex>

#include "recording/live_recorder.hpp"
#include "robots/gateway.hpp"
#include "session/engine.hpp"

namespace smokemap::app {

/// Ties robots on the ROS network to the engine: their data in, velocity commands out. What comes in is recorded on
/// the way.
class RobotLinkage final : public RobotCommands {
 public:
  void drive(const std::string& robot, double speed_mps, double turn_rate_radps) override;
  /// Stands, and a navigator of the robot's own gives up its goals.
  void stop(const std::string& robot) override;
  /// Opens the network; from then on data flow. The engine, and `recorder` where there is one, must outlive this
  /// object's `close`.
  Result<Ok> open(const GatewayParams& params, Engine& engine, std::shared_ptr<const Clock> clock,
                  LiveRecorder* recorder = nullptr);
  /// Sends zeros to every robot and leaves the network.
  void close();

 private:
  std::shared_ptr<RobotGateway> gateway() const;
  mutable std::mutex mutex_;
  std::shared_ptr<RobotGateway> gateway_;
};

}  // namespace smokemap::app
