#include "server/store/store.hpp"

#include <algorithm>
#include <filesystem>

namespace smokemap::server {
namespace {

constexpr std::int64_t kSchemaVersion = 1;
constexpr const char* kSchema = R"(
CREATE TABLE events(seq INTEGER PRIMARY KEY AUTOINCREMENT, time_ms INTEGER NOT NULL, device TEXT NOT NULL,
  name_of_person TEXT NOT NULL, role TEXT NOT NULL, command_id TEXT NOT NULL UNIQUE, name TEXT NOT NULL,
  data TEXT NOT NULL, outcome TEXT NOT NULL);
CREATE TABLE devices(id TEXT PRIMARY KEY, name TEXT NOT NULL, role TEXT NOT NULL, token_hash TEXT NOT NULL UNIQUE,
  created_ms INTEGER NOT NULL, revoked INTEGER NOT NULL);
CREATE TABLE pictures(plan_id TEXT NOT NULL, kind TEXT NOT NULL, sha256 TEXT NOT NULL, media_type TEXT NOT NULL,
  width INTEGER NOT NULL, height INTEGER NOT NULL, created_ms INTEGER NOT NULL, UNIQUE(plan_id, kind, sha256));
CREATE TABLE meta(key TEXT PRIMARY KEY, value INTEGER NOT NULL);
PRAGMA user_version = 1;
)";
constexpr const char* kEventColumns =
    "SELECT seq, time_ms, device, name_of_person, role, command_id, name, data, outcome FROM events ";

Event event_of(const Statement& row) {
  Event event;
  event.seq = row.integer(0);
  event.time_ms = row.integer(1);
  event.who = {row.text(2), row.text(3), role_of(row.text(4)).value_or(Role::kObserver)};
  event.command_id = row.text(5);
  event.name = row.text(6);
  event.data = row.text(7);
  event.outcome = row.text(8);
  return event;
}

Result<Ok> finish(Statement statement) {
  const auto stepped = statement.step();
  if (!stepped) return stepped.error();
  return Ok{};
}

/// The single number that a pragma or query answers.
Result<std::int64_t> number(Statement statement) {
  const auto row = statement.step();
  if (!row) return row.error();
  return *row ? statement.integer(0) : 0;
}

}  // namespace

Result<std::unique_ptr<Store>> Store::open(const std::string& folder, const std::string& vfs) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return fail(Errc::kIo, "the data folder " + folder + " cannot be made: " + failed.message());
  auto database = Database::open(folder + "/smokemap.db", vfs);
  if (!database) return database.error();
  std::unique_ptr<Store> store(new Store(std::move(*database)));
  if (auto ready = store->prepare_schema(); !ready) return ready.error();
  return store;
}

Result<Ok> Store::prepare_schema() {
  // One process owns a log: a second server on the same folder would hand out the same epochs and mix two missions.
  if (auto ran = database_.run("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;"
                               "PRAGMA trusted_schema = OFF;");
      !ran)
    return ran;
  const auto version = number(database_.prepare("PRAGMA user_version"));
  if (!version) return version.error();
  if (*version > kSchemaVersion)
    return fail(Errc::kUnsupported,
                "the log was written by a newer Smokemap (version " + std::to_string(*version) + ")");
  if (*version == 0) {
    if (auto ran = database_.run("BEGIN IMMEDIATE"); !ran) return ran;
    if (auto ran = database_.run(kSchema); !ran) return ran;
    return database_.run("COMMIT");
  }
  Statement check = database_.prepare("PRAGMA quick_check(1)");
  const auto row = check.step();
  if (!row) return row.error();
  if (*row && check.text(0) != "ok")
    return fail(Errc::kCorrupt,
                "the log smokemap.db is damaged (" + check.text(0) + "); move it away or put a copy in its place");
  return Ok{};
}

Result<std::int64_t> Store::append(const Event& event) {
  const std::lock_guard lock(mutex_);
  Statement insert = database_.prepare(
      "INSERT INTO events(time_ms, device, name_of_person, role, command_id, name, data, outcome) "
      "VALUES(?, ?, ?, ?, ?, ?, ?, 'stored')");
  insert.bind(event.time_ms).bind(event.who.device).bind(event.who.name).bind(to_string(event.who.role));
  insert.bind(event.command_id).bind(event.name).bind(event.data);
  const auto stepped = insert.step();
  if (!stepped) return stepped.error();
  return database_.last_row();
}

