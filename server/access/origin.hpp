#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace smokemap::server {

/// Which names the server answers for. Refusing others stops DNS rebinding; refusing foreign origins stops pages of
/// other sites from using a browser that is paired here.
class OriginPolicy {
 public:
  /// @param names  host names (or host:port) beside the loopback names and the address a connection came in on
  explicit OriginPolicy(std::vector<std::string> names = {});

  /// `Host` as sent; `local_address`, `port`: where the connection came in (IPv6 without brackets).
  bool host_is_ours(std::string_view host, std::string_view local_address, std::uint16_t port) const;
  /// `Origin` as sent, or empty when absent: exactly the page's own.
  static bool origin_is_ours(std::string_view origin, std::string_view host);

 private:
  std::vector<std::string> names_;
};

}  // namespace smokemap::server
