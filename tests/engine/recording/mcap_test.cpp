#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/random.hpp"
#include "recording/log_writer.hpp"
#include "recording/mcap_format.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/ros_messages.hpp"
#include "recording/sensor_log.hpp"
#include "tests/engine/recording/bag_file.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using McapFile = std::vector<std::uint8_t>;

/// Two robots, everything they can say, noise in every number; angles in floats, as the wire has them.
SensorLog random_log(std::uint64_t seed, int items) {
  std::mt19937_64 random(seed);
  SensorLog log;
  for (int i = 0; i < items; ++i) {
    const std::string robot = uniform_index(random, 2) == 0 ? "robot" : "fox";
    const Stamp stamp =
        1'700'000'000'000'000'000 + Stamp{i} * 10'000'000 - static_cast<Stamp>(uniform_index(random, 30'000'000));
    const Pose2 mount = robot == "fox" ? Pose2(0.25, 0, 0.5) : Pose2(-0.5, 0.125, 1);
    const std::uint64_t kind = uniform_index(random, 3);
    if (kind == 0) {
      LaserScan scan{stamp, robot, -1.5f, 0.03125f, 0, 0.125, 12, {}, {}, mount};
      for (int beam = 0; beam < 200; ++beam) scan.ranges_m.push_back(static_cast<float>(uniform(random, 0, 20)));
      scan.intensities.assign(200, 7);
      log.items.emplace_back(scan);
    } else if (kind == 1) {
      log.items.emplace_back(
          Odometry{stamp, robot, Pose2(uniform(random, -9, 9), 1, uniform(random, -3, 3)), 0.5, -0.25});
    } else {
      RadarSweep sweep{stamp, 0.5, robot, 0, 0.125f, 0.5, 0.0625, 16, 50, {}, mount};
      for (int bin = 0; bin < 16 * 50; ++bin) sweep.power.push_back(static_cast<float>(exponential(random)));
      log.items.emplace_back(sweep);
    }
  }
  return log;
}

McapFile recorded(const SensorLog& log) {
  std::ostringstream out;
  LogWriter writer(out);
  for (const LogItem& item : log.items) writer.add(item);
  EXPECT_THAT(writer.finish(), test::IsOk());
  const std::string bytes = out.str();
  return {bytes.begin(), bytes.end()};
}

Result<SensorLog> read_back(std::span<const std::uint8_t> bytes) {
  RosLogBuilder builder;
  if (auto read = read_mcap(bytes, builder); !read) return read.error();
  return std::move(builder).finish("mcap");
}

void expect_same(const LogItem& sent, const LogItem& got) {
  ASSERT_EQ(sent.index(), got.index());
  if (const auto* a = std::get_if<LaserScan>(&sent)) {
    const auto& b = std::get<LaserScan>(got);
    EXPECT_EQ(
        std::tie(b.stamp, b.robot, b.ranges_m, b.intensities, b.angle_min_rad, b.angle_increment_rad, b.range_max_m),
        std::tie(a->stamp, a->robot, a->ranges_m, a->intensities, a->angle_min_rad, a->angle_increment_rad,
                 a->range_max_m));
    EXPECT_THAT(b.T_robot_laser, test::IsNear(a->T_robot_laser, 1e-12, 1e-12));
  } else if (const auto* o = std::get_if<Odometry>(&sent)) {
    const auto& p = std::get<Odometry>(got);
    EXPECT_EQ(std::tie(p.stamp, p.robot, p.speed_mps, p.turn_rate_radps),
              std::tie(o->stamp, o->robot, o->speed_mps, o->turn_rate_radps));
    EXPECT_THAT(p.T_odom_robot, test::IsNear(o->T_odom_robot, 1e-12, 1e-12));
  } else if (const auto* r = std::get_if<RadarSweep>(&sent)) {
    const auto& s = std::get<RadarSweep>(got);
    EXPECT_EQ(std::tie(s.stamp, s.robot, s.power, s.azimuths, s.bins, s.range_min_m, s.range_resolution_m,
                       s.azimuth_increment_rad),
              std::tie(r->stamp, r->robot, r->power, r->azimuths, r->bins, r->range_min_m, r->range_resolution_m,
                       r->azimuth_increment_rad));
    EXPECT_NEAR(s.duration_s, r->duration_s, 1e-6);
    EXPECT_THAT(s.T_robot_radar, test::IsNear(r->T_robot_radar, 1e-12, 1e-12));
  }
}

TEST(Mcap, GivesBackEveryItemInOrderOverManyChunks) {
  const SensorLog sent = random_log(1, 1500);
  const test::ScratchFolder folder;
  ASSERT_THAT(write_log(sent, folder / "run.mcap"), test::IsOk());
  const auto read = read_log(folder / "run.mcap");
  ASSERT_THAT(read, test::IsOk());
  EXPECT_EQ(read->format, "mcap");
  EXPECT_TRUE(read->warnings.empty()) << read->warnings[0];
  ASSERT_EQ(read->items.size(), sent.items.size());
  for (std::size_t i = 0; i < sent.items.size(); ++i) expect_same(sent.items[i], read->items[i]);
}

