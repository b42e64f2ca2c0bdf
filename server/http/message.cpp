#include "server/http/message.hpp"

#include <algorithm>
#include <charconv>

namespace smokemap::server {
namespace {

int status_of(Errc code) {
  switch (code) {
    case Errc::kInvalidArgument:
    case Errc::kCorrupt:
      return 400;
    case Errc::kDegenerate:
    case Errc::kNotConverged:
      return 422;
    case Errc::kUnsupported:
      return 415;
    case Errc::kTooLarge:
      return 413;
    case Errc::kNotFound:
      return 404;
    case Errc::kConflict:
    case Errc::kCancelled:
      return 409;
    case Errc::kForbidden:
      return 403;
    case Errc::kIo:
      return 507;
  }
  return 500;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Response json_response(const Json& json, int status) {
  Response response;
  response.status = status;
  response.headers.emplace_back("Cache-Control", "no-store");
  response.body = std::make_shared<const std::string>(to_text(json));
  return response;
}

Response bytes_response(std::string bytes, std::string content_type) {
  Response response;
  response.content_type = std::move(content_type);
  response.body = std::make_shared<const std::string>(std::move(bytes));
  return response;
}

Response error_response(const Error& error) {
  return error_response(status_of(error.code), to_string(error.code), error.message);
}

Response error_response(int status, std::string_view code, std::string_view message) {
  return json_response({{"error", {{"code", code}, {"message", message}}}}, status);
}

const std::vector<std::pair<std::string, std::string>>& security_headers() {
  static const std::vector<std::pair<std::string, std::string>> headers{
      // blob: for pictures made in the page and for the map library's own workers.
      {"Content-Security-Policy",
       "default-src 'self'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
       "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Permissions-Policy", "geolocation=(), microphone=()"}};
  return headers;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (c == '\0') return std::nullopt;
    decoded += c;
  }
  return decoded;
}

std::optional<std::int64_t> query_number(const Request& request, std::string_view key) {
  const auto it = request.query.find(key);
  if (it == request.query.end()) return std::nullopt;
  const char *first = it->second.data(), *last = first + it->second.size();
  std::int64_t value = 0;
  const auto [end, failed] = std::from_chars(first, last, value);
  return failed == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

bool parse_target(std::string_view target, Request& request) {
  if (target.empty() || target.front() != '/') return false;
  target = target.substr(0, target.find('#'));
  const std::size_t mark = target.find('?');
  const auto path = percent_decoded(target.substr(0, mark));
  if (!path) return false;
  request.path = *path;
  if (mark == std::string_view::npos) return true;
  for (std::string_view rest = target.substr(mark + 1); !rest.empty();) {
    const std::string_view item = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    const std::size_t equals = item.find('=');
    const auto key = percent_decoded(item.substr(0, equals));
    const auto value = percent_decoded(equals == std::string_view::npos ? "" : item.substr(equals + 1));
    if (!key || !value) return false;
    request.query[*key] = *value;
  }
  return true;
}

}  // namespace smokemap::server
