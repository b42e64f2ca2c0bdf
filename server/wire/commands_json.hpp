#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "server/wire/json.hpp"
#include "session/commands.hpp"

namespace smokemap::server {

/// Who made a command and when: kept beside it in the log, not believed from the browser.
struct Authorship {
  std::string author;
  Stamp created = 0;
};

/// `data` of the command `name` (docs/wire.md, section 2) -> command. kNotFound for a name nobody knows,
/// kInvalidArgument with the field otherwise.
Result<Command> command_from_json(std::string_view name, const Json& data, const Authorship& authorship);

/// The wire's name of a command.
const char* command_name(const Command& command);
/// The inverse of command_from_json.
Json command_data(const Command& command);

/// Every name, in the order of the variant `Command`.
const std::vector<const char*>& command_names();

}  // namespace smokemap::server
