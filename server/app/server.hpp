#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/access/pairing.hpp"
#include "server/http/net_server.hpp"
#include "server/http/picture_service.hpp"
#include "server/wire/engine_port.hpp"
#include "server/wire/json.hpp"
#include "server/ws/live_session.hpp"

namespace smokemap::server {

struct ServerOptions {
  std::string data_dir = "data";
  std::string web_root;  ///< folder with index.html; empty = only /api
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;               ///< 0 = any free one
  std::vector<std::string> host_names;  ///< names it answers for beside its address; loopback names on loopback
  PairingParams pairing;
  LiveParams live;
  LiveSession::Params session;
  int network_threads = 1;
  int worker_threads = 2;
  /// A fresh engine without robots, to look back with; empty = /api/snapshot is not offered.
  std::function<std::unique_ptr<EnginePort>()> make_replay_engine;
  Result<Ok> validate() const;
};

/// The whole server: store, access, HTTP, sockets, over one engine. Engine, pictures and clock outlive it.
class Server {
 public:
  Server(ServerOptions options, EnginePort& engine, PictureService& pictures,
         std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>());
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Opens the store, replays the log into the engine, listens. Errors are for people: damaged log, folder, port.
  Result<Ok> start();
  void stop();

  /// A POST below /api as the machine itself, with a commander's rights: how the demo sets itself up, by the same way
  /// as everybody else. After `start`; waits for the answer.
  Result<Json> post(const std::string& path, std::string body);

  std::uint16_t port() const;
  std::string url() const;         ///< "http://127.0.0.1:8080/"
  const std::string& pin() const;  ///< for the console

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Says on the console where the server is and how to pair, waits for SIGINT or SIGTERM and stops it.
int run_until_signal(Server& server);

}  // namespace smokemap::server
