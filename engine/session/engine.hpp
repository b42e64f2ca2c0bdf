#pragma once

#include <functional>
#include <memory>

#include "core/result.hpp"
#include "core/time.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"
#include "session/commands.hpp"
#include "session/snapshot.hpp"

namespace smokemap {

/// The way back to robots: implemented over DDS, by the simulator and by test doubles. Called from the engine's thread;
/// must not block. The robot's side stops by itself when nothing comes for 0.5 s.
class RobotCommands {
 public:
  virtual ~RobotCommands() = default;
  virtual void drive(const std::string& robot, double speed_mps, double turn_rate_radps) = 0;
};

struct EngineParams {
  double tick_s = 0.1;            ///< robots are steered and snapshots made at most this often
  double merge_period_s = 1.0;    ///< the graph is solved at most this often
  double match_delay_s = 0.5;     ///< after the last stroke
  double stale_after_s = 1.0;     ///< robot's link
  double lost_after_s = 5.0;
  std::uint64_t seed = 1;
  Result<Ok> validate() const;
};

enum class Origin { kLive, kHistory };

/// The facade of everything that understands maps: commands and sensor data in, immutable snapshots out.
///
/// Thread-safe: any thread may call any member. Work happens on the engine's own threads behind queues; sensor queues
/// are bounded and drop the oldest (counted), commands never drop.
class Engine {
 public:
  using SnapshotListener = std::function<void(std::shared_ptr<const Snapshot>)>;

  Engine(const EngineParams& params, std::shared_ptr<const Clock> clock, std::shared_ptr<RobotCommands> robots);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Applies the command. Errors are about the command itself (unknown goal, no plan to place on): nothing changed then.
  /// @param origin kHistory while a stored log is replayed: goals do not start robots, and where a robot stood is not
  ///               believed any more
  Result<Ok> apply(const Command& command, Origin origin = Origin::kLive);

  void add_scan(const LaserScan& scan);
  void add_sweep(const RadarSweep& sweep);
  void add_odometry(const Odometry& odometry);

  std::shared_ptr<const Snapshot> snapshot() const;
  /// Called from the engine's thread for every new snapshot; must be quick.
  void on_snapshot(SnapshotListener listener);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokemap
