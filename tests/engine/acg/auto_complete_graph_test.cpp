#include "acg/auto_complete_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/support/merge_problem.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsNear;
using test::IsOk;
using test::make_merge_problem;
using test::MergeProblem;
using test::MergeProblemParams;

MergedMap merge_all(const MergeProblem& problem) {
  AutoCompleteGraph acg;
  EXPECT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  auto merged = acg.update(problem.graph);
  EXPECT_THAT(merged, IsOk());
  return std::move(*merged);
}

std::vector<double> corner_errors(const MergeProblem& problem, const MergedMap& merged, bool seen) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < merged.corners.size(); ++i)
    if (merged.corners[i].seen == seen) errors.push_back((merged.corners[i].p_map - problem.true_corners[i]).norm());
  return errors;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double pose_rmse(const MergeProblem& problem, const MergedMap& merged) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.true_poses.size(); ++i)
    sum += (merged.trajectory[i].T_map_robot.translation() - problem.true_poses[i].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(problem.true_poses.size()));
}

bool all_finite(const MergedMap& merged) {
  return std::all_of(merged.walls.begin(), merged.walls.end(),
                     [](const MergedWall& w) { return w.segment_map.a.allFinite() && w.segment_map.b.allFinite(); }) &&
         std::all_of(merged.trajectory.begin(), merged.trajectory.end(),
                     [](const StampedPose& p) { return p.T_map_robot.is_finite(); });
}

std::size_t first_seen_corner(const MergedMap& merged) {
  std::size_t seen = 0;
  while (!merged.corners[seen].seen) ++seen;
  return seen;
}

TEST(AutoCompleteGraph, PutsTheCornersOfAStretchedPlanWhereTheyAre) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    MergeProblemParams params;
    params.seed = seed;
    const MergeProblem problem = make_merge_problem(corridor_building(), params);
    const MergedMap merged = merge_all(problem);
    EXPECT_LT(median(corner_errors(problem, merged, true)), 0.10) << "seed " << seed;
    EXPECT_LT(pose_rmse(problem, merged), 0.15) << "seed " << seed;
    EXPECT_EQ(merged.fit.verdict, "fits") << "seed " << seed;
    EXPECT_FALSE(merged.layout_to_map.folded());
  }
}

TEST(AutoCompleteGraph, CorrectsTheRobotsDriftByThePlan) {
  MergeProblemParams params;
  params.stretch = 0.02;
  params.sigma_step_m = 0.02;
  params.sigma_step_rad = 0.012;
  const MergeProblem problem = make_merge_problem(corridor_building(), params);
  MergedMap odometry;
  for (const PoseNode& n : problem.graph.nodes) {
    odometry.trajectory.emplace_back();
    odometry.trajectory.back().T_map_robot = n.T_map_robot;
  }
  EXPECT_LT(pose_rmse(problem, merge_all(problem)), 0.5 * pose_rmse(problem, odometry));
}

TEST(AutoCompleteGraph, GivesTheSameAnswerTwice) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  const MergedMap one = merge_all(problem), two = merge_all(problem);
  ASSERT_EQ(one.walls.size(), two.walls.size());
  for (std::size_t i = 0; i < one.walls.size(); ++i) EXPECT_EQ(one.walls[i].segment_map.a, two.walls[i].segment_map.a);
  for (std::size_t i = 0; i < one.corners.size(); ++i) EXPECT_EQ(one.corners[i].sigma_m, two.corners[i].sigma_m);
}

TEST(AutoCompleteGraph, FindsPhantomWallsMissing) {
  int phantoms = 0, called = 0, wrongly = 0;
  for (const std::uint64_t seed : {4, 5}) {
    MergeProblemParams params;
    params.seed = seed;
    params.stretch = 0.05;
    params.phantom_walls = 2;
    const MergeProblem problem = make_merge_problem(corridor_building(), params);
    const MergedMap merged = merge_all(problem);
    for (std::size_t w = 0; w < problem.wall_exists.size(); ++w) {
      phantoms += !problem.wall_exists[w] && merged.walls[w].evidence_m > 1.0;
      called += !problem.wall_exists[w] && merged.walls[w].state == WallState::kMissing;
      wrongly += problem.wall_exists[w] && merged.walls[w].state == WallState::kMissing;
    }
  }
  EXPECT_GE(called, phantoms - 1);
  EXPECT_EQ(wrongly, 0);
}

