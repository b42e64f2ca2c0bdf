#include "server/wire/messages.hpp"

#include <cmath>

#include "server/wire/tiles.hpp"

namespace smokemap::server {
namespace {

constexpr double kLargestWhole = 9e15;  // exact in a double, as browsers count

std::uint64_t counter(const Json& object, const char* field) {
  const auto it = object.find(field);
  if (it == object.end() || !it->is_number()) return 0;
  const double value = it->get<double>();
  return value > 0 && value < kLargestWhole ? static_cast<std::uint64_t>(value) : 0;
}

std::optional<ViewMessage> view_of(const Json& json) {
  Fields f(json, "view");
  ViewMessage view{{f.number("x"), f.number("y")}, f.number("radius", 0)};
  if (!f.ok()) return std::nullopt;
  return view;
}

Result<ClientMessage> read_hello(const Json& json) {
  Fields f(json, "hello");
  HelloMessage hello;
  hello.token = f.text("token", 64);
  if (f.integer("version", 0, 1000) != 1) f.complain(".version must be 1");
  if (!f.ok()) return f.error();
  const std::uint64_t epoch = counter(json, "epoch");
  hello.epoch = epoch <= 0xffffffffu ? static_cast<std::uint32_t>(epoch) : 0;
  hello.seq = counter(json, "seq");
  if (f.has("view")) hello.view = view_of(json["view"]);
  if (f.has("parts") && json["parts"].is_object())
    for (const auto& [word, revision] : json["parts"].items())
      if (const auto part = part_of(word)) hello.parts[*part] = counter(json["parts"], word.c_str());
  return ClientMessage(std::move(hello));
}

Result<CommandMessage> read_command(const Json& json) {
  Fields f(json, "command");
  CommandMessage command;
  command.id = f.id("id");
  command.name = f.text("name", 64);
  if (!f.has("data") || !json["data"].is_object()) f.complain(".data must be an object");
  if (f.has("expires_ms") && !json["expires_ms"].is_number()) f.complain(".expires_ms must be a number");
  if (!f.ok()) return f.error();
  command.data = json["data"];
  if (f.has("expires_ms")) {
    const double ms = json["expires_ms"].get<double>();
    command.expires_ms = std::abs(ms) < kLargestWhole ? static_cast<std::int64_t>(ms) : 0;
  }
  return command;
}

Result<ClientMessage> read_presence(const Json& json) {
  Fields f(json, "presence");
  PresenceMessage presence{f.text("mode", 32), std::nullopt};
  if (f.has("p")) presence.p_map = f.point("p");
  if (!f.ok()) return f.error();
  return ClientMessage(std::move(presence));
}

Result<ClientMessage> read_ink(const Json& json) {
  Fields f(json, "ink");
  InkMessage ink{f.id("stroke_id"), f.points("points", 0, 2000)};
  if (!f.ok()) return f.error();
  return ClientMessage(std::move(ink));
}

Result<ClientMessage> read_ping(const Json& json) {
  if (!json.contains("t") || !json["t"].is_number()) return fail(Errc::kInvalidArgument, "ping.t must be a number");
  return ClientMessage(PingMessage{json["t"].get<double>()});
}

}  // namespace

Result<ClientMessage> parse_client_message(std::string_view text, const JsonLimits& limits) {
  const auto json = parse_json(text, limits);
  if (!json) return json.error();
  Fields f(*json, "message");
  const std::string type = f.text("type", 32);
  if (!f.ok()) return f.error();
  if (type == "hello") return read_hello(*json);
  if (type == "ack") return ClientMessage(AckMessage{counter(*json, "seq")});
  if (type == "ping") return read_ping(*json);
  if (type == "presence") return read_presence(*json);
  if (type == "ink") return read_ink(*json);
  if (type == "command") {
    auto command = read_command(*json);
    if (!command) return command.error();
    return ClientMessage(std::move(*command));
  }
  if (type == "view") {
    const auto view = view_of(*json);
    if (!view) return fail(Errc::kInvalidArgument, "view must have x, y and radius");
    return ClientMessage(*view);
  }
  return fail(Errc::kNotFound, "no message has the type '" + type + "'");
}

Result<CommandMessage> parse_command_message(std::string_view text, const JsonLimits& limits) {
  const auto json = parse_json(text, limits);
  if (!json) return json.error();
  return read_command(*json);
}

std::string welcome_message(const Welcome& welcome) {
  return to_text({{"type", "welcome"},
                  {"device", welcome.who.device},
                  {"role", to_string(welcome.who.role)},
                  {"name", welcome.who.name},
                  {"epoch", welcome.epoch},
                  {"seq", welcome.seq},
                  {"server_ms", welcome.server_ms},
                  {"tile_size", kTileCells},
                  {"resolution_m", welcome.resolution_m}});
}

std::string reply_message(const CommandReply& reply) {
  if (reply.done()) return to_text({{"type", "done"}, {"id", reply.id}, {"seq", reply.seq.value_or(0)}});
  Json json = {{"type", "refused"}, {"id", reply.id}, {"code", reply.code}, {"message", reply.message}};
  if (reply.seq) json["seq"] = *reply.seq;
  return to_text(json);
}

std::string pong_message(double t, std::int64_t server_ms) {
  return to_text({{"type", "pong"}, {"t", t}, {"server_ms", server_ms}});
}

std::string ink_message(const Identity& who, const InkMessage& ink) {
  return to_text({{"type", "ink"},
                  {"device", who.device},
                  {"name", who.name},
                  {"stroke_id", ink.stroke_id},
                  {"points", points_json(ink.points, 0.01)}});
}

std::string bye_message(std::string_view reason) { return to_text({{"type", "bye"}, {"reason", reason}}); }

}  // namespace smokemap::server
