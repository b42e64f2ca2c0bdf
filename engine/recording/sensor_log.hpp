#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"

namespace smokemap {

using LogItem = std::variant<LaserScan, Odometry, RadarSweep>;

/// What robots said, in the order in which it was recorded. Stamps are the robots' own and may step back: process in
/// file order (sorting by stamp breaks the odometry of real logs).
struct SensorLog {
  std::string format;  ///< "carmen", "rosbag2" or "mcap"
  std::vector<LogItem> items;
  std::vector<std::string> warnings;           ///< for people, one line each: mount unknown, tail damaged, ...
  std::map<std::string, std::size_t> dropped;  ///< reason -> how many records were left out for it

  std::size_t scans() const { return count<LaserScan>(); }
  std::size_t odometry_readings() const { return count<Odometry>(); }
  std::size_t sweeps() const { return count<RadarSweep>(); }

 private:
  template <typename T>
  std::size_t count() const {
    std::size_t n = 0;
    for (const LogItem& item : items) n += std::holds_alternative<T>(item);
    return n;
  }
};

/// Reads a log whole. The format is chosen by the first bytes, not by the name:
///  - CARMEN text, plain or gzip (.log, .log.gz, .clf): see carmen_log.hpp;
///  - rosbag2 SQLite (.db3), every schema so far, and its folder (with metadata.yaml);
///  - MCAP, chunks plain, lz4 or zstd, with ROS 2 messages in CDR; a damaged tail costs only the tail.
///
/// Every scan passes check(scan); those that do not are counted in `dropped`. `robot` is the namespace of the topic,
/// "robot" where there is none. The pose of the sensor on the robot comes from the recorded fixed transforms; where
/// they are missing it is the robot's own, and a warning says so. A scan topic is chosen by type; of several for one
/// robot the one called "scan", else the fullest. Odometry comes from the odometry topic, else from the transform odom
/// -> base. kIo, kUnsupported (no format we know), kCorrupt, or kDegenerate when there is neither a scan nor a sweep
/// nor odometry.
Result<SensorLog> read_log(const std::filesystem::path& path);

/// Writes MCAP that other tools of ROS 2 open (log_writer.hpp). Reading it back gives the same items, angles and ranges
/// to float precision.
Result<Ok> write_log(const SensorLog& log, const std::filesystem::path& path);

}  // namespace smokemap
