#pragma once

#include <gtest/gtest.h>

#include <fstream>

#include "server/app/server.hpp"
#include "tests/support/fake_engine.hpp"
#include "tests/support/fake_pictures.hpp"
#include "tests/support/raw_client.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::test {

/// A server on a free port of this machine, with doubles behind it.
class RunningServer {
 public:
  explicit RunningServer(server::PairingParams pairing = {}) : pairing_(std::move(pairing)) {
    std::filesystem::create_directories(web() + "/assets");
    std::ofstream(web() + "/index.html") << "<!doctype html><title>Smokemap</title>" << std::string(500, ' ');
    std::ofstream(web() + "/assets/app-1234.js") << "console.log('" << std::string(500, 'x') << "')";
    std::ofstream(folder_.path() + "/secret.txt") << "secret";
    if (pairing_.pin.empty()) pairing_.pin = "123456";
    start();
  }

  void start(const std::string& data = {}) {
    engine_ = std::make_unique<FakeEngine>();
    server::ServerOptions options;
    options.data_dir = data.empty() ? data_dir() : data;
    options.web_root = web();
    options.pairing = pairing_;
    options.live.tile_period_ms = options.live.robot_period_ms = options.live.vector_period_ms = 5;
    options.make_replay_engine = [] {
      auto engine = std::make_unique<FakeEngine>();
      engine->tick_on_look();
      return engine;
    };
    server_ = std::make_unique<server::Server>(options, *engine_, pictures_);
    const auto started = server_->start();
    ASSERT_THAT(started, IsOk());
  }
  void stop() { server_.reset(); }

  std::string web() const { return folder_.path() + "/web"; }
  std::string data_dir() const { return folder_.path() + "/data"; }
  const TemporaryFolder& folder() const { return folder_; }
  std::uint16_t port() const { return server_->port(); }
  FakeEngine& engine() { return *engine_; }
  server::Server& server() { return *server_; }

  std::string pair(const std::string& role, const std::string& name = "Anna") {
    RawClient client(port());
    const auto answer =
        client.ask("POST", "/api/pair", R"({"pin":"123456","name":")" + name + R"(","role":")" + role + "\"}");
    EXPECT_EQ(answer.status, 200) << answer.body;
    return server::Json::parse(answer.body, nullptr, false).value("token", "");
  }
  static std::string bearer(const std::string& token) { return "Authorization: Bearer " + token + "\r\n"; }

 private:
  TemporaryFolder folder_;
  server::PairingParams pairing_;
  FakePictures pictures_;
  std::unique_ptr<FakeEngine> engine_;
  std::unique_ptr<server::Server> server_;
};

/// A browser that said hello.
class Browser {
 public:
  Browser(RunningServer& running, const std::string& token, const std::string& more = R"(,"epoch":0,"seq":0)",
          int receive_buffer_bytes = 0)
      : client(running.port(), receive_buffer_bytes) {
    EXPECT_EQ(client.upgrade(), 101);
    client.send_frame(R"({"type":"hello","version":1,"token":")" + token + "\"" + more + "}");
  }
  void command(const std::string& id, const std::string& name, const std::string& data, const std::string& more = {}) {
    client.send_frame(R"({"type":"command","id":")" + id + R"(","name":")" + name + R"(","data":)" + data + more + "}");
  }
  /// The next text message for which `wanted` holds; map frames are acknowledged on the way. Null when none comes.
  template <typename Wanted>
  server::Json wait_for(const Wanted& wanted) {
    while (const auto frame = client.next()) {
      if (frame->opcode == 2) client.send_frame(R"({"type":"ack","seq":1})");
      if (frame->opcode == 8) return nullptr;
      if (frame->opcode != 1) continue;
      server::Json message = server::Json::parse(frame->payload, nullptr, false);
      if (wanted(message)) return message;
    }
    return nullptr;
  }
  server::Json wait_for_answer(const std::string& id) {
    return wait_for(
        [&id](const server::Json& m) { return (m["type"] == "done" || m["type"] == "refused") && m["id"] == id; });
  }
  server::Json wait_for_object(const std::string& part, const std::string& id) {
    const auto message = wait_for(
        [&](const server::Json& m) { return m["type"] == "delta" && m["part"] == part && m["set"].contains(id); });
    return message.is_null() ? message : message["set"][id];
  }
  RawClient client;
};

}  // namespace smokemap::test
