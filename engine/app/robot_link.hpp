#pragma once

#include <memory>
#include <mutex>

#include "robots/gateway.hpp"
#include "session/engine.hpp"

namespace smokemap::app {

/// Ties robots on the ROS network to the engine: their data in, velocity commands out.
class RobotLinkage final : public RobotCommands {
 public:
  void drive(const std::string& robot, double speed_mps, double turn_rate_radps) override;
  /// Opens the network; from then on data flow. The engine must outlive this object's `close`.
  Result<Ok> open(const GatewayParams& params, Engine& engine, std::shared_ptr<const Clock> clock);
  /// Sends zeros to every robot and leaves the network.
  void close();

 private:
  std::mutex mutex_;
  std::shared_ptr<RobotGateway> gateway_;
};

}  // namespace smokemap::app
