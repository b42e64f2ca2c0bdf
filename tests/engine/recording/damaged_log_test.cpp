// Logs as they come off a robot that lost power, off a full disk, or from somebody who means harm: what can be read is
// read, it is said that something is missing, and nothing takes memory for what only a length claims.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "core/random.hpp"
#include "recording/carmen_log.hpp"
#include "recording/log_writer.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/ros_messages.hpp"
#include "recording/rosbag2_db3.hpp"
#include "recording/sensor_log.hpp"
#include "recording/trajectory_tum.hpp"
#include "tests/engine/recording/bag_file.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using FileBytes = std::vector<std::uint8_t>;

FileBytes bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const FileBytes& bytes, std::size_t size) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(std::min(size, bytes.size())));
}

/// A scan whose stamp says which one it is.
LaserScan numbered_scan(int number, int beams = 90) {
  LaserScan scan;
  scan.stamp = from_seconds(100 + 0.1 * number);
  scan.robot = "robot";
  scan.angle_min_rad = -1;
  scan.angle_increment_rad = 2.0 / beams;
  scan.range_min_m = 0.1;
  scan.range_max_m = 10;
  for (int i = 0; i < beams; ++i) scan.ranges_m.push_back(1 + 0.01F * static_cast<float>(i + number));
  return scan;
}

constexpr int kBagScans = 400;

/// A bag of numbered scans; with an index on the time, as ROS makes one, or without.
FileBytes bag_of_scans(const std::filesystem::path& path, bool with_index) {
  {
    test::BagFile bag(path, true, false, with_index);
    for (int i = 0; i < kBagScans; ++i) {
      const LaserScan scan = numbered_scan(i);
      bag.write("/scan", "sensor_msgs/msg/LaserScan", scan.stamp, encode_scan(scan, "laser"));
    }
  }
  return bytes_of(path);
}

class CutBag : public testing::TestWithParam<bool> {};

