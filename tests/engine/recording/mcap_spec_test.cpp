// What we write, read by a second reader made from the format's description alone (mcap.dev/spec): it shares no code
// with ours, follows every offset, checks every sum and count. What holds here is what other tools rely on.
#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "recording/log_writer.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using SpecBytes = std::string;

/// Little-endian fields one after another; reading past the end fails the test.
class SpecFields {
 public:
  explicit SpecFields(SpecBytes bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(take(1)[0])) << (8 * i);
    return value;
  }
  SpecBytes text() { return take(number(4)); }
  SpecBytes take(std::size_t size) {
    EXPECT_LE(at_ + size, bytes_.size());
    SpecBytes part = at_ + size <= bytes_.size() ? bytes_.substr(at_, size) : SpecBytes(size, '\0');
    at_ += size;
    return part;
  }
  std::size_t at() const { return at_; }
  bool done() const { return at_ >= bytes_.size(); }

 private:
  SpecBytes bytes_;
  std::size_t at_ = 0;
};

struct SpecRecord {
  int op = 0;
  std::size_t start = 0, end = 0;
  SpecBytes body;
};

SpecRecord record_at(const SpecBytes& file, std::size_t at) {
  SpecFields fields(file.substr(at));
  SpecRecord record;
  record.op = static_cast<int>(fields.number(1));
  const std::size_t length = fields.number(8);
  EXPECT_LE(at + 9 + length, file.size());
  record.body = file.substr(at + 9, length);
  record.start = at;
  record.end = at + 9 + length;
  return record;
}

