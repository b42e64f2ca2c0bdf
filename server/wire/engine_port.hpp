#pragma once

#include <functional>
#include <memory>

#include "session/commands.hpp"
#include "session/snapshot.hpp"

namespace smokemap::server {

/// What the server needs of the engine, so that tests can put a double in its place.
/// Thread-safe; the listener is called from the engine's thread and returns at once.
class EnginePort {
 public:
  using Listener = std::function<void(std::shared_ptr<const Snapshot>)>;

  virtual ~EnginePort() = default;
  /// The future snapshot that contains the command has a revision of at least the returned one.
  virtual Result<std::uint64_t> apply(const Command& command) = 0;
  virtual std::shared_ptr<const Snapshot> snapshot() const = 0;
  virtual void on_snapshot(Listener listener) = 0;
};

}  // namespace smokemap::server