TEST(AutoCompleteGraph, AddsWallsThatThePlanLacks) {
  MergeProblemParams params;
  params.seed = 6;
  params.stretch = 0.05;
  params.missing_walls = 1;
  const MergedMap merged = merge_all(make_merge_problem(corridor_building(), params));
  double length = 0;
  for (const MergedWall& w : merged.walls) {
    if (w.state != WallState::kNew) continue;
    length += w.segment_map.length();
    EXPECT_FALSE(w.layout_wall.has_value());
  }
  EXPECT_GT(length, 1.5);
}

TEST(AutoCompleteGraph, TakesBackWhatItThoughtOfAWallWhenAPersonSaysOtherwise) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  const auto state_of = [&](std::size_t w) { return acg.update(problem.graph)->walls[w].state; };
  const MergedMap first = *acg.update(problem.graph);
  std::size_t wall = 0;
  while (first.walls[wall].state == WallState::kUnseen || first.walls[wall].segment_map.length() < 2) ++wall;
  const WallState before = first.walls[wall].state;
  ASSERT_THAT(acg.judge_wall(static_cast<int>(wall), WallJudgement::kGone), IsOk());
  EXPECT_EQ(state_of(wall), WallState::kMissing);
  ASSERT_THAT(acg.judge_wall(static_cast<int>(wall), WallJudgement::kNone), IsOk());
  EXPECT_EQ(state_of(wall), before);
  EXPECT_THAT(acg.judge_wall(100000, WallJudgement::kGone), Fails(Errc::kNotFound));
}

TEST(AutoCompleteGraph, HoldsAPinnedCornerAndAMeasuredWallWhateverSensorsSay) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  const MergedMap before = *acg.update(problem.graph);
  const std::size_t seen = first_seen_corner(before);
  const Point2 pin = before.corners[seen].p_map + Point2(0.3, 0.2);
  ASSERT_THAT(acg.pin_corner(static_cast<int>(seen), pin), IsOk());
  std::size_t wall = 0;
  const auto touches_pin = [&](std::size_t w) {
    return problem.plan.walls[w].corner_a == static_cast<int>(seen) ||
           problem.plan.walls[w].corner_b == static_cast<int>(seen);
  };
  while (touches_pin(wall) || before.walls[wall].segment_map.length() < 2) ++wall;
  const double length = before.walls[wall].segment_map.length() - 0.25;
  ASSERT_THAT(acg.set_wall_length(static_cast<int>(wall), length), IsOk());
  for (int again = 0; again < 2; ++again) {
    const MergedMap held = *acg.update(problem.graph);
    EXPECT_LT((held.corners[seen].p_map - pin).norm(), 0.03);
    EXPECT_NEAR(held.walls[wall].segment_map.length(), length, 0.05);
  }
  ASSERT_THAT(acg.pin_corner(static_cast<int>(seen), std::nullopt), IsOk());
  ASSERT_THAT(acg.set_wall_length(static_cast<int>(wall), std::nullopt), IsOk());
  const MergedMap free = *acg.update(problem.graph);
  EXPECT_LT((free.corners[seen].p_map - before.corners[seen].p_map).norm(), 0.05);
  EXPECT_NEAR(free.walls[wall].segment_map.length(), before.walls[wall].segment_map.length(), 0.05);
}

TEST(AutoCompleteGraph, RefusesWordsAboutWhatThePlanDoesNotHave) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  EXPECT_THAT(acg.pin_corner(0, Point2(0, 0)), Fails(Errc::kNotFound));
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  EXPECT_THAT(acg.pin_corner(100000, Point2(0, 0)), Fails(Errc::kNotFound));
  EXPECT_THAT(acg.pin_corner(0, Point2(std::nan(""), 0)), Fails(Errc::kInvalidArgument));
  EXPECT_THAT(acg.set_wall_length(-1, 4.2), Fails(Errc::kNotFound));
  EXPECT_THAT(acg.set_wall_length(0, -1), Fails(Errc::kInvalidArgument));
}

TEST(AutoCompleteGraph, ShowsItsLinksAndKeepsThemRight) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  const MergedMap merged = merge_all(problem);
  int kept = 0, right = 0;
  for (const MapLink& link : merged.links) {
    if (link.state != LinkState::kKept) continue;
    ++kept;
    right += (link.p_map - problem.true_corners[static_cast<std::size_t>(link.layout_corner)]).norm() < 0.45;
  }
  EXPECT_GT(kept, 50);
  EXPECT_GE(right, 0.98 * kept);
}

