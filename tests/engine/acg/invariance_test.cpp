#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acg/auto_complete_graph.hpp"
#include "tests/support/merge_problem.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::IsOk;
using test::make_merge_problem;
using test::MergeProblem;
using test::MergeProblemParams;

MergeProblem a_few_rooms() {
  MergeProblemParams params;
  params.seed = 8;
  params.stretch = 0.06;
  params.max_stops = 4;
  return make_merge_problem(corridor_building(), params);
}

MergedMap merged_of(const MergeProblem& problem) {
  AutoCompleteGraph acg;
  EXPECT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  auto merged = acg.update(problem.graph);
  EXPECT_THAT(merged, IsOk());
  return std::move(*merged);
}

/// Largest distance between the corners of two answers, the second one's carried over by `T`.
double apart_m(const MergedMap& one, const MergedMap& other, const Pose2& T = {}) {
  EXPECT_EQ(one.corners.size(), other.corners.size());
  double worst = 0;
  for (std::size_t c = 0; c < one.corners.size(); ++c)
    worst = std::max(worst, (one.corners[c].p_map - T * other.corners[c].p_map).norm());
  return worst;
}

TEST(MergedPlan, MovesWithTheFrameInWhichSlamSpeaks) {
  const MergeProblem problem = a_few_rooms();
  MergeProblem elsewhere = problem;
  const Pose2 T(12, -7, 2.1);
  for (PoseNode& node : elsewhere.graph.nodes) node.T_map_robot = T * node.T_map_robot;
  EXPECT_LT(apart_m(merged_of(elsewhere), merged_of(problem), T), 0.05);
}

TEST(MergedPlan, IsTheSameWhateverTheResolutionOfTheSheet) {
  const MergeProblem problem = a_few_rooms();
  MergeProblem finer = problem;
  finer.plan.width_px *= 2, finer.plan.height_px *= 2;
  finer.plan.scale->metres_per_pixel /= 2;
  for (LayoutCorner& corner : finer.plan.corners) corner.p_px *= 2;
  for (LayoutWall& wall : finer.plan.walls) wall.thickness_px *= 2;
  EXPECT_LT(apart_m(merged_of(finer), merged_of(problem)), 0.02);
}

TEST(MergedPlan, IsTheSameWhicheverWayAWallIsDrawn) {
  const MergeProblem problem = a_few_rooms();
  MergeProblem turned = problem;
  for (std::size_t w = 0; w < turned.plan.walls.size(); w += 2)
    std::swap(turned.plan.walls[w].corner_a, turned.plan.walls[w].corner_b);
  const MergedMap one = merged_of(problem), other = merged_of(turned);
  EXPECT_LT(apart_m(one, other), 0.05);
  for (std::size_t w = 0; w < problem.plan.walls.size(); ++w) EXPECT_EQ(one.walls[w].state, other.walls[w].state) << w;
}

TEST(MergedPlan, IsTheSameInWhateverOrderItsWallsAreListed) {
  const MergeProblem problem = a_few_rooms();
  MergeProblem reversed = problem;
  std::reverse(reversed.plan.walls.begin(), reversed.plan.walls.end());
  EXPECT_LT(apart_m(merged_of(problem), merged_of(reversed)), 0.05);
}

TEST(MergedPlan, KeepsItsScoreAndSaysItsSigmasForEveryCorner) {
  const MergeProblem problem = a_few_rooms();
  const MergedMap merged = merged_of(problem);
  EXPECT_EQ(merged.fit.verdict, "fits") << merged.fit.score;
  for (const MergedCorner& corner : merged.corners) {
    EXPECT_TRUE(std::isfinite(corner.sigma_m));
    EXPECT_GT(corner.sigma_m, 0.005);
    EXPECT_LT(corner.sigma_m, 5.0);
  }
  for (const MergedWall& wall : merged.walls) {
    EXPECT_GE(wall.confidence, 0);
    EXPECT_LE(wall.confidence, 1);
  }
}

TEST(AnchorsTakenBack, LeaveNothingBehind) {
  const MergeProblem problem = a_few_rooms();
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  const auto before = acg.update(problem.graph);
  ASSERT_THAT(before, IsOk());
  // A place that lies half a metre beside, on a corner that was seen.
  const auto seen = std::find_if(before->corners.begin(), before->corners.end(), [](const auto& c) { return c.seen; });
  ASSERT_NE(seen, before->corners.end());
  acg.add_anchor("wrong", seen->p_layout_px, seen->p_map + Point2(0.5, 0));
  const auto with = acg.update(problem.graph);
  ASSERT_THAT(with, IsOk());
  ASSERT_EQ(with->anchors.size(), 1u);
  acg.remove_anchor("wrong");
  (void)acg.update(problem.graph);
  const auto after = acg.update(problem.graph);
  ASSERT_THAT(after, IsOk());
  EXPECT_TRUE(after->anchors.empty());
  std::vector<double> apart;
  for (std::size_t c = 0; c < after->corners.size(); ++c)
    if (after->corners[c].seen) apart.push_back((after->corners[c].p_map - before->corners[c].p_map).norm());
  std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2), apart.end());
  EXPECT_LT(apart[apart.size() / 2], 0.05);
}

}  // namespace
}  // namespace smokemap
