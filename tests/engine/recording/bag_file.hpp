#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace smokemap::test {

/// A folder of its own for each test, gone afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name =
        std::string("smokemap_") + info->test_suite_name() + "_" + info->name() + "_" + std::to_string(getpid());
    std::replace(name.begin(), name.end(), '/', '_');  // of parametrised tests
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Writes rosbag2's SQLite form: its tables as every version since Dashing has them, plus those of Humble when asked.
class BagFile {
 public:
  explicit BagFile(const std::filesystem::path& path, bool humble = true, bool with_log = false,
                   bool with_index = false) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
    if (with_log) run("PRAGMA journal_mode=WAL");
    run("PRAGMA synchronous=OFF");  // nobody pulls the plug of a test
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
        "data BLOB NOT NULL)");
    if (with_index) run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
    if (humble) {
      run("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)");
      run("INSERT INTO schema VALUES(3, 'humble')");
      run("CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL)");
    }
    run("BEGIN");
  }
  ~BagFile() {
    run("COMMIT");
    sqlite3_close(database_);
  }
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;

  void write(const std::string& topic, const std::string& type, std::int64_t time, const std::vector<std::uint8_t>& cdr,
             const std::string& format = "cdr") {
    const auto [known, is_new] = topics_.try_emplace(topic, topics_.size() + 1);
    if (is_new)
      run("INSERT INTO topics VALUES(" + std::to_string(known->second) + ", '" + topic + "', '" + type + "', '" +
          format + "', '')");
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database_, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1, &insert,
                       nullptr);
    sqlite3_bind_int64(insert, 1, static_cast<sqlite3_int64>(known->second));
    sqlite3_bind_int64(insert, 2, time);
    sqlite3_bind_blob(insert, 3, cdr.data(), static_cast<int>(cdr.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }

 private:
  void run(const std::string& sql) {
    EXPECT_EQ(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  }

  sqlite3* database_ = nullptr;
  std::map<std::string, std::size_t> topics_;
};

}  // namespace smokemap::test