TEST(AutoCompleteGraph, TakesBackASlipOfSlamWhereItHappened) {
  MergeProblemParams params;
  params.stretch = 0.03;
  MergeProblem problem = make_merge_problem(corridor_building(), params);
  const std::size_t slip = problem.graph.nodes.size() / 2;
  const Pose2 here = problem.graph.nodes[slip - 1].T_map_robot, wrong(0.25, 0.15, 0.07);
  for (std::size_t i = slip; i < problem.graph.nodes.size(); ++i) {
    Pose2& pose = problem.graph.nodes[i].T_map_robot;
    pose = here * wrong * here.inverse() * pose;
  }
  for (PoseEdge& e : problem.graph.edges)
    if (e.to == static_cast<int>(slip)) e.T_from_to = wrong * e.T_from_to;
  EXPECT_LT(pose_rmse(problem, merge_all(problem)), 0.15);
}

TEST(AutoCompleteGraph, GrowsWithTheGraphAndNeverTurnsAWallWildly) {
  MergeProblemParams params;
  params.seed = 2;
  params.max_stops = 5;
  const MergeProblem problem = make_merge_problem(corridor_building(), params);
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  std::optional<MergedMap> merged;
  int revision = 0;
  for (std::size_t n = 10; n < problem.graph.nodes.size() + 10; n += 10) {
    auto next = acg.update(test::first_nodes(problem.graph, n));
    ASSERT_THAT(next, IsOk());
    EXPECT_GT(next->revision, revision);
    revision = next->revision;
    for (const MergedWall& w : next->walls) {
      if (!w.layout_wall || w.segment_map.length() < 1.5) continue;
      const auto& drawn = problem.plan.walls[static_cast<std::size_t>(*w.layout_wall)];
      const Point2 a = problem.true_corners[static_cast<std::size_t>(drawn.corner_a)],
                   b = problem.true_corners[static_cast<std::size_t>(drawn.corner_b)];
      EXPECT_LT(line_angle_between(w.segment_map.heading(), Segment2{a, b}.heading()), 0.12);
    }
    merged = std::move(*next);
  }
  EXPECT_LT(median(corner_errors(problem, *merged, true)), 0.12);
}

TEST(AutoCompleteGraph, AlignsByTwoPairsWithoutAStart) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan), IsOk());
  const std::size_t last = problem.plan.corners.size() - 1;
  acg.add_anchor("one", problem.plan.corners[0].p_px, problem.true_corners[0]);
  acg.add_anchor("two", problem.plan.corners[last].p_px, problem.true_corners[last]);
  const auto merged = acg.update(problem.graph);
  ASSERT_THAT(merged, IsOk());
  EXPECT_LT(median(corner_errors(problem, *merged, true)), 0.15);
  EXPECT_LT((merged->corners[0].p_map - problem.true_corners[0]).norm(), 0.15);
}

TEST(AutoCompleteGraph, BelievesAPersonsPairMoreThanSensorsAndShowsTheResidual) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  const MergedMap before = *acg.update(problem.graph);
  const std::size_t seen = first_seen_corner(before);
  const Point2 said = before.corners[seen].p_map + Point2(0.5, 0.33);
  acg.add_anchor("said", problem.plan.corners[seen].p_px, said);
  const MergedMap after = *acg.update(problem.graph);
  ASSERT_EQ(after.anchors.size(), 1u);
  EXPECT_EQ(after.anchors[0].id, "said");
  EXPECT_FALSE(after.anchors[0].outlier);
  EXPECT_LT((after.corners[seen].p_map - said).norm(), 0.10);
  EXPECT_LT(after.anchors[0].residual_m, 0.10);
  acg.remove_anchor("said");
  const MergedMap free = *acg.update(problem.graph);
  EXPECT_TRUE(free.anchors.empty());
  EXPECT_LT((free.corners[seen].p_map - before.corners[seen].p_map).norm(), 0.05);
}

TEST(AutoCompleteGraph, LeavesOutAPairThatContradictsTheOthersAndFlagsIt) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan), IsOk());
  const std::size_t last = problem.plan.corners.size() - 1;
  for (const std::size_t c : {std::size_t{0}, last / 3, 2 * last / 3, last})
    acg.add_anchor("right " + std::to_string(c), problem.plan.corners[c].p_px, problem.true_corners[c]);
  acg.add_anchor("wrong", problem.plan.corners[last / 2].p_px, problem.true_corners[last / 2] + Point2(-9, 14));
  const auto merged = acg.update(problem.graph);
  ASSERT_THAT(merged, IsOk());
  for (const MergedAnchor& a : merged->anchors) {
    EXPECT_EQ(a.outlier, a.id == "wrong") << a.id;
    EXPECT_EQ(a.residual_m > 1, a.id == "wrong") << a.id;
  }
  EXPECT_LT(median(corner_errors(problem, *merged, true)), 0.15);
}

