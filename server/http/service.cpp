#include "server/http/service.hpp"

#include <algorithm>
#include <exception>

namespace smokemap::server {
namespace {

std::vector<std::string_view> segments(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const std::string_view part = path.substr(0, path.find('/'));
    parts.push_back(part);
    path.remove_prefix(part.size());
  }
  return parts;
}

bool matches(const Route& route, const Request& request, std::map<std::string, std::string, std::less<>>& parameters) {
  const auto pattern = segments(route.pattern), path = segments(request.path);
  if (pattern.size() != path.size()) return false;
  parameters.clear();
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const bool named = pattern[i].size() > 2 && pattern[i].front() == '{';
    if (named)
      parameters.emplace(pattern[i].substr(1, pattern[i].size() - 2), path[i]);
    else if (pattern[i] != path[i])
      return false;
  }
  return true;
}

Admission refused(Response response) {
  Admission admission;
  admission.refusal = std::move(response);
  return admission;
}

constexpr std::string_view kBearer = "Bearer ";

}  // namespace

HttpService::HttpService(OriginPolicy origins, Access& access, WorkerPool& workers, std::string web_root, Limits limits)
    : origins_(std::move(origins)), access_(access), workers_(workers), files_(std::move(web_root)), limits_(limits) {}

void HttpService::add(Route route) { routes_.push_back(std::move(route)); }

std::optional<Response> HttpService::refuse_foreign(const Request& request) const {
  if (!origins_.host_is_ours(request.host, request.local_address, request.local_port))
    return error_response(421, "forbidden",
                          "this server does not answer for the host '" + request.host.substr(0, 80) + "'");
  if (!OriginPolicy::origin_is_ours(request.origin, request.host))
    return error_response(403, "forbidden", "pages of another origin may not ask here");
  return std::nullopt;
}

std::optional<Response> HttpService::refuse_socket(const Request& request) const {
  if (auto refusal = refuse_foreign(request)) return refusal;
  if (request.path != "/api/live") return error_response(404, "not_found", "there is no socket here");
  return std::nullopt;
}

Admission HttpService::admit(Request& request) const {
  if (auto refusal = refuse_foreign(request)) return refused(std::move(*refusal));
  const Method method = request.method == Method::kHead ? Method::kGet : request.method;
  const Route* route = nullptr;
  std::string allowed;  // methods that this path knows
  std::map<std::string, std::string, std::less<>> parameters;
  for (const Route& candidate : routes_) {
    if (!matches(candidate, request, parameters)) continue;
    allowed += (allowed.empty() ? "" : ", ") + std::string(candidate.method == Method::kGet ? "GET, HEAD" : "POST");
    if (candidate.method != method) continue;
    route = &candidate;
    request.path_parameters = parameters;
    break;
  }
  Admission admission;
  if (!route) {
    if (!allowed.empty() || method != Method::kGet) {
      Response response = error_response(405, "invalid_argument", "not with this method");
      response.headers.emplace_back("Allow", allowed.empty() ? "GET, HEAD" : allowed);
      return refused(std::move(response));
    }
    if (request.path.starts_with("/api/")) return refused(error_response(404, "not_found", "there is no such request"));
    return admission;
  }
  if (route->least) {
    if (request.authorization.starts_with(kBearer))
      request.who = access_.identify(std::string_view(request.authorization).substr(kBearer.size()));
    if (!request.who) return refused(error_response(401, "unauthorized", "pair this device first"));
    if (request.who->role < *route->least)
      return refused(error_response(403, "forbidden",
                                    std::string("the role ") + to_string(request.who->role) + " may not do this"));
  }
  admission.route = route;
  admission.most_body_bytes = route->most_body_bytes;
  const std::uint64_t announced = request.content_length.value_or(route->most_body_bytes);
  if (std::min<std::uint64_t>(announced, route->most_body_bytes) > limits_.large_body_bytes) {
    auto counter = large_bodies_;
    admission.permit = std::shared_ptr<void>(nullptr, [counter](void*) { --*counter; });
    if (++*counter > limits_.most_large_bodies)
      return refused(error_response(503, "busy", "too many uploads at once; try again in a moment"));
  }
  return admission;
}

void HttpService::handle(const Admission& admission, Request request, const Respond& respond) const {
  if (!admission.route) return respond(files_.get(request));
  const auto run = [handler = &admission.route->handler, permit = admission.permit](const Request& r,
                                                                                    const Respond& answer) {
    try {
      (*handler)(r, answer);
    } catch (const std::exception&) {
      answer(error_response(500, "io", "the server could not do this"));
    }
  };
  if (!admission.route->on_worker) return run(request, respond);
  auto shared = std::make_shared<Request>(std::move(request));
  if (!workers_.post([run, shared, respond] { run(*shared, respond); }))
    respond(error_response(503, "busy", "the server is busy; try again in a moment"));
}

}  // namespace smokemap::server
