#pragma once

#include <map>
#include <optional>
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
  /// The same, recorded at `now` of the clock of whoever records: robots' clocks may differ from it.
  void add(const LogItem& item, Stamp now);
  /// /<robot>/goal_pose in frame map.
  void add_goal(const std::string& robot, const Pose2& T_map_goal, Stamp now);
  /// A line of text on /smokemap/events.
  void add_event(const std::string& text, Stamp now);
  /// What was added so far is on its way to the disk.
  void flush() { mcap_.flush(); }
  Result<Ok> finish() { return mcap_.finish(); }

 private:
  void write(const std::string& robot, const char* name, const char* type, Stamp stamp,
             std::span<const std::uint8_t> cdr);
  void write_mount(const std::string& robot, const char* frame, Stamp stamp, const Pose2& T_robot_sensor);
  void write_odometry(const Odometry& odometry);

  McapWriter mcap_;
  std::map<std::string, Pose2> mounts_;  ///< by robot and frame, as last written
  std::optional<Stamp> heard_at_;        ///< of the item that is being written; none: its own stamp
  Stamp last_time_ = 0;
};

}  // namespace smokemap
