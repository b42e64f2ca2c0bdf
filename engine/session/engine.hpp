#pragma once

#include <functional>
#include <memory>

#include "core/result.hpp"
#include "core/time.hpp"
#include "session/fleet.hpp"
#include "session/mapper.hpp"
#include "session/session_core.hpp"

namespace smokemap {

struct EngineParams {
  double tick_s = 0.1;             ///< robots are steered and snapshots made this often
  double merge_period_s = 1.0;     ///< the graph is solved at most this often
  double sketch_delay_s = 0.4;     ///< after the last stroke
  std::size_t sensor_queue = 256;  ///< items; the oldest are dropped and counted
  FleetParams fleet;
  Result<Ok> validate() const;
};

/// The facade of everything that understands maps: commands and sensor data in, immutable snapshots out.
///
/// Thread-safe: any thread may call any member. Four threads work behind it: sensing (SLAM), steering (ticks), merging
/// (the Auto-Complete Graph) and reading the sketch, and one a robot that closes loops. Sensor queues are bounded and
/// drop the oldest, commands never drop.
class Engine {
 public:
  using SnapshotListener = std::function<void(std::shared_ptr<const Snapshot>)>;

  Engine(const EngineParams& params, std::shared_ptr<const Clock> clock, std::shared_ptr<RobotCommands> robots);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Applies the command. Errors are about the command itself (unknown goal, no plan to place on): nothing changed
  /// then. An emergency stop reaches the robots before this returns.
  /// @param origin kHistory while a stored log is replayed: goals do not start robots, and where a robot stood is not
  ///               believed any more
  Result<Ok> apply(const Command& command, Origin origin = Origin::kLive);

  void add_scan(const LaserScan& scan);
  void add_sweep(const RadarSweep& sweep);
  void add_odometry(const Odometry& odometry);

  /// The pixel of the plan (layout_px) under a place on the map; nothing while no plan is aligned, or the plan does not
  /// fit.
  std::optional<Point2> place_on_plan(const Point2& p_map) const;

  /// The way that a robot would take to a place now, so that people see it before they send it. kNotFound for a robot
  /// unknown or never localised, kDegenerate with a reason for people where no way is known.
  /// Cost: O(cells of the map log cells), on the caller's thread.
  Result<Path> way(const std::string& robot, const Point2& p_map) const;

  /// The latest; never null.
  std::shared_ptr<const Snapshot> snapshot() const;
  /// Called from the steering thread for every new snapshot; must be quick. One listener; set before data comes in.
  void on_snapshot(SnapshotListener listener);
  /// Sensor items dropped because the queue was full.
  std::size_t dropped() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokemap
