#pragma once

#include <map>
#include <ostream>
#include <string>

#include "core/result.hpp"
#include "recording/mcap_writer.hpp"
#include "recording/sensor_log.hpp"

namespace smokemap {

/// Records sensor data as they come, in MCAP: /<robot>/scan, odom, tf, tf_static, radar (a robot called "robot" has no
/// namespace). The place of a sensor is written before its first message, and again when it changes.
///
/// The time of recording is the item's own stamp, made monotone: tools that sort by it keep our order.
class LogWriter {
 public:
  explicit LogWriter(std::ostream& out) : mcap_(out) {}

  void add(const LogItem& item);
  Result<Ok> finish() { return mcap_.finish(); }

 private:
  void write(const std::string& robot, const char* name, const char* type, Stamp stamp,
             std::span<const std::uint8_t> cdr);
  void write_mount(const std::string& robot, const char* frame, Stamp stamp, const Pose2& T_robot_sensor);
  void write_odometry(const Odometry& odometry);

  McapWriter mcap_;
  std::map<std::string, Pose2> mounts_;  ///< by robot and frame, as last written
  Stamp last_time_ = 0;
};

}  // namespace smokemap
