#include "recording/rosbag2_db3.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "recording/file_bytes.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kMostMendedBytes = std::size_t{1} << 31;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinalizeStatement>;

Error database_error(sqlite3* database) {
  return fail(Errc::kCorrupt, std::string("rosbag2 file: ") + sqlite3_errmsg(database));
}

std::string column_text(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))) : std::string();
}

/// Adds all rows of a query, counting them; the status that ended it.
Result<int> read_rows(sqlite3* database, const char* query, RosLogBuilder& builder, std::size_t& read) {
  sqlite3_stmt* prepared = nullptr;
  if (sqlite3_prepare_v2(database, query, -1, &prepared, nullptr) != SQLITE_OK) return database_error(database);
  const Statement rows(prepared);
  int status = sqlite3_step(rows.get());
  for (; status == SQLITE_ROW; status = sqlite3_step(rows.get()), ++read) {
    if (column_text(rows.get(), 2) != "cdr") {
      builder.drop("not in CDR");
      continue;
    }
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(rows.get(), 3));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(rows.get(), 3));
    builder.add(column_text(rows.get(), 0), column_text(rows.get(), 1), {data, data ? size : 0});
  }
  return status;
}

Result<Ok> read_messages(sqlite3* database, RosLogBuilder& builder) {
  // A stranger's file: no functions hidden in its schema, no reading past its own pages.
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, 256 * 1024 * 1024);
  // Sorting needs all of a bag that has no index; one that is damaged still has what was recorded before, in order of
  // its rows.
  constexpr const char* kSorted =
      "SELECT topics.name, topics.type, topics.serialization_format, messages.data FROM messages "
      "JOIN topics ON topics.id = messages.topic_id ORDER BY messages.timestamp, messages.id";
  constexpr const char* kAsRecorded =
      "SELECT topics.name, topics.type, topics.serialization_format, messages.data FROM messages NOT INDEXED "
      "CROSS JOIN topics ON topics.id = messages.topic_id";
  std::size_t read = 0;
  for (const char* query : {kSorted, kAsRecorded}) {
    const auto status = read_rows(database, query, builder, read);
    if (!status) return status.error();
    if (*status == SQLITE_DONE && query == kSorted) return Ok{};
    if (read > 0) break;
  }
  if (read == 0) return database_error(database);
  builder.warn("the bag is damaged; " + std::to_string(read) + " messages before the damage were read");
  return Ok{};
}

/// A bag that was cut tells in its header how many pages it had, and SQLite then reads none of it: told how many there
/// are, it reads up to the first that is missing.
void tell_true_size(std::span<unsigned char> bytes) {
  constexpr std::size_t kHeader = 100, kPageSize = 16, kPages = 28;
  if (bytes.size() < kHeader) return;
  const std::size_t stored = static_cast<std::size_t>(bytes[kPageSize] << 8 | bytes[kPageSize + 1]);
  const std::size_t page_size = stored == 1 ? 65536 : stored;
  if (page_size < 512) return;
  const std::size_t pages = bytes.size() / page_size;
  std::size_t told = 0;
  for (std::size_t i = 0; i < 4; ++i) told = told << 8 | bytes[kPages + i];
  if (told <= pages) return;
  for (std::size_t i = 0; i < 4; ++i) bytes[kPages + i] = static_cast<unsigned char>(pages >> (24 - 8 * i));
}

/// A bag that ROS wrote with a write-ahead log makes even a reader lay two files beside it, unless it is told that
/// nobody changes the bag. Where such a log lies there already, its messages are wanted too.
std::string uri_of(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char c : path.string()) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#')
      uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    else
      uri += c;
  }
  std::error_code ignored;
  const bool has_log = std::filesystem::exists(path.string() + "-wal", ignored);
  return uri + (has_log ? "?mode=ro" : "?immutable=1");
}

}  // namespace

Result<Ok> read_db3(const std::filesystem::path& path, RosLogBuilder& builder) {
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(uri_of(path).c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  const Database database(opened);
  if (status != SQLITE_OK) return fail(Errc::kIo, "cannot open " + path.string());
  const auto done = read_messages(opened, builder);
  if (done || done.error().code != Errc::kCorrupt) return done;
  const auto bytes = read_file(path, kMostMendedBytes);  // what can be mended is mended in memory
  return bytes ? read_db3(*bytes, builder) : done;
}

Result<Ok> read_db3(std::span<const std::uint8_t> bytes, RosLogBuilder& builder) {
  sqlite3* opened = nullptr;
  if (sqlite3_open(":memory:", &opened) != SQLITE_OK) return fail(Errc::kIo, "cannot open a database in memory");
  const Database database(opened);
  auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(bytes.size() + 1));
  if (!copy) return fail(Errc::kTooLarge, "no memory to unpack the bag");
  std::copy(bytes.begin(), bytes.end(), copy);
  tell_true_size({copy, bytes.size()});
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  if (sqlite3_deserialize(opened, "main", copy, size, size,
                          SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    return database_error(opened);
  return read_messages(opened, builder);
}

}  // namespace smokemap
