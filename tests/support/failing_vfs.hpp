#pragma once

#include <sqlite3.h>

#include <cstring>
#include <string>

namespace smokemap::test {

/// SQLite's own file system, whose n-th write or sync (and all later ones) fails. One at a time.
class FailingVfs {
 public:
  static constexpr const char* kName = "failing";

  explicit FailingVfs(int fail_at) {
    state().left = fail_at;
    base() = sqlite3_vfs_find(nullptr);
    vfs_ = *base();
    vfs_.zName = kName;
    vfs_.szOsFile = base()->szOsFile + static_cast<int>(sizeof(File));
    vfs_.xOpen = open;
    sqlite3_vfs_register(&vfs_, 0);
  }
  ~FailingVfs() { sqlite3_vfs_unregister(&vfs_); }
  FailingVfs(const FailingVfs&) = delete;
  FailingVfs& operator=(const FailingVfs&) = delete;
  bool failed() const { return state().left <= 0; }

 private:
  struct File {
    sqlite3_file base;
    sqlite3_io_methods methods;
  };
  struct State {
    int left = 0;
  };
  static State& state() {
    static State s;
    return s;
  }
  static sqlite3_vfs*& base() {
    static sqlite3_vfs* v = nullptr;
    return v;
  }
  static bool fails() { return state().left <= 0 || --state().left <= 0; }
  /// The system's file lies behind ours in the same memory.
  static sqlite3_file* inner(sqlite3_file* file) {
    return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + sizeof(File));
  }
  static int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out) {
    auto* ours = reinterpret_cast<File*>(file);
    std::memset(ours, 0, sizeof(File));
    const int status = base()->xOpen(base(), name, inner(file), flags, out);
    if (status != SQLITE_OK) return status;
    ours->methods = {};
    ours->methods.iVersion = 1;  // no shared memory: the log's index stays in the process, as with the exclusive lock
    ours->methods.xClose = [](sqlite3_file* f) { return inner(f)->pMethods->xClose(inner(f)); };
    ours->methods.xRead = [](sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
      return inner(f)->pMethods->xRead(inner(f), to, n, at);
    };
    ours->methods.xWrite = [](sqlite3_file* f, const void* from, int n, sqlite3_int64 at) {
      return fails() ? SQLITE_FULL : inner(f)->pMethods->xWrite(inner(f), from, n, at);
    };
    ours->methods.xTruncate = [](sqlite3_file* f, sqlite3_int64 n) {
      return inner(f)->pMethods->xTruncate(inner(f), n);
    };
    ours->methods.xSync = [](sqlite3_file* f, int how) {
      return fails() ? SQLITE_IOERR_FSYNC : inner(f)->pMethods->xSync(inner(f), how);
    };
    ours->methods.xFileSize = [](sqlite3_file* f, sqlite3_int64* n) {
      return inner(f)->pMethods->xFileSize(inner(f), n);
    };
    ours->methods.xLock = [](sqlite3_file* f, int how) { return inner(f)->pMethods->xLock(inner(f), how); };
    ours->methods.xUnlock = [](sqlite3_file* f, int how) { return inner(f)->pMethods->xUnlock(inner(f), how); };
    ours->methods.xCheckReservedLock = [](sqlite3_file* f, int* is) {
      return inner(f)->pMethods->xCheckReservedLock(inner(f), is);
    };
    ours->methods.xFileControl = [](sqlite3_file* f, int op, void* arg) {
      return inner(f)->pMethods->xFileControl(inner(f), op, arg);
    };
    ours->methods.xSectorSize = [](sqlite3_file* f) { return inner(f)->pMethods->xSectorSize(inner(f)); };
    ours->methods.xDeviceCharacteristics = [](sqlite3_file* f) {
      return inner(f)->pMethods->xDeviceCharacteristics(inner(f));
    };
    ours->base.pMethods = &ours->methods;
    return SQLITE_OK;
  }
  sqlite3_vfs vfs_{};
};

}  // namespace smokemap::test
