#include "server/store/sqlite.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/random.hpp"
#include "tests/support/failing_vfs.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

Database opened(const test::TemporaryFolder& folder) {
  auto database = Database::open(folder.path() + "/test.db");
  EXPECT_THAT(database, test::IsOk());
  EXPECT_THAT(database->run("CREATE TABLE IF NOT EXISTS t(number INTEGER, text TEXT UNIQUE)"), test::IsOk());
  return std::move(*database);
}

TEST(Database, GivesBackAnyTextAndNumber) {
  const test::TemporaryFolder folder;
  Database database = opened(folder);
  std::mt19937_64 random(1);
  for (int i = 0; i < 50; ++i) {
    std::string text = std::to_string(i);
    for (std::uint64_t n = uniform_index(random, 60); n > 0; --n) text += static_cast<char>(uniform_index(random, 256));
    const auto number = static_cast<std::int64_t>(random());
    ASSERT_THAT(database.prepare("INSERT INTO t VALUES(?, ?)").bind(number).bind(text).step(), test::IsOk());
    Statement select = database.prepare("SELECT number, text FROM t WHERE rowid = ?");
    const auto row = select.bind(database.last_row()).step();
    ASSERT_THAT(row, test::IsOk());
    ASSERT_TRUE(*row);
    EXPECT_EQ(select.integer(0), number);
    EXPECT_EQ(select.text(1), text) << "zero bytes and all";
  }
}

TEST(Database, TellsAnEmptyTextFromNone) {
  const test::TemporaryFolder folder;
  Database database = opened(folder);
  ASSERT_THAT(database.prepare("INSERT INTO t VALUES(1, ?)").bind(std::string_view()).step(), test::IsOk());
  Statement select = database.prepare("SELECT number FROM t WHERE text = ?");
  EXPECT_TRUE(*select.bind("").step());
}

TEST(Database, SaysWhatIsWrongWithAStatement) {
  const test::TemporaryFolder folder;
  Database database = opened(folder);
  EXPECT_THAT(database.run("THIS IS NO SQL"), test::Fails(Errc::kIo));
  EXPECT_THAT(database.prepare("SELECT nothing FROM nowhere").step(), test::Fails(Errc::kIo));
  EXPECT_THAT(database.prepare("INSERT INTO t VALUES(1, 'a')").step(), test::IsOk());
  EXPECT_THAT(database.prepare("INSERT INTO t VALUES(2, 'a')").step(), test::Fails(Errc::kConflict));
}

TEST(Database, RefusesFilesThatAreNoneOfIts) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() + "/test.db") << std::string(5000, 'x');
  auto database = Database::open(folder.path() + "/test.db");
  ASSERT_THAT(database, test::IsOk()) << "SQLite looks only when it reads";
  EXPECT_THAT(database->run("SELECT * FROM sqlite_schema"), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(Database::open("/proc/none/test.db"), test::Fails(Errc::kIo));
  EXPECT_THAT(Database::open(folder.path() + "/t.db", "no such file system"), test::Fails(Errc::kIo));
}

TEST(Database, SaysThatTheDiskIsFull) {
  const test::TemporaryFolder folder;
  opened(folder);
  const test::FailingVfs vfs(2);
  auto database = Database::open(folder.path() + "/test.db", test::FailingVfs::kName);
  ASSERT_THAT(database, test::IsOk());
  Result<Ok> done = Ok{};
  for (int i = 0; i < 20 && done; ++i) done = database->run("INSERT INTO t VALUES(1, hex(randomblob(2000)))");
  ASSERT_THAT(done, test::Fails(Errc::kIo));
  EXPECT_NE(done.error().message.find("test.db"), std::string::npos) << "which file";
}

}  // namespace
}  // namespace smokemap::server