std::uint32_t crc_of(const SpecBytes& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

struct SpecChunk {
  std::uint64_t first = 0, last = 0;
  SpecBytes records;
  std::size_t packed_size = 0;
};

SpecChunk chunk_of(const SpecRecord& record) {
  EXPECT_EQ(record.op, 0x06);
  SpecFields fields(record.body);
  SpecChunk chunk;
  chunk.first = fields.number(8);
  chunk.last = fields.number(8);
  const std::size_t plain_size = fields.number(8);
  const auto sum = static_cast<std::uint32_t>(fields.number(4));
  EXPECT_EQ(fields.text(), "zstd");
  chunk.packed_size = fields.number(8);
  const SpecBytes packed = fields.take(chunk.packed_size);
  EXPECT_TRUE(fields.done());
  chunk.records.resize(plain_size);
  EXPECT_EQ(ZSTD_decompress(chunk.records.data(), plain_size, packed.data(), packed.size()), plain_size);
  EXPECT_EQ(crc_of(chunk.records), sum);
  return chunk;
}

/// Items of all kinds, enough for several chunks; a clock that steps back now and then.
SpecBytes recording(int items) {
  std::ostringstream out;
  LogWriter writer(out);
  for (int i = 0; i < items; ++i) {
    const Stamp stamp = 1'600'000'000'000'000'000 + (i - (i % 7 == 3 ? 2 : 0)) * 50'000'000LL;
    if (i % 3 == 0) {
      LaserScan scan{stamp, i % 2 ? "robot" : "fox", -1.5, 0.01, 0, 0.1, 12, {}, {}, Pose2(0.2, 0, 0.1)};
      for (int b = 0; b < 300; ++b) scan.ranges_m.push_back(static_cast<float>((i * 7919 + b * 104729) % 1200) * 0.01F);
      writer.add(scan);
    } else if (i % 3 == 1) {
      writer.add(Odometry{stamp, "robot", Pose2(0.1 * i, 0, 0), 0.5, 0});
    } else {
      RadarSweep sweep{stamp, 0.4, "fox", 0, 0.1, 0.5, 0.05, 20, 100, std::vector<float>(2000), {}};
      for (int b = 0; b < 2000; ++b)
        sweep.power[static_cast<std::size_t>(b)] = static_cast<float>((i * 31 + b * 7907) % 9973);
      writer.add(sweep);
    }
  }
  EXPECT_THAT(writer.finish(), test::IsOk());
  return out.str();
}

/// Footer, summary and what they point at.
struct SpecSummary {
  std::size_t start = 0, offsets_start = 0, end = 0;
  std::map<std::uint64_t, SpecBytes> schema_names, channel_topics;
  std::map<std::uint64_t, std::uint64_t> channel_schemas, messages_by_channel;
  std::vector<SpecRecord> chunk_indexes;
  std::uint64_t messages = 0, first_time = 0, last_time = 0, chunks = 0;
};

SpecSummary summary_of(const SpecBytes& file) {
  const SpecBytes magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(file.substr(0, 8), magic);
  EXPECT_EQ(file.substr(file.size() - 8), magic);
  SpecSummary summary;
  const std::size_t footer_at = file.size() - 8 - 9 - 20;
  const SpecRecord footer = record_at(file, footer_at);
  EXPECT_EQ(footer.op, 0x02);
  SpecFields fields(footer.body);
  summary.start = fields.number(8);
  summary.offsets_start = fields.number(8);
  summary.end = footer_at;
  EXPECT_EQ(crc_of(file.substr(summary.start, footer_at + 9 + 16 - summary.start)), fields.number(4));
  for (std::size_t at = summary.start; at < summary.offsets_start;) {
    const SpecRecord record = record_at(file, at);
    SpecFields body(record.body);
    at = record.end;
    if (record.op == 0x03) {
      const std::uint64_t id = body.number(2);
      EXPECT_NE(id, 0u) << "0 means no schema";
      summary.schema_names[id] = body.text();
      EXPECT_EQ(body.text(), "ros2msg");
      EXPECT_GT(body.text().size(), 10u) << "tools show messages by these definitions";
    } else if (record.op == 0x04) {
      const std::uint64_t id = body.number(2);
      summary.channel_schemas[id] = body.number(2);
      summary.channel_topics[id] = body.text();
      EXPECT_EQ(body.text(), "cdr");
    } else if (record.op == 0x08) {
      summary.chunk_indexes.push_back(record);
    } else if (record.op == 0x0B) {
      summary.messages = body.number(8);
      EXPECT_EQ(body.number(2), summary.schema_names.size());
      EXPECT_EQ(body.number(4), summary.channel_topics.size());
      EXPECT_EQ(body.number(4), 0u);
      EXPECT_EQ(body.number(4), 0u);
      summary.chunks = body.number(4);
      summary.first_time = body.number(8);
      summary.last_time = body.number(8);
      for (std::size_t end = body.number(4) + body.at(); body.at() < end;) {
        const std::uint64_t channel = body.number(2);
        summary.messages_by_channel[channel] = body.number(8);
      }
    } else {
      ADD_FAILURE() << "record " << record.op << " in the summary";
    }
  }
  return summary;
}

TEST(McapSpec, TheSummaryHasItsSumAndItsOffsetsPointAtGroupsOfOneKind) {
  const SpecBytes file = recording(900);
  const SpecSummary summary = summary_of(file);
  std::size_t covered = summary.start;
  for (std::size_t at = summary.offsets_start; at < summary.end;) {
    const SpecRecord record = record_at(file, at);
    ASSERT_EQ(record.op, 0x0E);
    SpecFields body(record.body);
    const int kind = static_cast<int>(body.number(1));
    const std::size_t start = body.number(8), end = start + body.number(8);
    EXPECT_EQ(start, covered);
    for (std::size_t inside = start; inside < end;) {
      const SpecRecord one = record_at(file, inside);
      EXPECT_EQ(one.op, kind);
      inside = one.end;
    }
    covered = end;
    at = record.end;
  }
  EXPECT_EQ(covered, summary.offsets_start);
  for (const auto& [channel, schema] : summary.channel_schemas) EXPECT_TRUE(summary.schema_names.contains(schema));
}

TEST(McapSpec, EveryIndexPointsAtItsMessageAndTheCountsAreRight) {
  const SpecBytes file = recording(900);
  const SpecSummary summary = summary_of(file);
  EXPECT_GT(summary.chunk_indexes.size(), 2u);
  EXPECT_EQ(summary.chunk_indexes.size(), summary.chunks);
  std::map<std::uint64_t, std::uint64_t> counted;
  std::uint64_t first = ~std::uint64_t{0}, last = 0;
  for (const SpecRecord& record : summary.chunk_indexes) {
    SpecFields index(record.body);
    const std::uint64_t first_time = index.number(8), last_time = index.number(8);
    const std::size_t chunk_at = index.number(8), chunk_length = index.number(8);
    const SpecRecord chunk_record = record_at(file, chunk_at);
    EXPECT_EQ(chunk_record.end - chunk_at, chunk_length);
    const SpecChunk chunk = chunk_of(chunk_record);
    EXPECT_EQ(std::pair(chunk.first, chunk.last), std::pair(first_time, last_time));
    std::map<std::uint64_t, std::size_t> offsets;
    for (std::size_t end = index.number(4) + index.at(); index.at() < end;) {
      const std::uint64_t channel = index.number(2);
      offsets[channel] = index.number(8);
    }
    const std::size_t indexes_length = index.number(8);
    EXPECT_EQ(index.text(), "zstd");
    EXPECT_EQ(index.number(8), chunk.packed_size);
    EXPECT_EQ(index.number(8), chunk.records.size());
    std::size_t indexes_end = chunk_record.end;
    for (const auto& [channel, offset] : offsets) {
      const SpecRecord messages = record_at(file, offset);
      EXPECT_EQ(messages.op, 0x07);
      indexes_end = std::max(indexes_end, messages.end);
      SpecFields entries(messages.body);
      EXPECT_EQ(entries.number(2), channel);
      for (std::size_t end = entries.number(4) + entries.at(); entries.at() < end;) {
        const std::uint64_t time = entries.number(8);
        const SpecRecord message = record_at(chunk.records, entries.number(8));
        ASSERT_EQ(message.op, 0x05);
        SpecFields body(message.body);
        EXPECT_EQ(body.number(2), channel);
        EXPECT_EQ(body.number(4), counted[channel]++) << "sequence";
        EXPECT_EQ(body.number(8), time);
        EXPECT_GE(time, first_time);
        EXPECT_LE(time, last_time);
        first = std::min(first, time);
        last = std::max(last, time);
        EXPECT_EQ(message.body.substr(22, 4), SpecBytes("\0\1\0\0", 4)) << "little-endian CDR";
      }
    }
    EXPECT_EQ(indexes_end - chunk_record.end, indexes_length);
  }
  EXPECT_EQ(counted, summary.messages_by_channel);
  std::uint64_t all = 0;
  for (const auto& [channel, count] : counted) all += count;
  EXPECT_EQ(all, summary.messages);
  EXPECT_EQ(std::pair(first, last), std::pair(summary.first_time, summary.last_time));
}

TEST(McapSpec, AReaderFromFrontToBackMeetsEachChannelBeforeItsMessages) {
  const SpecBytes file = recording(300);
  std::map<std::uint64_t, std::uint64_t> schema_of;
  std::map<std::uint64_t, bool> schemas;
  bool ended = false;
  std::uint64_t last_time = 0;
  for (std::size_t at = 8; at < file.size() - 8 && !ended;) {
    const SpecRecord record = record_at(file, at);
    at = record.end;
    ended = record.op == 0x0F;
    if (record.op != 0x06) continue;
    const SpecChunk chunk = chunk_of(record);
    for (std::size_t inside = 0; inside < chunk.records.size();) {
      const SpecRecord one = record_at(chunk.records, inside);
      inside = one.end;
      SpecFields body(one.body);
      const std::uint64_t id = body.number(2);
      if (one.op == 0x03) schemas[id] = true;
      if (one.op == 0x04) {
        schema_of[id] = body.number(2);
        EXPECT_TRUE(schemas.contains(schema_of[id]));
      }
      if (one.op != 0x05) continue;
      EXPECT_TRUE(schema_of.contains(id));
      (void)body.number(4);
      const std::uint64_t time = body.number(8);
      EXPECT_GE(time, last_time) << "times of recording never step back";
      last_time = time;
    }
  }
  EXPECT_TRUE(ended);
  EXPECT_GE(schema_of.size(), 4u);
}

}  // namespace
}  // namespace smokemap
