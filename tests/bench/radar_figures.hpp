#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/recorded_run.hpp"
#include "slam/slam.hpp"
#include "slam/trajectory_error.hpp"

namespace smokemap::bench {

enum class Use { kLidar, kRadar, kBoth };

/// One sensor through one run of the simulated twin of Paper VI's experiments: a truck in a hall, no odometry.
struct TwinFigures {
  std::string run;
  Use sensor = Use::kLidar;
  DisplacementError paper;  ///< the paper's own measure
  RelationError step;       ///< of the same steps, as it should be measured
  AbsoluteError whole;
  SlamCounters counters;
};

/// Three runs (there and back, another way, twice around with people about), lidar and radar of each.
std::vector<TwinFigures> paper_twin();

/// A tour through a few rooms of a random building and back to its start. Nothing when the seed gives no such run.
/// @param fire  false: no fire; for the radar, which does not see smoke, that is a building full of it
std::optional<RecordedRun> building_run(int seed, bool fire);

struct RunFigures {
  AbsoluteError whole;
  double end_m = -1;  ///< error of where the last scan was seen from the first one: what an open loop leaves
  SlamCounters counters;
};

/// One run with one sensor or both; the truth is that of the scans.
RunFigures judged(const RecordedRun& run, Use use);

}  // namespace smokemap::bench
