#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"
#include "navigation/obstacle_watch.hpp"
#include "session/fleet.hpp"
#include "slam/slam.hpp"

namespace smokemap {

using SensorItem = std::variant<LaserScan, Odometry, RadarSweep>;

/// SLAM of every robot. The first robot heard makes the map; others are followed in frames of their own and are shown
/// as not localised. Runs on one thread; no other state.
class Mapper {
 public:
  /// @return what the fleet should know, if the item said something new
  std::optional<PoseReport> add(const SensorItem& item);
  /// Closes loops and solves; true when the graph changed since the last call.
  bool optimize(const Progress& progress = {});
  /// The map-making robot's graph, copied when it changed. Never null.
  std::shared_ptr<const PoseGraph> graph();
  const std::string& map_maker() const { return map_maker_; }

 private:
  struct Track {
    Slam slam;
    ObstacleWatch watch;
    Pose2 T_odom_robot;
    double speed_mps = 0;
  };
  Track& track_of(const std::string& robot);
  std::optional<PoseReport> report(const std::string& robot, Track& track, const Result<ScanOutcome>& outcome);

  std::map<std::string, Track> tracks_;
  std::string map_maker_;
  bool changed_ = false;
  std::shared_ptr<const PoseGraph> graph_ = std::make_shared<const PoseGraph>();
};

}  // namespace smokemap
