#include "server/access/origin.hpp"

#include <algorithm>

namespace smokemap::server {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

}  // namespace

OriginPolicy::OriginPolicy(std::vector<std::string> names) : names_(std::move(names)) {
  for (std::string& name : names_) name = lower(name);
}

bool OriginPolicy::host_is_ours(std::string_view host, std::string_view local_address, std::uint16_t port) const {
  const std::string asked = lower(host), suffix = ":" + std::to_string(port);
  std::string address(local_address);
  const bool loopback = address == "::1" || address.starts_with("127.") || address.starts_with("::ffff:127.");
  if (address.starts_with("::ffff:")) address = address.substr(7);
  std::vector<std::string> ours{address.find(':') == std::string::npos ? address : "[" + address + "]"};
  if (loopback) ours.insert(ours.end(), {"localhost", "127.0.0.1", "[::1]"});
  const auto is_asked = [&](const std::string& name) {
    return asked == name + suffix || (asked == name && port == 80);
  };
  // A configured name may carry the port of a proxy in front of us.
  return std::any_of(ours.begin(), ours.end(), is_asked) ||
         std::any_of(names_.begin(), names_.end(),
                     [&](const std::string& name) { return !name.empty() && (asked == name || is_asked(name)); });
}

bool OriginPolicy::origin_is_ours(std::string_view origin, std::string_view host) {
  return origin.empty() || lower(origin) == "http://" + lower(host) || lower(origin) == "https://" + lower(host);
}

}  // namespace smokemap::server
