#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/sqlite.hpp"
#include "server/wire/role.hpp"

namespace smokemap::server {

/// What somebody did, as it is kept.
struct Event {
  std::int64_t seq = 0;  ///< 1, 2, ... given by the log
  std::int64_t time_ms = 0;
  Identity who;
  std::string command_id;
  std::string name;
  std::string data;     ///< JSON text
  std::string outcome;  ///< "stored", then "done" or "refused: why"
};

struct DeviceRecord {
  Identity who;
  std::string token_hash;
  std::int64_t created_ms = 0;
  bool revoked = false;
};

/// A picture that belongs to a plan; its bytes are in FileStore.
struct PictureRecord {
  std::string plan_id;
  std::string kind;  ///< "picture" or "rectified"
  std::string sha256;
  std::string media_type;
  int width_px = 0;
  int height_px = 0;
  std::int64_t created_ms = 0;
};

/// The append-only log and the tables beside it, in DATA/smokemap.db. SQLite in WAL mode; an append has reached the
/// disk (synchronous FULL) when it returns. Thread-safe. A log written by a newer program is kUnsupported.
class Store {
 public:
  /// Creates the folder and the file when missing; checks an existing file (quick_check). @param vfs see Database::open
  static Result<std::unique_ptr<Store>> open(const std::string& folder, const std::string& vfs = {});

  /// Appends with outcome "stored"; returns seq. kConflict when the command_id is there already: look with `find`
  /// first.
  Result<std::int64_t> append(const Event& event);
  /// Not synced by itself: after a crash the outcome may read "stored" again, and replay decides anew.
  Result<Ok> set_outcome(std::int64_t seq, std::string_view outcome);
  Result<std::optional<Event>> find(std::string_view command_id);
  /// At most `limit` events with seq >= from, in order.
  Result<std::vector<Event>> events(std::int64_t from, int limit);

  Result<Ok> add_device(const DeviceRecord& device);
  Result<std::vector<DeviceRecord>> devices();

  Result<Ok> add_picture(const PictureRecord& picture);
  /// The newest of the kind; with `sha256` that very one.
  Result<std::optional<PictureRecord>> picture(std::string_view plan_id, std::string_view kind,
                                               std::string_view sha256 = {});

  /// A number greater than at any start before, near `now_s`.
  Result<std::uint32_t> next_epoch(std::int64_t now_s);

 private:
  explicit Store(Database database) : database_(std::move(database)) {}
  Result<Ok> prepare_schema();
  Database database_;
  std::mutex mutex_;
};

}  // namespace smokemap::server