/// SQLite refuses a file that is shorter than it says, and cannot sort one with a hole: everything was lost.
TEST_P(CutBag, GivesTheScansBeforeTheCutAndSaysSo) {
  const test::ScratchFolder folder;
  const FileBytes whole = bag_of_scans(folder / "whole.db3", GetParam());
  std::size_t before = 0;
  for (const double share : {0.3, 0.5, 0.7, 0.9}) {
    write_bytes(folder / "cut.db3", whole, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
    const auto read = read_log(folder / "cut.db3");
    ASSERT_THAT(read, test::IsOk()) << share;
    EXPECT_GE(read->scans(), before) << "a longer piece never holds less";
    before = read->scans();
    EXPECT_FALSE(read->warnings.empty());
    int number = 0;
    for (const LogItem& item : read->items)
      if (const auto* scan = std::get_if<LaserScan>(&item)) {
        EXPECT_EQ(scan->ranges_m, numbered_scan(number).ranges_m);
        ++number;
      }
  }
  EXPECT_GT(before, GetParam() ? 100u : 300u);
  write_bytes(folder / "head.db3", whole, 300);
  EXPECT_FALSE(read_log(folder / "head.db3"));
}

INSTANTIATE_TEST_SUITE_P(Index, CutBag, testing::Bool(), [](const auto& c) { return c.param ? "With" : "Without"; });

TEST(DamagedBag, WithAnyBytesChangedIsReadOrRefusedButNeverHarms) {
  const test::ScratchFolder folder;
  const FileBytes whole = bag_of_scans(folder / "whole.db3", true);
  std::mt19937_64 random(1);
  int answered = 0;
  for (int round = 0; round < 60; ++round) {
    FileBytes bytes = whole;
    for (int k = 0; k < 20; ++k)
      bytes[uniform_index(random, round % 2 == 0 ? 8192 : bytes.size())] =
          static_cast<std::uint8_t>(uniform_index(random, 256));
    write_bytes(folder / "bad.db3", bytes, bytes.size());
    const auto read = read_log(folder / "bad.db3");
    if (read) {
      ++answered;
      EXPECT_LE(read->scans(), static_cast<std::size_t>(kBagScans));
    } else {
      EXPECT_FALSE(read.error().message.empty());
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(answered, 5);
}

/// It is mended in memory: evidence stays as it was found.
TEST(DamagedBag, IsItselfLeftAlone) {
  const test::ScratchFolder folder;
  const FileBytes whole = bag_of_scans(folder / "whole.db3", false);
  write_bytes(folder / "cut.db3", whole, whole.size() / 2);
  const FileBytes before = bytes_of(folder / "cut.db3");
  ASSERT_THAT(read_log(folder / "cut.db3"), test::IsOk());
  EXPECT_EQ(bytes_of(folder / "cut.db3"), before);
  for (const char* beside : {"cut.db3-wal", "cut.db3-shm", "cut.db3-journal"})
    EXPECT_FALSE(std::filesystem::exists(folder / beside)) << beside;
}

FileBytes mcap_of_scans(int scans) {
  std::ostringstream out;
  LogWriter writer(out);
  for (int i = 0; i < scans; ++i) writer.add(numbered_scan(i, 360));
  EXPECT_THAT(writer.finish(), test::IsOk());
  const std::string text = out.str();
  return {text.begin(), text.end()};
}

Result<SensorLog> mcap_read(const FileBytes& bytes) {
  RosLogBuilder builder;
  if (auto read = read_mcap(bytes, builder); !read) return read.error();
  return std::move(builder).finish("mcap");
}

TEST(DamagedMcap, WithAnyBytesChangedGivesOnlyScansThatWereWritten) {
  const FileBytes whole = mcap_of_scans(1200);
  std::mt19937_64 random(2);
  for (int round = 0; round < 60; ++round) {
    FileBytes bytes = whole;
    for (int k = 0; k < 3; ++k)
      bytes[uniform_index(random, bytes.size())] ^= static_cast<std::uint8_t>(1 + uniform_index(random, 255));
    const auto read = mcap_read(bytes);
    if (!read) continue;
    for (const LogItem& item : read->items) {
      const auto& scan = std::get<LaserScan>(item);
      const auto number = static_cast<int>(std::lround((to_seconds(scan.stamp) - 100) / 0.1));
      ASSERT_EQ(scan.ranges_m, numbered_scan(number, 360).ranges_m) << "a chunk whose sum is wrong was believed";
    }
  }
}

TEST(DamagedMcap, ATailOfNoiseCostsOnlyTheTail) {
  FileBytes bytes = mcap_of_scans(1200);
  const std::size_t kept = bytes.size() / 2;
  std::mt19937_64 random(3);
  for (std::size_t i = kept; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(uniform_index(random, 256));
  const auto noisy = mcap_read(bytes);
  ASSERT_THAT(noisy, test::IsOk());
  const auto cut = mcap_read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(kept)});
  ASSERT_THAT(cut, test::IsOk());
  EXPECT_EQ(noisy->scans(), cut->scans());
  EXPECT_GT(noisy->scans(), 0u);
  EXPECT_FALSE(noisy->warnings.empty());
}

/// Every convention of "nothing there" must reach whoever classifies it: a writer or reader that tidies up lies.
TEST(FaultyRanges, GoThroughARecordingUnchanged) {
  LaserScan scan = numbered_scan(0, 8);
  const float inf = std::numeric_limits<float>::infinity();
  scan.ranges_m = {inf, -inf, 0.0F, std::numeric_limits<float>::quiet_NaN(), -1.0F, 10.5F, 11.0F, 65.533F};
  std::ostringstream out;
  LogWriter writer(out);
  writer.add(scan);
  ASSERT_THAT(writer.finish(), test::IsOk());
  const std::string text = out.str();
  const auto read = mcap_read({text.begin(), text.end()});
  ASSERT_THAT(read, test::IsOk());
  const auto& got = std::get<LaserScan>(read->items.at(0));
  ASSERT_EQ(got.ranges_m.size(), scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    EXPECT_EQ(std::isnan(got.ranges_m[i]), std::isnan(scan.ranges_m[i]));
    if (!std::isnan(scan.ranges_m[i])) {
      EXPECT_EQ(got.ranges_m[i], scan.ranges_m[i]);
    }
    EXPECT_NE(classify(got.ranges_m[i], got, {}), BeamKind::kHit) << i;
  }
}

TEST(FaultyStamps, GoThroughARecordingInTheOrderInWhichTheyCame) {
  const std::vector<double> seconds{100, 100, 99.9, 3700, 101, 0.5, 102, 102};
  SensorLog log;
  for (const double t : seconds) {
    LaserScan scan = numbered_scan(0, 12);
    scan.stamp = from_seconds(t);
    log.items.emplace_back(scan);
  }
  const test::ScratchFolder folder;
  ASSERT_THAT(write_log(log, folder / "run.mcap"), test::IsOk());
  const auto read = read_log(folder / "run.mcap");
  ASSERT_THAT(read, test::IsOk());
  ASSERT_EQ(read->items.size(), seconds.size());
  for (std::size_t i = 0; i < seconds.size(); ++i)
    EXPECT_EQ(std::get<LaserScan>(read->items[i]).stamp, from_seconds(seconds[i]));
}

constexpr const char* kGoodLine = "FLASER 4 1 2 3 4 0 0 0 0 0 0 1.5 host 1\n";

TEST(HostileCarmen, ClaimsOfManyBeamsTakeNoMemory) {
  for (const char* count : {"4000000000", "-1", "18446744073709551615", "1e9", "nan", "2147483647"}) {
    const auto read = read_carmen(std::string(kGoodLine) + "FLASER " + count + " 1 2 3 4 0 0 0 0 0 0 2 host 2\n");
    ASSERT_THAT(read, test::IsOk()) << count;
    EXPECT_EQ(read->scans(), 1u) << count;
    EXPECT_FALSE(read->dropped.empty()) << count;
  }
}

TEST(HostileCarmen, CutAnywhereGivesTheLinesBefore) {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "ODOM " + std::to_string(i) + " 0 0 0 0 0 " + std::to_string(i) + ".25 h 1\n" + kGoodLine;
  std::size_t before = 0;
  for (std::size_t cut = std::string(kGoodLine).size() + 40; cut < text.size(); cut += 7) {
    const auto read = read_carmen(text.substr(0, cut));
    ASSERT_THAT(read, test::IsOk());
    EXPECT_GE(read->scans(), before);
    before = read->scans();
  }
  EXPECT_GE(before, 19u);
}

TEST(HostileCarmen, NoiseBetweenLinesIsCountedNotRead) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 50; ++round) {
    std::string text = kGoodLine;
    for (int line = 0; line < 10; ++line) {
      std::string noise(uniform_index(random, 200), ' ');
      for (char& c : noise) c = static_cast<char>(uniform_index(random, 256));
      std::replace(noise.begin(), noise.end(), '\n', ' ');
      text += (line % 2 ? "FLASER " : "ODOM ") + noise + "\n" + kGoodLine;
    }
    const auto read = read_carmen(text);
    ASSERT_THAT(read, test::IsOk());
    EXPECT_GE(read->scans(), 11u);
    for (const LogItem& item : read->items)
      if (const auto* odometry = std::get_if<Odometry>(&item)) {
        EXPECT_TRUE(odometry->T_odom_robot.is_finite());
      }
  }
}

