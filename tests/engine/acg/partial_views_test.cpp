#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "acg/auto_complete_graph.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/merge_problem.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::first_nodes;
using test::IsOk;
using test::MergeProblem;

MergeProblem partly_seen_problem(std::uint64_t seed) {
  auto random = random_stream(seed, 31);
  RandomBuildingParams building;
  building.length_m = 18;
  building.depth_m = 16;
  test::MergeProblemParams params;
  params.seed = seed;
  params.max_stops = 4;
  return test::make_merge_problem(*random_building(building, random), params);
}

double as_line_rad(double angle_rad) { return 0.5 * wrap_angle(2 * angle_rad); }

/// How far a wall lies outside all directions between its true one and that of the drawing as this lies now; the most
/// of all walls of 1.5 m or more.
double most_bent_deg(const MergeProblem& problem, const MergedMap& merged) {
  std::vector<double> by_drawing, by_truth;
  for (const MergedWall& w : merged.walls) {
    if (!w.layout_wall || !problem.wall_exists[static_cast<std::size_t>(*w.layout_wall)]) continue;
    if (w.segment_map.length() < 1.5) continue;
    const LayoutWall& wall = problem.plan.walls[static_cast<std::size_t>(*w.layout_wall)];
    const Segment2 truth{problem.true_corners[static_cast<std::size_t>(wall.corner_a)],
                         problem.true_corners[static_cast<std::size_t>(wall.corner_b)]};
    by_drawing.push_back(as_line_rad(w.segment_map.heading() - problem.plan.wall_m(*w.layout_wall).heading()));
    by_truth.push_back(as_line_rad(w.segment_map.heading() - truth.heading()));
  }
  if (by_drawing.empty()) return 180;
  // The start is a few degrees off, and with it the drawing: turns are counted from that of most walls.
  std::vector<double> sorted;
  for (const double turn : by_drawing) sorted.push_back(as_line_rad(turn - by_drawing.front()));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double plan_turn = by_drawing.front() + sorted[sorted.size() / 2];
  double worst = 0;
  for (std::size_t i = 0; i < by_drawing.size(); ++i) {
    const double drawn = as_line_rad(by_drawing[i] - plan_turn);
    if (drawn * by_truth[i] > 0) worst = std::max(worst, std::min(std::abs(drawn), std::abs(by_truth[i])));
  }
  return worst * 180 / kPi;
}

// The thesis' Fig. 3.4: a wall of which only a part had been seen was turned to fit that part.
TEST(PartialViews, BendNoWallWhileTheMapGrows) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const MergeProblem problem = partly_seen_problem(seed);
    AutoCompleteGraph acg;
    ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
    for (std::size_t n = 1; n <= problem.graph.nodes.size(); n += n < 20 ? 1 : 5) {
      const auto merged = acg.update(first_nodes(problem.graph, n));
      ASSERT_THAT(merged, IsOk());
      EXPECT_LT(most_bent_deg(problem, *merged), 2) << "seed " << seed << ", " << n << " nodes";
    }
  }
}

}  // namespace
}  // namespace smokemap
