#pragma once

#include <memory>

#include "server/http/net_server.hpp"
#include "server/ws/live_session.hpp"

namespace smokemap::server {

/// Turns upgraded connections into live sessions. What it refers to outlives the network's threads.
class WsServer final : public UpgradeHandler {
 public:
  WsServer(const LiveSession::Params& params, Access& access, Hub& hub, CommandSink& commands,
           std::shared_ptr<const Clock> clock);

  void take(RawUpgrade upgrade) override;

 private:
  LiveSession::Params params_;
  Access& access_;
  Hub& hub_;
  CommandSink& commands_;
  std::shared_ptr<const Clock> clock_;
};

}  // namespace smokemap::server
