#pragma once

#include <cstdint>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"

namespace smokemap {

/// Writes MCAP as ROS 2 records it (profile ros2, messages in CDR, schemas as ros2msg), so that Foxglove, `ros2 bag`
/// and the mcap tools open it: zstd chunks of about 768 KiB with sums, message and chunk indexes, statistics, summary.
///
/// Whole chunks go out as they fill: what is written when power fails can be read up to the last chunk.
class McapWriter {
 public:
  explicit McapWriter(std::ostream& out);
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// The channel of a topic; `type` as "sensor_msgs/msg/LaserScan", one of those ros_definition() knows.
  std::uint16_t channel(const std::string& topic, const std::string& type);

  /// Times before 1970 count as 0: the format has no others.
  void write(std::uint16_t channel, Stamp log_time, std::span<const std::uint8_t> cdr);

  /// Ends the chunk early, so that what was written so far leaves this process.
  void flush();

  /// Last chunk, indexes, end mark. Nothing may follow. kIo if any byte was not taken.
  Result<Ok> finish();

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Channel {
    std::uint16_t id = 0;
    std::uint16_t schema = 0;
    Bytes record;
    std::uint32_t messages = 0;
  };
  struct Index {
    std::uint64_t time = 0, offset = 0;
  };
  struct Chunk {
    std::uint64_t first_time = 0, last_time = 0;
    Bytes records;
    std::map<std::uint16_t, std::vector<Index>> index;
  };

  void put(const Bytes& bytes);
  void close_chunk();
  Bytes statistics() const;

  std::ostream& out_;
  std::uint64_t written_ = 0;
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::string, Channel> channels_;      ///< by topic
  std::map<std::uint16_t, std::string> topics_;  ///< by channel
  std::vector<Bytes> schema_records_, chunk_indexes_;
  Chunk chunk_;
  std::uint64_t messages_ = 0, first_time_ = 0, last_time_ = 0;
};

}  // namespace smokemap
