#pragma once

#include <functional>

#include "server/wire/messages.hpp"

namespace smokemap::server {

/// Where sockets and HTTP hand in what people do.
class CommandSink {
 public:
  using Reply = std::function<void(const CommandReply&)>;

  virtual ~CommandSink() = default;
  /// Returns at once; `reply` is called exactly once, on another thread, when the command is stored and carried out or
  /// refused. Any thread.
  virtual void submit(const Identity& who, CommandMessage message, Reply reply) = 0;
};

}  // namespace smokemap::server
