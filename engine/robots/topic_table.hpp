#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "robots/ros_qos.hpp"

namespace smokemap {

using DdsGuid = std::array<std::uint8_t, 16>;

/// A writer or reader on the network, as discovery told it.
struct Endpoint {
  std::string topic;  ///< DDS name, "rt/robot1/scan"
  std::string type;   ///< DDS name, "sensor_msgs::msg::dds_::LaserScan_"
  OfferedQos offer;   ///< of a writer
  DdsGuid participant{};
};

/// The topics of one robot. Empty: there is none.
struct RobotTopics {
  std::string robot;
  std::string scan;
  std::string odometry;
  std::string radar;
  std::string moving_transforms;              ///< tf; read only without odometry
  std::vector<std::string> fixed_transforms;  ///< tf_static: its own, then the one all robots share
  std::string velocity, goal;                 ///< what it subscribes
  bool stamped_velocity = false;
  std::string navigation;       ///< "fox/navigate_to_pose", where a server of that action is there
  bool headed_services = true;  ///< how its services look on the wire (ros_service.hpp)
  bool operator==(const RobotTopics&) const = default;
};

/// Who is on the network, and what follows from it. Pure bookkeeping: knows DDS only by what it is told.
class TopicTable {
 public:
  void add_writer(const DdsGuid& id, Endpoint endpoint) { writers_[id] = std::move(endpoint); }
  void add_reader(const DdsGuid& id, Endpoint endpoint) { readers_[id] = std::move(endpoint); }
  void remove(const DdsGuid& id) { writers_.erase(id), readers_.erase(id); }

  /// A robot is any first word of a namespace under which a laser scan is published. Of several scans the one called
  /// "scan", else the first by name; likewise for odometry. Where its namespace has no odometry (or no transforms), the
  /// topics without a namespace are taken, unless they are another robot's.
  std::vector<RobotTopics> robots() const;

  /// What the writers of this topic offer together: a reader must fit the weakest.
  OfferedQos offer(const std::string& topic) const;

  /// Has this participant a writer of this topic (still)?
  bool writes(const DdsGuid& participant, const std::string& topic) const;

 private:
  using Endpoints = std::map<DdsGuid, Endpoint>;
  static std::string choose(const Endpoints& endpoints, const std::string& robot, const char* type, const char* wanted,
                            bool only_wanted);
  void complete(RobotTopics& robot, const std::string& name_space) const;
  void find_navigation(RobotTopics& robot, const std::string& name_space) const;

  Endpoints writers_;
  Endpoints readers_;
};

}  // namespace smokemap
