#include <sqlite3.h>

#include <cstring>

#include "core/expect.hpp"
#include "recording/rosbag2_db3.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  RosLogBuilder builder;
  if (!read_db3(std::span<const std::uint8_t>(data, size), builder)) return 0;
  const SensorLog log = std::move(builder).finish("rosbag2");
  for (const LogItem& item : log.items)
    if (const auto* scan = std::get_if<LaserScan>(&item)) ENGINE_EXPECT(check(*scan).ok());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  sqlite3* database = nullptr;
  ENGINE_EXPECT(sqlite3_open(":memory:", &database) == SQLITE_OK);
  sqlite3_exec(database,
               "PRAGMA page_size=512;"
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
               "INSERT INTO topics VALUES(1, '/scan', 'sensor_msgs/msg/LaserScan', 'cdr');",
               nullptr, nullptr, nullptr);
  const Bytes scan = encode_scan({7, "", 0, 0.1, 0, 0, 10, std::vector<float>(100, 2.f), {}, {}}, "laser");
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, 5, ?)", -1, &insert, nullptr);
  for (int i = 0; i < 4; ++i) {
    sqlite3_bind_blob(insert, 1, scan.data(), static_cast<int>(scan.size()), SQLITE_STATIC);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(database, "main", &size, 0);
  const Bytes file(bytes, bytes + size);
  sqlite3_free(bytes);
  sqlite3_close(database);
  return {file};
}
