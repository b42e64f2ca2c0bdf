#pragma once

#include <functional>
#include <memory>

#include "core/time.hpp"
#include "server/access/pairing.hpp"
#include "server/http/picture_service.hpp"
#include "server/http/service.hpp"
#include "server/store/file_store.hpp"
#include "server/store/store.hpp"
#include "server/wire/command_sink.hpp"
#include "server/wire/engine_port.hpp"

namespace smokemap::server {

/// The state as it was once.
struct Past {
  std::shared_ptr<const Snapshot> snapshot;  ///< never null
  ServerView view;
};

/// What the requests below /api are made of. References outlive the service.
struct ApiParts {
  Access& access;
  Store& store;
  FileStore& files;
  PictureService& pictures;
  EnginePort& engine;
  CommandSink& commands;
  std::shared_ptr<const Clock> clock;
  std::uint32_t epoch = 0;
  /// The state after event `at`, from a replay of its own; absent = not offered.
  std::function<Result<Past>(std::int64_t at)> snapshot_at;
};

/// Adds every request of docs/wire.md, section 1.
void add_api(HttpService& service, const ApiParts& parts);

}  // namespace smokemap::server
