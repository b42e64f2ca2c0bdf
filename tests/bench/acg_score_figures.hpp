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

/// Largest angle between a true wall of 1.5 m or more and where it truly leads.
double turned_deg(const DemoScenario& demo, const MergedMap& merged);

}  // namespace smokemap::bench
