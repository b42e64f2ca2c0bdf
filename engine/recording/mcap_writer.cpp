#include "recording/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "core/bytes.hpp"
#include "core/expect.hpp"
#include "recording/mcap_format.hpp"
#include "recording/ros_definitions.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kChunkBytes = 768_KiB;
constexpr int kZstdLevel = 3;

/// One record in the making; the length is filled in at the end.
class McapRecord {
 public:
  explicit McapRecord(McapOp op) : bytes_{static_cast<std::uint8_t>(op), 0, 0, 0, 0, 0, 0, 0, 0} {}

  template <typename T>
  McapRecord& number(T value) {
    return raw(&value, sizeof value);
  }
  McapRecord& string(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    return raw(text.data(), text.size());
  }
  McapRecord& raw(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
    return *this;
  }
  McapRecord& raw(std::span<const std::uint8_t> bytes) { return raw(bytes.data(), bytes.size()); }

  std::vector<std::uint8_t> done() {
    const std::uint64_t length = bytes_.size() - 9;
    std::memcpy(bytes_.data() + 1, &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

std::uint32_t sum_of(std::span<const std::uint8_t> bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
}

std::vector<std::uint8_t> packed_zstd(std::span<const std::uint8_t> plain) {
  std::vector<std::uint8_t> packed(ZSTD_compressBound(plain.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), kZstdLevel);
  ENGINE_EXPECT(!ZSTD_isError(size));
  packed.resize(size);
  return packed;
}

void append(std::vector<std::uint8_t>& to, const std::vector<std::uint8_t>& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

}  // namespace

McapWriter::McapWriter(std::ostream& out) : out_(out) {
  put({kMcapMagic.begin(), kMcapMagic.end()});
  put(McapRecord(McapOp::kHeader).string("ros2").string("smokemap").done());
}

void McapWriter::put(const Bytes& bytes) {
  out_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  written_ += bytes.size();
}

std::uint16_t McapWriter::channel(const std::string& topic, const std::string& type) {
  if (const auto known = channels_.find(topic); known != channels_.end()) return known->second.id;
  const auto [schema, is_new] = schemas_.try_emplace(type, static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new) {
    schema_records_.push_back(McapRecord(McapOp::kSchema)
                                  .number(schema->second)
                                  .string(type)
                                  .string("ros2msg")
                                  .string(ros_definition(type))
                                  .done());
    append(chunk_.records, schema_records_.back());
  }
  Channel channel;
  channel.id = static_cast<std::uint16_t>(channels_.size());
  channel.schema = schema->second;
  channel.record = McapRecord(McapOp::kChannel)
                       .number(channel.id)
                       .number(channel.schema)
                       .string(topic)
                       .string("cdr")
                       .number(std::uint32_t{0})
                       .done();
  append(chunk_.records, channel.record);
  topics_[channel.id] = topic;
  return channels_.emplace(topic, std::move(channel)).first->second.id;
}

void McapWriter::write(std::uint16_t channel, Stamp log_time, std::span<const std::uint8_t> cdr) {
  ENGINE_EXPECT(topics_.contains(channel));
  const auto time = static_cast<std::uint64_t>(std::max<Stamp>(log_time, 0));
  std::uint32_t& sequence = channels_[topics_[channel]].messages;
  if (chunk_.index.empty()) chunk_.first_time = chunk_.last_time = time;
  if (messages_ == 0) first_time_ = last_time_ = time;
  chunk_.first_time = std::min(chunk_.first_time, time), chunk_.last_time = std::max(chunk_.last_time, time);
  first_time_ = std::min(first_time_, time), last_time_ = std::max(last_time_, time);
  chunk_.index[channel].push_back({time, chunk_.records.size()});
  append(chunk_.records,
         McapRecord(McapOp::kMessage).number(channel).number(sequence++).number(time).number(time).raw(cdr).done());
  ++messages_;
  if (chunk_.records.size() >= kChunkBytes) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  const Bytes packed = packed_zstd(chunk_.records);
  const auto plain_size = std::uint64_t{chunk_.records.size()};
  const std::uint64_t chunk_start = written_;
  put(McapRecord(McapOp::kChunk)
          .number(chunk_.first_time)
          .number(chunk_.last_time)
          .number(plain_size)
          .number(sum_of(chunk_.records))
          .string("zstd")
          .number(std::uint64_t{packed.size()})
          .raw(packed)
          .done());
  const std::uint64_t index_start = written_;
  Bytes offsets;  // of each channel's index: u16 channel, u64 offset
  for (const auto& [channel, entries] : chunk_.index) {
    const std::uint64_t offset = written_;
    offsets.insert(offsets.end(), reinterpret_cast<const std::uint8_t*>(&channel),
                   reinterpret_cast<const std::uint8_t*>(&channel + 1));
    offsets.insert(offsets.end(), reinterpret_cast<const std::uint8_t*>(&offset),
                   reinterpret_cast<const std::uint8_t*>(&offset + 1));
    McapRecord index(McapOp::kMessageIndex);
    index.number(channel).number(static_cast<std::uint32_t>(entries.size() * sizeof(Index)));
    for (const Index& entry : entries) index.number(entry.time).number(entry.offset);
    put(index.done());
  }
  chunk_indexes_.push_back(McapRecord(McapOp::kChunkIndex)
                               .number(chunk_.first_time)
                               .number(chunk_.last_time)
                               .number(chunk_start)
                               .number(index_start - chunk_start)
                               .number(static_cast<std::uint32_t>(offsets.size()))
                               .raw(offsets)
                               .number(written_ - index_start)
                               .string("zstd")
                               .number(std::uint64_t{packed.size()})
                               .number(plain_size)
                               .done());
  chunk_ = Chunk();
}

void McapWriter::flush() {
  close_chunk();
  out_.flush();
}

McapWriter::Bytes McapWriter::statistics() const {
  McapRecord record(McapOp::kStatistics);
  record.number(messages_)
      .number(static_cast<std::uint16_t>(schemas_.size()))
      .number(static_cast<std::uint32_t>(channels_.size()))
      .number(std::uint32_t{0})
      .number(std::uint32_t{0})
      .number(static_cast<std::uint32_t>(chunk_indexes_.size()))
      .number(first_time_)
      .number(last_time_)
      .number(static_cast<std::uint32_t>(channels_.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))));
  for (const auto& [id, topic] : topics_) record.number(id).number(std::uint64_t{channels_.at(topic).messages});
  return record.done();
}

Result<Ok> McapWriter::finish() {
  close_chunk();
  put(McapRecord(McapOp::kDataEnd).number(std::uint32_t{0}).done());
  const std::uint64_t summary_start = written_;
  Bytes summary, offsets;
  const auto group = [&](McapOp op, const std::vector<Bytes>& records) {
    const std::uint64_t start = summary_start + summary.size();
    for (const Bytes& record : records) append(summary, record);
    const std::uint64_t length = summary_start + summary.size() - start;
    if (length > 0) append(offsets, McapRecord(McapOp::kSummaryOffset).number(op).number(start).number(length).done());
  };
  std::vector<Bytes> channel_records;
  for (const auto& [id, topic] : topics_) channel_records.push_back(channels_.at(topic).record);
  group(McapOp::kSchema, schema_records_);
  group(McapOp::kChannel, channel_records);
  group(McapOp::kStatistics, {statistics()});
  group(McapOp::kChunkIndex, chunk_indexes_);
  const std::uint64_t offsets_start = summary_start + summary.size();
  append(summary, offsets);
  // The sum covers the summary and the footer up to itself.
  Bytes footer =
      McapRecord(McapOp::kFooter).number(summary_start).number(offsets_start).number(std::uint32_t{0}).done();
  const std::uint32_t sum = sum_of({footer.data(), footer.size() - sizeof(std::uint32_t)}, sum_of(summary));
  std::memcpy(footer.data() + footer.size() - sizeof sum, &sum, sizeof sum);
  put(summary);
  put(footer);
  put({kMcapMagic.begin(), kMcapMagic.end()});
  out_.flush();
  if (!out_) return fail(Errc::kIo, "the recording could not be written");
  return Ok{};
}

}  // namespace smokemap
