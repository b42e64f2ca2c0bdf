#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "maps/frame_tree.hpp"
#include "recording/ros_messages.hpp"
#include "recording/sensor_log.hpp"

namespace smokemap {

/// Turns the messages of a bag, whatever its container, into a log. What depends on the whole bag (which topic is the
/// laser of which robot, where the laser sits) is decided at the end.
class RosLogBuilder {
 public:
  /// `type` as rosbag2 writes it, "sensor_msgs/msg/LaserScan". Types we have no use for are counted.
  void add(const std::string& topic, const std::string& type, std::span<const std::uint8_t> cdr);
  void warn(std::string text) { log_.warnings.push_back(std::move(text)); }
  void drop(const std::string& reason) { ++log_.dropped[reason]; }

  /// The log so far, in the order of `add`. The builder is used up.
  SensorLog finish(std::string format) &&;

 private:
  struct Record {
    int topic = 0;
    std::variant<RosScan, RosOdometry, RosRadar> message;
  };
  enum class Kind { kScan, kOdometry, kTransformOdometry, kRadar };
  struct Topic {
    std::string name;
    Kind kind = Kind::kScan;
    std::size_t messages = 0;
    std::string robot;
    bool used = false;
    std::string base_frame;  ///< of an odometry topic: the frame it moves
  };

  int topic_index(const std::string& name, Kind kind);
  void add_transforms(const std::string& topic, const std::vector<RosTransform>& transforms);
  void keep(int topic, std::variant<RosScan, RosOdometry, RosRadar> message);
  void choose_odometry();
  void choose_sensors(Kind kind);
  int best_odometry(const Topic& sensor) const;
  std::optional<SensorMount> find_mount(const std::string& robot, const std::string& base, const std::string& sensor);
  SensorMount mount_of(const std::string& robot, const std::string& sensor_frame);
  void emit(Record record);

  SensorLog log_;
  std::vector<Topic> topics_;
  std::vector<Record> records_;
  struct Frames {
    FrameTree fixed;          ///< tf_static
    FrameTree fixed_or_seen;  ///< also transforms on tf, as first seen, without odometry
  };
  std::map<std::string, Frames> frames_;  ///< by namespace of their topics; "" is shared by all robots
  std::map<std::string, SensorMount> mounts_;
  std::map<std::string, std::string> base_frames_;
};

}  // namespace smokemap
