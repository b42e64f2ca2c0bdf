#include <gtest/gtest.h>

#include <algorithm>

#include "acg/auto_complete_graph.hpp"
#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/merge_problem.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::first_nodes;
using test::IsOk;
using test::make_merge_problem;
using test::MergeProblem;
using test::MergeProblemParams;

FloorPlan small_building(std::uint64_t seed) {
  auto random = random_stream(seed, 3);
  RandomBuildingParams params;
  params.length_m = 18;
  params.depth_m = 16;
  return *random_building(params, random);
}

MergeProblem problem_in(std::uint64_t seed, std::size_t stops) {
  MergeProblemParams params;
  params.seed = seed;
  params.stretch = 0.05;
  params.max_stops = stops;
  return make_merge_problem(small_building(seed), params);
}

double seen_median_m(const MergeProblem& problem, const MergedMap& merged) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < merged.corners.size(); ++i)
    if (merged.corners[i].seen) errors.push_back((merged.corners[i].p_map - problem.true_corners[i]).norm());
  if (errors.empty()) return 1e9;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

TEST(StartWithoutAnyHint, IsFoundRightOrNotClaimed) {
  int found = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const MergeProblem problem = problem_in(seed, 7);
    AutoCompleteGraph acg;
    ASSERT_THAT(acg.set_plan(problem.plan), IsOk());
    const auto merged = acg.update(problem.graph);
    ASSERT_THAT(merged, IsOk());
    if (merged->corners.empty()) continue;
    ++found;
    EXPECT_LT(seen_median_m(problem, *merged), 0.15) << "seed " << seed;
  }
  EXPECT_GE(found, 2);
}

TEST(StartWithoutAnyHint, IsNotClaimedInAnotherBuilding) {
  const MergeProblem problem = problem_in(1, 5), other = problem_in(4, 2);
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(other.plan), IsOk());
  const auto merged = acg.update(problem.graph);
  ASSERT_THAT(merged, IsOk());
  EXPECT_TRUE(merged->corners.empty() || merged->fit.verdict == "does not fit") << merged->fit.verdict;
}

TEST(StartAfterTheFirstGlance, IsPutRightWhenMoreIsSeen) {
  // A hint a metre off, and the plan laid down when the robot has seen but one view of a corridor.
  MergeProblemParams params;
  params.seed = 5;
  params.stretch = 0.05;
  params.start_error_m = 0.9;
  params.max_stops = 5;
  const MergeProblem problem = make_merge_problem(corridor_building(), params);
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  std::optional<MergedMap> last;
  for (std::size_t n = 1; n < problem.graph.nodes.size() + 6; n += 6) {
    auto merged = acg.update(first_nodes(problem.graph, n));
    ASSERT_THAT(merged, IsOk());
    last = std::move(*merged);
  }
  EXPECT_LT(seen_median_m(problem, *last), 0.15);
}

TEST(PlanFit, IsAFitForTheRightPlanOnly) {
  for (const std::uint64_t seed : {1, 2}) {
    const MergeProblem problem = problem_in(seed, 6), other = problem_in(seed + 5, 2);
    AutoCompleteGraph right, wrong;
    ASSERT_THAT(right.set_plan(problem.plan, problem.start), IsOk());
    ASSERT_THAT(wrong.set_plan(other.plan, other.start), IsOk());
    const auto fits = right.update(problem.graph), fails = wrong.update(problem.graph);
    ASSERT_THAT(fits, IsOk());
    ASSERT_THAT(fails, IsOk());
    EXPECT_EQ(fits->fit.verdict, "fits") << fits->fit.score;
    EXPECT_NE(fails->fit.verdict, "fits") << fails->fit.score;
    EXPECT_LT(fails->fit.score, fits->fit.score - 0.2);
  }
}

}  // namespace
}  // namespace smokemap
