#include "acg/published_graph.hpp"

#include <gtest/gtest.h>

#include "acg/residuals/drawn_vector_cost.hpp"
#include "core/random.hpp"
#include "tests/engine/acg/residuals/residual_check.hpp"
#include "tests/support/merge_problem.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

PublishedInput published_input(const test::MergeProblem& problem) {
  PublishedInput input;
  input.plan = problem.plan;
  input.map_from_layout = Similarity2{1, problem.start.T_layout_robot.inverse()};
  input.graph = problem.graph;
  for (const Pose2& pose : problem.true_poses)
    input.localized.push_back(LocalizedNode{pose, 0.01 * Eigen::Matrix2d::Identity()});
  return input;
}

double largest_move_m(const MergedMap& merged, const PublishedInput& input) {
  const PixelFrame frame = input.plan.frame();
  double largest = 0;
  for (const MergedCorner& c : merged.corners)
    largest = std::max(largest, (c.p_map - input.map_from_layout * frame.to_metres(c.p_layout_px)).norm());
  return largest;
}

TEST(PublishedGraph, LeavesARightPlanWhereItIs) {
  test::MergeProblemParams right;
  right.stretch = 1e-6;
  right.start_error_m = right.start_error_rad = 0;
  const test::MergeProblem problem = test::make_merge_problem(corridor_building(), right);
  const PublishedInput input = published_input(problem);
  const auto merged = merge_as_published(PublishedMethod::kAcg2019, input);
  ASSERT_THAT(merged, IsOk());
  EXPECT_LT(largest_move_m(*merged, input), 0.4);
  EXPECT_EQ(merged->trajectory.size(), problem.graph.nodes.size());
  EXPECT_FALSE(merged->links.empty());
}

TEST(PublishedGraph, Of2017HoldsTheRobotsMapAndLinksWhateverIsNear) {
  const test::MergeProblem problem = test::make_merge_problem(corridor_building(), {});
  const PublishedInput input = published_input(problem);
  const auto merged = merge_as_published(PublishedMethod::kAcg2017, input);
  ASSERT_THAT(merged, IsOk());
  for (std::size_t i = 0; i < problem.graph.nodes.size(); ++i)
    EXPECT_LT(
        (merged->trajectory[i].T_map_robot.translation() - problem.graph.nodes[i].T_map_robot.translation()).norm(),
        1e-9);
  std::size_t wrong = 0;
  for (const MapLink& l : merged->links)
    wrong += (l.p_map - problem.true_corners[static_cast<std::size_t>(l.layout_corner)]).norm() > 0.5;
  EXPECT_GT(4 * wrong, merged->links.size());  // a plan 10 % stretched is enough for that
}

TEST(PublishedGraph, Of2019LinksNothingThatIsNotLocalised) {
  PublishedInput input = published_input(test::make_merge_problem(corridor_building(), {}));
  input.localized.clear();
  const auto merged = merge_as_published(PublishedMethod::kAcg2019, input);
  ASSERT_THAT(merged, IsOk());
  EXPECT_TRUE(merged->links.empty());
  EXPECT_LT(largest_move_m(*merged, input), 1e-6);
}

TEST(PublishedGraph, RefusesAPlanWithoutWallsAndARunWithoutNodes) {
  PublishedInput input = published_input(test::make_merge_problem(corridor_building(), {}));
  PublishedInput without_nodes = input;
  without_nodes.graph = {};
  EXPECT_THAT(merge_as_published(PublishedMethod::kAcg2017, without_nodes), Fails(Errc::kDegenerate));
  input.plan.walls.clear();
  EXPECT_THAT(merge_as_published(PublishedMethod::kAcg2019, input), Fails(Errc::kDegenerate));
}

TEST(DrawnVectorCost, IsInStandardDeviationsAlongAndAcrossAndIgnoresAShift) {
  const std::unique_ptr<ceres::CostFunction> cost(DrawnVectorCost::Create({3, 4}, 0.5, 0.1));
  const auto at = [&](const Point2& a, const Point2& d) {
    return test::residuals_of(*cost, {{a.x(), a.y()}, {a.x() + d.x(), a.y() + d.y()}});
  };
  for (const Point2& a : {Point2(0, 0), Point2(-7, 2)}) {
    EXPECT_NEAR(at(a, {3, 4})[0], 0, 1e-9);
    EXPECT_NEAR(at(a, {3.6, 4.8})[0], 2, 1e-9);
    EXPECT_NEAR(at(a, {3 - 0.16, 4 + 0.12})[1], 2, 1e-9);
  }
  test::expect_jacobian_is_numeric(*cost, {{1, 2}, {5, -1}});
}

}  // namespace
}  // namespace smokemap
