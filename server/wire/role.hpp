#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace smokemap::server {

enum class Role { kObserver, kFirefighter, kCommander };

const char* to_string(Role role);
std::optional<Role> role_of(std::string_view word);

/// Who acts: a paired device and the person who holds it.
struct Identity {
  std::string device;
  std::string name;  ///< of the person
  Role role = Role::kObserver;
};

}  // namespace smokemap::server
