#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/wire/json.hpp"
#include "server/wire/live_state.hpp"
#include "server/wire/role.hpp"

namespace smokemap::server {

// HTTP without a network library, so that everything but the session itself is tested by calling it.

enum class Method { kGet, kHead, kPost, kOther };

struct Request {
  Method method = Method::kGet;
  std::string path;  ///< decoded, without query
  std::map<std::string, std::string, std::less<>> query;
  std::map<std::string, std::string, std::less<>> path_parameters;  ///< {id} of the route
  std::string host, origin, authorization, accept_encoding, if_none_match;
  std::string local_address;
  std::uint16_t local_port = 0;
  bool from_loopback = false;
  std::optional<std::uint64_t> content_length;  ///< as announced; none: unknown until all of it is there
  std::string body;
  std::optional<Identity> who;  ///< after admission
};

struct Response {
  int status = 200;
  std::string content_type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers;
  SharedBytes body;  ///< may be null
};

using Respond = std::function<void(Response)>;

Response json_response(const Json& json, int status = 200);
Response bytes_response(std::string bytes, std::string content_type);
/// {"error": {"code", "message"}} with the status that fits the code.
Response error_response(const Error& error);
Response error_response(int status, std::string_view code, std::string_view message);
/// The headers that every answer carries.
const std::vector<std::pair<std::string, std::string>>& security_headers();

/// Percent-decoding; nothing for malformed escapes or NUL bytes.
std::optional<std::string> percent_decoded(std::string_view text);
/// A parameter of the query that is a whole number and nothing else.
std::optional<std::int64_t> query_number(const Request& request, std::string_view key);
/// Splits "/path?a=b" into decoded path and query; false for a malformed target.
bool parse_target(std::string_view target, Request& request);

}  // namespace smokemap::server
