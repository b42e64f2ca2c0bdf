#pragma once

#include "acg/auto_complete_graph.hpp"
#include "maps/pose_graph.hpp"
#include "tests/bench/acg_figures.hpp"

namespace smokemap::bench {

/// What an answer is judged by.
struct AcgTruth {
  const DemoScenario& demo;
  const RecordedRun& run;
  const PoseGraph& graph;
  const PlanStart& start;
};

/// Everything but the times and the turn of walls.
void score_merged(const AcgTruth& truth, const MergedMap& merged, AcgScore& out);

/// Of the walls of 1.5 m or more that truly are there the one that leads farthest from both its true direction and
/// that in the drawing as this lies now.
TurnedWall most_turned(const DemoScenario& demo, const MergedMap& merged);

}  // namespace smokemap::bench
