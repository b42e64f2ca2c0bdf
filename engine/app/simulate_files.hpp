#pragma once

#include <string>

#include "simulation/recorded_run.hpp"

namespace smokemap::app {

/// Everything that is true about a run, for judging answers (docs/simulation.md). Map frame: origin at the first pose,
/// x forward.
std::string truth_json(const DemoScenario& demo, const RecordedRun& run);

/// Start pose on the plan as a person would give it; what `smokemap merge --anchors` reads.
std::string anchors_json(const DemoScenario& demo, const DemoParams& params);

/// Places on the plan, one a room; what `smokemap merge --points` reads.
std::string points_json(const DemoScenario& demo, const RecordedRun& run);

/// CARMEN log text: PARAM lines, then FLASER (with the wheel odometry at its stamp) and ODOM. A beam without an echo
/// reads the maximum range. No radar.
std::string carmen_log(const RecordedRun& run);

}  // namespace smokemap::app
