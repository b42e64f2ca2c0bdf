#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/wire/json.hpp"
#include "server/wire/parts.hpp"
#include "server/wire/role.hpp"

namespace smokemap::server {

// Text frames of /api/live; docs/wire.md, section 2.

struct ViewMessage {
  Point2 p_map = Point2::Zero();
  double radius_m = 0;
};
struct HelloMessage {
  std::string token;
  std::uint32_t epoch = 0;
  std::uint64_t seq = 0;
  std::optional<ViewMessage> view;
  std::map<Part, std::uint64_t> parts;  ///< revisions the browser still holds
};
struct AckMessage {
  std::uint64_t seq = 0;
};
struct CommandMessage {  // NOLINT(bugprone-exception-escape): no move of it throws
  std::string id;
  std::string name;
  Json data;
  std::optional<std::int64_t> expires_ms;
};
struct PingMessage {
  double t = 0;
};
struct PresenceMessage {
  std::string mode;
  std::optional<Point2> p_map;
};
struct InkMessage {
  std::string stroke_id;
  std::vector<Point2> points;
};
using ClientMessage =
    std::variant<HelloMessage, AckMessage, CommandMessage, PingMessage, PresenceMessage, InkMessage, ViewMessage>;

/// Never throws. kNotFound for an unknown type, so that the caller can answer instead of closing.
Result<ClientMessage> parse_client_message(std::string_view text, const JsonLimits& limits = {});
/// Only the `command` message; for bodies over HTTP.
Result<CommandMessage> parse_command_message(std::string_view text, const JsonLimits& limits);

struct Welcome {
  Identity who;
  std::uint32_t epoch = 0;
  std::uint64_t seq = 0;
  std::int64_t server_ms = 0;
  double resolution_m = 0.05;
};

/// What became of a command.
struct CommandReply {
  std::string id;
  std::optional<std::int64_t> seq;  ///< in the log, if it is there; 0 for a stop that could not be stored
  std::string code;                 ///< empty = done
  std::string message;
  bool done() const { return code.empty(); }
};

std::string welcome_message(const Welcome& welcome);
std::string reply_message(const CommandReply& reply);
std::string pong_message(double t, std::int64_t server_ms);
std::string ink_message(const Identity& who, const InkMessage& ink);
std::string bye_message(std::string_view reason);

}  // namespace smokemap::server