TEST(Mcap, IsTheSameFileForTheSameLog) { EXPECT_EQ(recorded(random_log(2, 50)), recorded(random_log(2, 50))); }

TEST(Mcap, GivesEverythingBeforeACutAnywhere) {
  const McapFile whole = recorded(random_log(3, 600));
  std::size_t before = 0;
  for (std::size_t cut = kMcapMagic.size(); cut < whole.size(); cut += 9973) {
    const auto read = read_back({whole.data(), cut});
    ASSERT_THAT(read, test::IsOk());
    EXPECT_GE(read->items.size(), before) << "a longer piece never holds less";
    before = read->items.size();
  }
  EXPECT_GT(before, 500u);
}

TEST(Mcap, LeavesOutAChunkWhoseSumIsWrongAndCountsIt) {
  McapFile bytes = recorded(random_log(4, 600));
  bytes[bytes.size() / 2] ^= 0x40;
  const auto read = read_back(bytes);
  ASSERT_THAT(read, test::IsOk());
  EXPECT_LT(read->items.size(), 600u);
  EXPECT_FALSE(read->dropped.empty());
}

/// A record and a file as the format describes them, put together by hand.
template <typename T>
void put(McapFile& to, T value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  to.insert(to.end(), first, first + sizeof value);
}
void put_text(McapFile& to, std::string_view text) {
  put(to, static_cast<std::uint32_t>(text.size()));
  to.insert(to.end(), text.begin(), text.end());
}
void put_record(McapFile& to, McapOp op, const McapFile& body) {
  to.push_back(static_cast<std::uint8_t>(op));
  put(to, std::uint64_t{body.size()});
  to.insert(to.end(), body.begin(), body.end());
}

McapFile scan_records(int scans) {
  McapFile records, schema, channel;
  put(schema, std::uint16_t{1}), put_text(schema, kLaserScanType), put_text(schema, "ros2msg"), put_text(schema, "");
  put(channel, std::uint16_t{9}), put(channel, std::uint16_t{1}), put_text(channel, "/scan"), put_text(channel, "cdr");
  put(channel, std::uint32_t{0});
  put_record(records, McapOp::kSchema, schema);
  put_record(records, McapOp::kChannel, channel);
  for (int i = 0; i < scans; ++i) {
    McapFile message;
    put(message, std::uint16_t{9}), put(message, std::uint32_t{0}), put(message, std::uint64_t{5}),
        put(message, std::uint64_t{5});
    const auto cdr = encode_scan({i, "", 0, 0.1, 0, 0, 10, {1, 2, 3}, {}, {}}, "laser");
    message.insert(message.end(), cdr.begin(), cdr.end());
    put_record(records, McapOp::kMessage, message);
  }
  return records;
}

McapFile chunk(const McapFile& plain, const std::string& compression, const McapFile& packed,
               std::uint64_t claimed_size) {
  McapFile body, file(kMcapMagic.begin(), kMcapMagic.end());
  put(body, std::uint64_t{0}), put(body, std::uint64_t{9}), put(body, claimed_size);
  put(body, static_cast<std::uint32_t>(crc32(0, plain.data(), static_cast<uInt>(plain.size()))));
  put_text(body, compression);
  put(body, std::uint64_t{packed.size()});
  body.insert(body.end(), packed.begin(), packed.end());
  put_record(file, McapOp::kChunk, body);
  put_record(file, McapOp::kDataEnd, {0, 0, 0, 0});
  return file;
}

TEST(Mcap, ReadsPlainAndLz4ChunksAndMessagesOutsideOfChunks) {
  const McapFile plain = scan_records(20);
  McapFile packed(LZ4F_compressFrameBound(plain.size(), nullptr));
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), nullptr));
  McapFile loose(kMcapMagic.begin(), kMcapMagic.end());
  loose.insert(loose.end(), plain.begin(), plain.end());
  for (const McapFile& file :
       {chunk(plain, "", plain, plain.size()), chunk(plain, "lz4", packed, plain.size()), loose}) {
    const auto read = read_back(file);
    ASSERT_THAT(read, test::IsOk());
    EXPECT_EQ(read->scans(), 20u);
  }
}

TEST(Mcap, BelievesNoLengthItCannotSee) {
  const McapFile plain = scan_records(3);
  for (const std::uint64_t claimed :
       {std::uint64_t{1} << 62, std::uint64_t{900'000'000}, std::uint64_t{plain.size() - 1}}) {
    const auto read = read_back(chunk(plain, "zstd", {0x28, 0xB5, 0x2F, 0xFD, 0}, claimed));
    ASSERT_THAT(read, test::IsOk());
    EXPECT_EQ(read->items.size(), 0u);
    EXPECT_EQ(read->dropped.size(), 1u);
  }
  EXPECT_THAT(read_back(chunk(plain, "brotli", plain, plain.size())), test::IsOk());
  EXPECT_THAT(read_back(plain), test::Fails(Errc::kCorrupt)) << "no magic";
}

}  // namespace
}  // namespace smokemap