TEST(AutoCompleteGraph, WithoutAPlanHandsOnTheTrajectoryAndSensedWalls) {
  MergeProblemParams params;
  params.max_stops = 3;
  const MergeProblem problem = make_merge_problem(corridor_building(), params);
  AutoCompleteGraph acg;
  const auto merged = acg.update(problem.graph);
  ASSERT_THAT(merged, IsOk());
  EXPECT_EQ(merged->trajectory.size(), problem.graph.nodes.size());
  EXPECT_THAT(merged->trajectory.back().T_map_robot, IsNear(problem.graph.nodes.back().T_map_robot, 1e-9, 1e-9));
  EXPECT_TRUE(merged->corners.empty());
  EXPECT_EQ(merged->fit.verdict, "unknown");
  EXPECT_TRUE(std::all_of(merged->walls.begin(), merged->walls.end(),
                          [](const MergedWall& w) { return w.state == WallState::kNew; }));
}

TEST(AutoCompleteGraph, SaysThatThePlanOfAnotherBuildingDoesNotFit) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  const MergeProblem other = make_merge_problem(slanted_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(other.plan, other.start), IsOk());
  const auto merged = acg.update(problem.graph);
  ASSERT_THAT(merged, IsOk());
  EXPECT_NE(merged->fit.verdict, "fits");
  EXPECT_TRUE(all_finite(*merged));
}

TEST(AutoCompleteGraph, SurvivesAMirroredPlanAndAPlanOfOneWall) {
  MergeProblem problem = make_merge_problem(corridor_building(), {});
  const double right_fit = merge_all(problem).fit.score;
  for (LayoutCorner& c : problem.plan.corners) c.p_px.x() = problem.plan.width_px - c.p_px.x();
  const MergedMap mirrored = merge_all(problem);
  EXPECT_TRUE(all_finite(mirrored));
  EXPECT_LT(mirrored.fit.score, right_fit);
  problem.plan.walls.resize(1);
  EXPECT_TRUE(all_finite(merge_all(problem)));
  problem.plan.walls.clear();
  EXPECT_THAT(AutoCompleteGraph().set_plan(problem.plan, problem.start), Fails(Errc::kDegenerate));
}

TEST(AutoCompleteGraph, StopsWhenAskedAndIsAsBefore) {
  const MergeProblem problem = make_merge_problem(corridor_building(), {});
  AutoCompleteGraph acg;
  ASSERT_THAT(acg.set_plan(problem.plan, problem.start), IsOk());
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THAT(acg.update(problem.graph, {{}, stop.get_token()}), Fails(Errc::kCancelled));
  const MergedMap after = *acg.update(problem.graph), fresh = merge_all(problem);
  EXPECT_EQ(after.corners.front().p_map, fresh.corners.front().p_map);
}

TEST(CorrectedPose, BlendsTheCorrectionsOfTheNodesAround) {
  PoseGraph graph;
  MergedMap merged;
  for (int i = 0; i < 2; ++i) {
    PoseNode node;
    node.id = i;
    node.stamp = from_seconds(i);
    node.T_map_robot = Pose2(i, 0, 0);
    graph.nodes.push_back(node);
    merged.trajectory.emplace_back();
    merged.trajectory.back().T_map_robot = Pose2(i, 0.2 * i, 0);
  }
  EXPECT_THAT(corrected_pose(graph, merged, "", from_seconds(0.5), Pose2(0.5, 0, 0)),
              IsNear(Pose2(0.5, 0.1, 0), 1e-9, 1e-9));
  EXPECT_THAT(corrected_pose(graph, merged, "", from_seconds(3), Pose2(3, 0, 0)), IsNear(Pose2(3, 0.2, 0), 1e-9, 1e-9));
  EXPECT_THAT(corrected_pose({}, merged, "", 0, Pose2(3, 0, 0)), IsNear(Pose2(3, 0, 0), 1e-9, 1e-9));
}

TEST(AcgParams, AreChecked) {
  EXPECT_THAT(AcgParams{}.validate(), IsOk());
  AcgParams bad;
  bad.rounds = 0;
  EXPECT_THAT(bad.validate(), Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
