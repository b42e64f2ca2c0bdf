#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/pose_graph.hpp"
#include "maps/radar_sweep.hpp"
#include "slam/front_end.hpp"
#include "slam/graph_worker.hpp"
#include "slam/slam_params.hpp"

namespace smokemap {

const char* to_string(ScanFate fate);

struct ScanOutcome {
  Stamp stamp = 0;
  ScanFate fate = ScanFate::kMatched;
  StampedPose pose;         ///< in map, with covariance since the last node
  std::optional<int> node;  ///< id of the graph node that was kept for this scan
  double score = 0;         ///< share of points that found their wall, 0 .. 1
};

struct SlamCounters {
  std::int64_t scans = 0;
  std::int64_t sweeps = 0;
  std::int64_t odometry = 0;
  std::int64_t malformed = 0;  ///< rejected by check()
  std::int64_t duplicates = 0;
  std::int64_t too_few_points = 0;
  std::int64_t poor_matches = 0;
  std::int64_t stamps_back = 0;       ///< scans stamped before the scan before them (still used)
  std::int64_t jumps = 0;             ///< odometry jumped farther than a robot can drive; bridged by the match
  std::int64_t without_odometry = 0;  ///< predicted from the last velocity
  std::int64_t lost = 0;              ///< new pieces of map begun because nothing fitted for a while
  std::int64_t smoke_beams = 0;       ///< lidar echoes the radar saw through
  std::int64_t walker_beams = 0;      ///< of people who walk: where they stand was seen free a little before
  double smoke_share = 0;             ///< newest estimate: of walls the radar sees, those the lidar does not
  std::int64_t relocated = 0;         ///< new pieces that were found again in the map, wherever it was
  std::int64_t loops_tried = 0;
  std::int64_t loops_closed = 0;
  std::int64_t loops_rejected = 0;  ///< found, then refused by verification or by the robust solve
};

/// SLAM of one robot: scans, sweeps and odometry in, poses and a pose graph out. Frames: map = pose of the first scan
/// (x forward) unless params.T_map_start says otherwise.
///
/// Online and incremental: `add_scan` costs a bounded few milliseconds and never waits for the graph. Loops are closed
/// and the graph is solved by a back end: when `optimize` is called (offline, or where the caller owns a thread for
/// it), or in the background on a thread of its own, where `optimize` only takes over what is ready. Nodes are worked
/// off in their order whoever does it, so that after `polish` both give the same bytes, however fast the log was
/// played. To be called from one thread. Method: thresholds from the prediction's own errors (KISS-ICP), point-to-line
/// Gauss-Newton on oriented surface points for both sensors (CFEAR for radar), branch-and-bound loop search, robust
/// pose graph, pairwise re-matching.
class Slam {
 public:
  explicit Slam(const SlamParams& params = {}, GraphWork work = GraphWork::kWhenAsked);
  ~Slam();
  Slam(Slam&&) noexcept;
  Slam& operator=(Slam&&) noexcept;

  void add_odometry(const Odometry& odometry);
  /// Fails only for what check(scan) refuses; the trajectory then keeps its length.
  Result<ScanOutcome> add_scan(const LaserScan& scan);
  /// The same for a radar turn. While lidar scans come too, the sweep shows which of their echoes are smoke, and its
  /// own points join the next scan, the more the thicker the smoke is. Before the first scan, and two seconds after the
  /// last, the radar carries the robot alone; each sensor is matched by its own parameters.
  Result<ScanOutcome> add_sweep(const RadarSweep& sweep);

  /// Takes over the newest node poses and loops. Without a background, searches and solves for the nodes not worked off
  /// yet first. Cheap when nothing is new.
  /// @return true when node poses changed
  bool optimize(const Progress& progress = {});
  /// Re-matches every node against its neighbours and solves, a few rounds. For the end of a log or for idle time;
  /// waits for the background to catch up.
  void polish(const Progress& progress = {});

  StampedPose latest_pose() const;  ///< in map; covariance since the last node
  Pose2 T_map_odom() const;         ///< identity without odometry
  const PoseGraph& graph() const;
  /// One pose per accepted scan (in radar-only use: per sweep), in order of arrival, by the newest node poses.
  Trajectory trajectory() const;
  const SlamCounters& counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokemap
