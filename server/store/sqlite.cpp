#include "server/store/sqlite.hpp"

#include <sqlite3.h>

namespace smokemap::server {
namespace {

/// One line for people, and the closed code.
Error error_of(sqlite3* database, int status) {
  const char* file = database ? sqlite3_db_filename(database, "main") : nullptr;
  const std::string where = file && *file ? file : "the database";
  switch (status & 0xff) {
    case SQLITE_FULL:
      return fail(Errc::kIo, where + ": the disk is full");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return fail(Errc::kCorrupt, where + " is damaged; move it away or put a copy in its place");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return fail(Errc::kConflict, where + " is in use by another process");
    case SQLITE_CONSTRAINT:
      return fail(Errc::kConflict, where + ": " + sqlite3_errmsg(database));
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return fail(Errc::kIo, where + " cannot be opened for writing");
    default:
      return fail(Errc::kIo, where + ": " + (database ? sqlite3_errmsg(database) : sqlite3_errstr(status)));
  }
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Statement& Statement::bind(std::int64_t value) {
  if (statement_) sqlite3_bind_int64(statement_.get(), ++bound_, value);
  return *this;
}

Statement& Statement::bind(std::string_view text) {
  const char* data = text.data() ? text.data() : "";  // a null pointer would be NULL, which equals nothing
  if (statement_ &&
      sqlite3_bind_text(statement_.get(), ++bound_, data, static_cast<int>(text.size()), SQLITE_TRANSIENT) != SQLITE_OK)
    error_ = fail(Errc::kTooLarge, "a text of " + std::to_string(text.size()) + " bytes does not fit the database");
  return *this;
}

Result<bool> Statement::step() {
  if (!error_.message.empty()) return error_;
  const int status = sqlite3_step(statement_.get());
  if (status == SQLITE_ROW) return true;
  if (status == SQLITE_DONE) return false;
  return error_of(database_, status);
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

std::string Statement::text(int column) const {
  const auto* text = sqlite3_column_text(statement_.get(), column);
  const int bytes = sqlite3_column_bytes(statement_.get(), column);
  return text ? std::string(reinterpret_cast<const char*>(text), static_cast<std::size_t>(bytes)) : std::string();
}

Result<Database> Database::open(const std::string& path, const std::string& vfs) {
  sqlite3* raw = nullptr;
  const int status =
      sqlite3_open_v2(path.c_str(), &raw, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_FULLMUTEX,
                      vfs.empty() ? nullptr : vfs.c_str());
  Database database(raw);
  if (status != SQLITE_OK) return error_of(raw, status);
  sqlite3_extended_result_codes(raw, 1);
  return database;
}

Result<Ok> Database::run(const char* sql) {
  const int status = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
  if (status != SQLITE_OK) return error_of(database_.get(), status);
  return Ok{};
}

Statement Database::prepare(const char* sql) {
  sqlite3_stmt* raw = nullptr;
  const int status = sqlite3_prepare_v2(database_.get(), sql, -1, &raw, nullptr);
  return Statement(database_.get(), raw, status == SQLITE_OK ? Error{} : error_of(database_.get(), status));
}

std::int64_t Database::last_row() const { return sqlite3_last_insert_rowid(database_.get()); }

}  // namespace smokemap::server
