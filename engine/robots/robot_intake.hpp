#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "core/time.hpp"
#include "maps/frame_tree.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"
#include "robots/gateway.hpp"

namespace smokemap {

/// What happens to one robot's data between the wire and the engine: sensors get their place on the robot, faulty
/// messages are counted and left out. No DDS in here.
class RobotIntake {
 public:
  using Alarm = std::function<void(const std::string& id, const std::string& text)>;

  RobotIntake(std::string robot, const GatewayParams& params, const RobotGateway::Callbacks& callbacks, Alarm alarm);

  void scan(LaserScan scan, const std::string& frame, Stamp now);
  void sweep(RadarSweep sweep, const std::string& frame, Stamp now);
  void odometry(Odometry odometry, const std::string& odom_frame, const std::string& base_frame, Stamp now);
  void drop(const std::string& reason) { ++link_.dropped[reason]; }

  FrameTree& own_frames() { return own_frames_; }
  /// Transforms arrived: sensors that waited for their place may have it now.
  void frames_changed(const FrameTree& shared, Stamp now);
  /// Gives up on what has waited too long.
  void tick(Stamp now);

  /// Counts so far. How fresh it is, is for whoever asks to say.
  const RobotLink& link() const { return link_; }

 private:
  struct Waiting {
    std::variant<LaserScan, RadarSweep> data;
    std::string frame;
    Stamp since = 0;
  };
  std::optional<SensorMount> mount(const std::string& frame) const;
  bool deliver(Waiting& waiting);
  void place_or_wait(Waiting waiting);

  std::string robot_;
  const GatewayParams& params_;
  const RobotGateway::Callbacks& callbacks_;
  Alarm alarm_;
  RobotLink link_;
  FrameTree own_frames_;
  FrameTree shared_frames_;
  std::string base_frame_;
  std::deque<Waiting> waiting_;
};

}  // namespace smokemap
