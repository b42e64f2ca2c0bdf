#include "server/http/api.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/bytes.hpp"
#include "server/http/api_pictures.hpp"
#include "server/http/exports.hpp"

namespace smokemap::server {
namespace {

constexpr std::size_t kSmallBody = 16_KiB;
constexpr std::size_t kCommandBody = 4_MiB;
constexpr int kMostEvents = 1000;

Json identity_json(const Identity& who) {
  return {{"device", who.device}, {"role", to_string(who.role)}, {"name", who.name}};
}

Response pair(Access& access, const Request& request) {
  const auto json = parse_json(request.body);
  if (!json) return error_response(json.error());
  Fields f(*json, "pair");
  PairRequest asked;
  if (f.has("pin")) asked.pin = f.text("pin", 16);
  asked.name = f.text("name", 40);
  const auto role = role_of(f.text("role", 32));
  if (!role) f.complain(".role must be observer, firefighter or commander");
  if (!f.ok()) return error_response(f.error());
  asked.role = *role;
  asked.from_loopback = request.from_loopback;
  const auto paired = access.pair(asked);
  if (!paired && paired.error().code == Errc::kConflict) return error_response(429, "locked", paired.error().message);
  if (!paired) return error_response(paired.error());
  Json answer = identity_json(paired->who);
  answer["token"] = paired->token;
  return json_response(answer);
}

Json event_json(const Event& event) {
  const auto data = parse_json(event.data, {64_MiB, 64});
  return {{"seq", event.seq},
          {"time_ms", event.time_ms},
          {"device", event.who.device},
          {"person", event.who.name},
          {"role", to_string(event.who.role)},
          {"id", event.command_id},
          {"name", event.name},
          {"data", data ? *data : Json::object()},
          {"outcome", event.outcome}};
}

Response events(Store& store, const Request& request) {
  const std::int64_t from = std::max<std::int64_t>(1, query_number(request, "from").value_or(1));
  const auto limit = std::clamp<std::int64_t>(query_number(request, "limit").value_or(200), 1, kMostEvents);
  const auto found = store.events(from, static_cast<int>(limit));
  if (!found) return error_response(found.error());
  Json list = Json::array();
  for (const Event& event : *found) list.push_back(event_json(event));
  return json_response({{"events", std::move(list)}, {"next", found->empty() ? from : found->back().seq + 1}});
}

Response events_as_lines(Store& store) {
  std::string lines;
  for (std::int64_t from = 1;;) {
    const auto found = store.events(from, kMostEvents);
    if (!found) return error_response(found.error());
    if (found->empty()) break;
    for (const Event& event : *found) lines += to_text(event_json(event)) + "\n";
    from = found->back().seq + 1;
  }
  return bytes_response(std::move(lines), "application/x-ndjson");
}

Response snapshot_at(const ApiParts& parts, const Request& request) {
  const std::int64_t at = query_number(request, "at").value_or(-1);
  if (at < 0) return error_response(400, "invalid_argument", "at must be the number of an event");
  if (!parts.snapshot_at) return error_response(404, "not_found", "this server keeps no past");
  const auto past = parts.snapshot_at(at);
  if (!past) return error_response(past.error());
  Json tables = Json::object();
  for (std::size_t i = 0; i < kPartCount; ++i) {
    const auto part = static_cast<Part>(i);
    Json& table = tables[to_string(part)] = Json::object();
    for (const auto& [id, text] : part_table(part, *past->snapshot, past->view))
      table[id] = Json::parse(text, nullptr, false);
  }
  return json_response({{"at", at}, {"parts", std::move(tables)}});
}

std::optional<double> query_metres(const Request& request, std::string_view key) {
  const auto it = request.query.find(key);
  if (it == request.query.end()) return std::nullopt;
  double value = 0;
  const char* end = it->second.data() + it->second.size();
  const auto [read_to, failed] = std::from_chars(it->second.data(), end, value);
  const bool is_place = failed == std::errc() && read_to == end && std::abs(value) <= 1e5;
  return is_place ? std::optional(value) : std::nullopt;
}

/// A way that is not there is an answer too: `reason` says why.
Response way(const EnginePort& engine, const Request& request) {
  const auto robot = request.query.find("robot");
  const auto x = query_metres(request, "x"), y = query_metres(request, "y");
  if (robot == request.query.end() || !x || !y)
    return error_response(400, "invalid_argument", "robot, x and y (metres of the map) are needed");
  const auto path = engine.way(robot->second, Point2(*x, *y));
  if (!path && path.error().code == Errc::kNotFound) return error_response(path.error());
  if (!path) return json_response({{"path", Json::array()}, {"reason", path.error().message}});
  Json points = Json::array();
  for (const Point2& p : path->points) points.push_back({p.x(), p.y()});
  return json_response(
      {{"path", std::move(points)}, {"length_m", path->length_m}, {"unseen_m", path->planned_m}, {"reason", ""}});
}

void submit_command(CommandSink& sink, const Request& request, const Respond& respond) {
  auto message = parse_command_message(request.body, {kCommandBody, 16});
  if (!message) return respond(error_response(message.error()));
  sink.submit(*request.who, std::move(*message), [respond](const CommandReply& reply) {
    if (reply.done()) return respond(json_response(Json::parse(reply_message(reply), nullptr, false)));
    const bool forbidden = reply.code == to_string(Errc::kForbidden), full = reply.code == to_string(Errc::kIo);
    respond(error_response(forbidden ? 403 : full ? 507 : 422, reply.code, reply.message));
  });
}

Response exported(const ApiParts& parts, const Request& request) {
  const std::string& file = request.path_parameters.find("file")->second;
  Response response =
      file == "events.jsonl" ? events_as_lines(parts.store) : export_file(file, *parts.engine.snapshot());
  if (response.status == 200)
    response.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + file + "\"");
  return response;
}

/// A handler that answers at once.
template <typename Function>
Handler at_once(Function function) {
  return [function](const Request& request, const Respond& respond) { respond(function(request)); };
}

}  // namespace

void add_api(HttpService& service, const ApiParts& p) {
  const auto health = [p](const Request&) {
    return json_response({{"ok", true}, {"version", "0.1.0"}, {"epoch", p.epoch}});
  };
  service.add({Method::kGet, "/api/health", std::nullopt, 0, false, at_once(health)});
  service.add({Method::kPost, "/api/pair", std::nullopt, kSmallBody, true,
               at_once([p](const Request& r) { return pair(p.access, r); })});
  service.add({Method::kGet, "/api/me", Role::kObserver, 0, false,
               at_once([](const Request& r) { return json_response(identity_json(*r.who)); })});
  service.add({Method::kPost, "/api/commands", Role::kObserver, kCommandBody, false,
               [p](const Request& r, const Respond& respond) { submit_command(p.commands, r, respond); }});
  service.add({Method::kGet, "/api/events", Role::kObserver, 0, true,
               at_once([p](const Request& r) { return events(p.store, r); })});
  service.add({Method::kGet, "/api/snapshot", Role::kObserver, 0, true,
               at_once([p](const Request& r) { return snapshot_at(p, r); })});
  service.add({Method::kGet, "/api/way", Role::kObserver, 0, true,
               at_once([p](const Request& r) { return way(p.engine, r); })});
  service.add({Method::kGet, "/api/export/{file}", Role::kObserver, 0, true,
               at_once([p](const Request& r) { return exported(p, r); })});
  add_picture_api(service, p);
}

}  // namespace smokemap::server