Result<Ok> Store::set_outcome(std::int64_t seq, std::string_view outcome) {
  const std::lock_guard lock(mutex_);
  if (auto ran = database_.run("PRAGMA synchronous = NORMAL"); !ran) return ran;
  auto updated =
      finish(std::move(database_.prepare("UPDATE events SET outcome = ? WHERE seq = ?").bind(outcome).bind(seq)));
  const auto restored = database_.run("PRAGMA synchronous = FULL");
  return updated.ok() ? restored : updated;
}

Result<std::optional<Event>> Store::find(std::string_view command_id) {
  const std::lock_guard lock(mutex_);
  Statement select = database_.prepare((std::string(kEventColumns) + "WHERE command_id = ?").c_str());
  const auto row = select.bind(command_id).step();
  if (!row) return row.error();
  return *row ? std::optional(event_of(select)) : std::nullopt;
}

Result<std::vector<Event>> Store::events(std::int64_t from, int limit) {
  const std::lock_guard lock(mutex_);
  std::vector<Event> events;
  Statement select = database_.prepare((std::string(kEventColumns) + "WHERE seq >= ? ORDER BY seq LIMIT ?").c_str());
  select.bind(from).bind(std::int64_t{std::max(0, limit)});
  for (;;) {
    const auto row = select.step();
    if (!row) return row.error();
    if (!*row) return events;
    events.push_back(event_of(select));
  }
}

Result<Ok> Store::add_device(const DeviceRecord& device) {
  const std::lock_guard lock(mutex_);
  Statement insert = database_.prepare("INSERT OR REPLACE INTO devices VALUES(?, ?, ?, ?, ?, ?)");
  insert.bind(device.who.device).bind(device.who.name).bind(to_string(device.who.role)).bind(device.token_hash);
  insert.bind(device.created_ms).bind(std::int64_t{device.revoked});
  return finish(std::move(insert));
}

Result<std::vector<DeviceRecord>> Store::devices() {
  const std::lock_guard lock(mutex_);
  std::vector<DeviceRecord> devices;
  Statement select = database_.prepare("SELECT id, name, role, token_hash, created_ms, revoked FROM devices");
  for (;;) {
    const auto row = select.step();
    if (!row) return row.error();
    if (!*row) return devices;
    const Identity who{select.text(0), select.text(1), role_of(select.text(2)).value_or(Role::kObserver)};
    devices.push_back({who, select.text(3), select.integer(4), select.integer(5) != 0});
  }
}

Result<Ok> Store::add_picture(const PictureRecord& picture) {
  const std::lock_guard lock(mutex_);
  Statement insert = database_.prepare("INSERT OR REPLACE INTO pictures VALUES(?, ?, ?, ?, ?, ?, ?)");
  insert.bind(picture.plan_id).bind(picture.kind).bind(picture.sha256).bind(picture.media_type);
  insert.bind(std::int64_t{picture.width_px}).bind(std::int64_t{picture.height_px}).bind(picture.created_ms);
  return finish(std::move(insert));
}

Result<std::optional<PictureRecord>> Store::picture(std::string_view plan_id, std::string_view kind,
                                                    std::string_view sha256) {
  const std::lock_guard lock(mutex_);
  Statement select = database_.prepare(
      "SELECT plan_id, kind, sha256, media_type, width, height, created_ms FROM pictures "
      "WHERE plan_id = ? AND kind = ? AND (? = '' OR sha256 = ?) ORDER BY created_ms DESC, rowid DESC LIMIT 1");
  const auto row = select.bind(plan_id).bind(kind).bind(sha256).bind(sha256).step();
  if (!row) return row.error();
  if (!*row) return std::optional<PictureRecord>();
  return std::optional(PictureRecord{select.text(0), select.text(1), select.text(2), select.text(3),
                                     static_cast<int>(select.integer(4)), static_cast<int>(select.integer(5)),
                                     select.integer(6)});
}

Result<std::uint32_t> Store::next_epoch(std::int64_t now_s) {
  const std::lock_guard lock(mutex_);
  const auto last = number(database_.prepare("SELECT value FROM meta WHERE key = 'epoch'"));
  if (!last) return last.error();
  const std::int64_t next = std::max(now_s, *last + 1);
  if (auto saved = finish(std::move(database_.prepare("INSERT OR REPLACE INTO meta VALUES('epoch', ?)").bind(next)));
      !saved)
    return saved.error();
  return static_cast<std::uint32_t>(next);
}

}  // namespace smokemap::server
