#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/result.hpp"

namespace smokemap::server {

class HttpService;
struct RawUpgrade;

/// Takes over connections that become WebSockets. Called on the network's threads.
class UpgradeHandler {
 public:
  virtual ~UpgradeHandler() = default;
  virtual void take(RawUpgrade upgrade) = 0;
};

struct NetOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0 = any free one
  int threads = 1;
  int most_connections = 256;  ///< plain and upgraded; more are closed at once
};

/// The listening socket and the threads of the network: accepts, serves HTTP, hands over WebSockets.
class NetServer {
 public:
  NetServer(const NetOptions& options, HttpService& service, UpgradeHandler& sockets);
  ~NetServer();  ///< stops
  NetServer(const NetServer&) = delete;
  NetServer& operator=(const NetServer&) = delete;

  /// The port that was bound. kIo when the address cannot be bound.
  Result<std::uint16_t> start();
  /// Closes everything and joins the threads. Handlers that still run on workers may answer later: nobody listens then.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Blocks until SIGINT or SIGTERM; returns its number.
/// @param ready called once signals are caught: whoever is told then may send one at once
int wait_for_stop_signal(const std::function<void()>& ready);

}  // namespace smokemap::server
