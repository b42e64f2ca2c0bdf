#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "maps/odometry.hpp"
#include "simulation/demo_scenario.hpp"
#include "simulation/path_driver.hpp"
#include "simulation/wall_witness.hpp"

namespace smokemap {

struct RunParams {
  double max_duration_s = 1200;   ///< the run ends here, or when the last place was visited
  std::vector<Point2> waypoints;  ///< world; empty = a tour of all rooms
  bool with_radar = true;
  bool skew = true;  ///< false: every scan is taken in one moment
  int robots = 1;    ///< that share the places; 1..kMostRobots
  bool smoke_spreads = false;
  Result<Ok> validate() const;
};

/// What the robots sent during a whole run, in time order, with the truth beside it.
struct RecordedRun {
  std::vector<std::variant<LaserScan, Odometry, RadarSweep>> items;
  Trajectory truth;  ///< of the first robot; map (origin: its first pose); one entry a scan, at its stamp
  std::map<std::string, Trajectory> others;  ///< the same of the other robots, in the same map
  std::vector<Pose2> T_odom_scan;            ///< wheel odometry at the same moments
  std::vector<Segment2> unplanned;           ///< pieces of true walls that the plan lacks; world
  WallWitness witness{{}};                   ///< of the walls of the perfect reader's layout, then of `unplanned`
  int bumps = 0;                             ///< of all, as is the way
  double way_m = 0;
  double duration_s = 0;
  std::size_t places = 0;     ///< that could be reached
  std::vector<bool> visited;  ///< per room of the building: the centre of a robot was in it
};

/// Drives the demo's robots along ways only the simulator can know: they share out the places, and of two that meet
/// the one with the higher number waits. kInvalidArgument, or kDegenerate if no place can be reached.
Result<RecordedRun> record_run(const DemoScenario& demo, const RunParams& params = {});

}  // namespace smokemap
