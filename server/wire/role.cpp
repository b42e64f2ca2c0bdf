#include "server/wire/role.hpp"

namespace smokemap::server {

const char* to_string(Role role) {
  switch (role) {
    case Role::kObserver:
      return "observer";
    case Role::kFirefighter:
      return "firefighter";
    case Role::kCommander:
      return "commander";
  }
  return "observer";
}

std::optional<Role> role_of(std::string_view word) {
  for (const Role role : {Role::kObserver, Role::kFirefighter, Role::kCommander})
    if (word == to_string(role)) return role;
  return std::nullopt;
}

}  // namespace smokemap::server