TEST(DamagedGzip, GivesTheLinesThatCouldBeUnpackedWithAWarning) {
  const test::ScratchFolder folder;
  std::string text;
  std::mt19937_64 random(5);
  for (int i = 0; i < 3000; ++i)
    text += "ODOM " + std::to_string(uniform(random, -9, 9)) + " 0 0 0 0 0 " + std::to_string(i) + " h 1\n" + kGoodLine;
  const gzFile file = gzopen((folder / "run.log.gz").c_str(), "wb");
  ASSERT_NE(file, nullptr);
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  const FileBytes packed = bytes_of(folder / "run.log.gz");
  write_bytes(folder / "cut.log.gz", packed, packed.size() / 2);
  const auto read = read_log(folder / "cut.log.gz");
  ASSERT_THAT(read, test::IsOk());
  EXPECT_GT(read->scans(), 1000u);
  EXPECT_LT(read->scans(), 3000u);
  EXPECT_FALSE(read->warnings.empty());
}

TEST(HostileTrajectories, AreReadOrRefusedWhateverTheyHold) {
  std::mt19937_64 random(6);
  const std::string alphabet = "0123456789.-+eE \t\n#naninf";
  int read = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (std::size_t k = uniform_index(random, 80); k > 0; --k)
      text += alphabet[uniform_index(random, alphabet.size())];
    const auto poses = from_tum(text);
    read += poses.ok();
    if (!poses) continue;
    for (const StampedPose& pose : *poses) EXPECT_TRUE(pose.T_map_robot.is_finite());
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace smokemap
