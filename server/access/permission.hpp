#pragma once

#include "core/result.hpp"
#include "server/wire/role.hpp"
#include "session/commands.hpp"

namespace smokemap::server {

/// Who may do what (docs/wire.md, "Commands"); asked for every single message. kForbidden says who may not do what.
Result<Ok> may(Role role, const Command& command);

}  // namespace smokemap::server
