#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grids/occupancy_grid.hpp"
#include "maps/layout_map.hpp"
#include "session/mapper.hpp"
#include "session/session_core.hpp"
#include "simulation/demo_scenario.hpp"

namespace smokemap::test {

struct MissionParams {
  double explore_s = 20;            ///< before the goal is given
  double limit_s = 300;             ///< simulated
  bool smoke_spreads = false;       ///< as in the demo that is served; false: it stays as it is
  std::optional<LayoutMap> layout;  ///< as some reader gave it; none = what a perfect reader would give
  std::function<void(const SessionCore&, double t_s)> every_second;
};

/// The robot touched something.
struct Bump {
  double time_s = 0;
  Pose2 T_world_robot;
};

struct MissionResult {
  GoalState goal = GoalState::kQueued;
  std::string reason;
  double goal_error_m = 0;         ///< of the robot's true place when the goal ended
  double time_s = 0;               ///< simulated, until the goal ended
  double before_median_m = 0;      ///< plan corners of true walls: the plan laid down at the start
  double after_median_m = 0;       ///< the same after merging
  double after_seen_median_m = 0;  ///< only corners that were seen
  int seen = 0, corners = 0;
  int bumps = 0;
  std::vector<Bump> bumped;
  double pose_error_m = 0;  ///< of the robot on the map, at the end
  double pose_sigma_m = 0;  ///< that it says to have there
  std::shared_ptr<const MergedMap> merged;
  std::shared_ptr<const OccupancyGrid> sensed;
  std::vector<Point2> way_world;  ///< where the robot truly was, twice a second
  SmokeField smoke;               ///< at the end
};

/// The demo without threads, network or browser, in simulated time: the robot explores, then a goal on the plan in a
/// room that it never saw. The same seed gives the same result.
MissionResult run_mission(const DemoScenario& demo, const MissionParams& params);

}  // namespace smokemap::test
