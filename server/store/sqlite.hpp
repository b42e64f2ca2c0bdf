#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace smokemap::server {

/// A prepared statement: bind in order, then step. Errors of binding show at `step`.
class Statement {
 public:
  Statement& bind(std::int64_t value);
  Statement& bind(std::string_view text);  ///< copied
  /// True: a row is there to be read; false: done.
  Result<bool> step();
  std::int64_t integer(int column) const;
  std::string text(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(sqlite3* database, sqlite3_stmt* statement, Error error)
      : database_(database), statement_(statement), error_(std::move(error)) {}
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  Error error_;  ///< message empty = none yet
  int bound_ = 0;
};

/// One SQLite connection, confined to one thread at a time. Every failure is a Result: kIo with "the disk is full" or
/// the like, kCorrupt for a file that is damaged or is no database.
class Database {
 public:
  /// @param vfs  name of a registered sqlite3_vfs, for tests; empty = the system's
  static Result<Database> open(const std::string& path, const std::string& vfs = {});

  Result<Ok> run(const char* sql);
  Statement prepare(const char* sql);
  std::int64_t last_row() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  explicit Database(sqlite3* database) : database_(database) {}
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace smokemap::server
