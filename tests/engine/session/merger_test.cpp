#include "session/merger.hpp"

#include <gtest/gtest.h>

#include "tests/engine/session/scene.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::square_plan;

/// What a robot sees of the square plan's walls (inner side 10 m at 0.05 m a pixel) from a pose in its middle.
PoseNode node_in_square(int id, const Pose2& T_map_robot, const Pose2& T_layout_map, const std::string& robot) {
  auto hits = std::make_shared<std::vector<Point2>>();
  const Pose2 T_robot_layout = (T_layout_map * T_map_robot).inverse();
  const LayoutMap plan = square_plan();
  for (int wall = 0; wall < 4; ++wall) {
    const Segment2 s = plan.wall_m(wall);
    const Point2 middle = plan.frame().to_metres({120, 120});
    const double half_m = 0.5 * plan.walls[0].thickness_px * plan.frame().metres_per_pixel;
    const Point2 inward = (s.normal().dot(middle - s.a) > 0 ? half_m : -half_m) * s.normal();
    for (double t = 0.02; t < 1; t += 0.01) hits->push_back(T_robot_layout * Point2(s.a + t * (s.b - s.a) + inward));
  }
  PoseNode node;
  node.id = id;
  node.robot = robot;
  node.T_map_robot = T_map_robot;
  node.hits_robot = hits;
  node.free_ends_robot = std::make_shared<std::vector<Point2>>();
  return node;
}

/// A robot that drove 3 m through the middle of the square. The map's origin is its first pose.
std::shared_ptr<const PoseGraph> walk(const Pose2& T_layout_map, const std::string& robot = "robot1") {
  auto graph = std::make_shared<PoseGraph>();
  for (int i = 0; i < 6; ++i) {
    graph->nodes.push_back(node_in_square(i, Pose2(0.5 * i, 0, 0), T_layout_map, robot));
    if (i == 0) continue;
    PoseEdge edge;
    edge.from = i - 1, edge.to = i, edge.T_from_to = Pose2(0.5, 0, 0);
    edge.sqrt_information.diagonal() << 50, 50, 200;
    graph->edges.push_back(edge);
  }
  return graph;
}

const Pose2 kTrueStart(3.5, 6, 0);

MergeInput input_with(std::shared_ptr<const PoseGraph> graph, int generation = 0) {
  MergeInput input;
  input.floor = {std::move(graph), generation};
  input.layout = std::make_shared<const LayoutView>(LayoutView{"plan", square_plan()});
  input.start = PlanStart{kTrueStart, 0.3, 0.05};
  return input;
}

TEST(PlanAlone, LiesWhereTheStartSaysAndSaysThatNobodySawIt) {
  const MergedMap merged = plan_alone(square_plan(), PlanStart{kTrueStart, 0.3, 0.05});
  ASSERT_EQ(merged.walls.size(), 4u);
  for (const MergedWall& wall : merged.walls) {
    EXPECT_EQ(wall.state, WallState::kUnseen);
    EXPECT_EQ(wall.evidence_m, 0);
  }
  for (const MergedCorner& corner : merged.corners) {
    EXPECT_FALSE(corner.seen);
    EXPECT_GT(corner.sigma_m, 0.5);
  }
  EXPECT_EQ(merged.fit.verdict, "unknown");
  EXPECT_THAT(merged.layout_to_map(kTrueStart.translation()), test::IsNearPoint(Point2(0, 0), 1e-9));
}

TEST(Merger, WithoutARobotThePlanIsShownAlone) {
  Merger merger;
  const MergeResult result = merger.run(input_with(std::make_shared<const PoseGraph>()));
  EXPECT_EQ(result.merged->walls.size(), 4u);
  EXPECT_TRUE(result.T_map_graph.empty());
  ASSERT_TRUE(result.cost_map) << "a goal may be given before the robot has moved";
}

TEST(Merger, WithoutAPlanWhatWasSeenIsTheMap) {
  Merger merger;
  MergeInput input = input_with(walk(kTrueStart));
  input.layout.reset();
  input.start.reset();
  const MergeResult result = merger.run(input);
  EXPECT_TRUE(result.complaint.empty());
  EXPECT_GT(result.sensed->frame().width_cells, 50);
  EXPECT_THAT(result.T_map_graph.at("robot1"), test::IsNear(Pose2(), 1e-6, 1e-6));
}

TEST(Merger, WhatWasSeenCorrectsThePlan) {
  Merger merger;
  MergeInput input = input_with(walk(kTrueStart));
  input.start->T_layout_robot = kTrueStart * Pose2(0.25, -0.2, 0.03);
  const MergeResult result = merger.run(input);
  EXPECT_TRUE(result.complaint.empty());
  const Point2 corner = square_plan().frame().to_metres(square_plan().corners[0].p_px);
  EXPECT_THAT(result.merged->layout_to_map(corner), test::IsNearPoint(kTrueStart.inverse() * corner, 0.1));
  EXPECT_EQ(std::count_if(result.merged->walls.begin(), result.merged->walls.end(),
                          [](const MergedWall& w) { return w.state == WallState::kConfirmed; }),
            4);
}

TEST(Merger, RevisionsCountUp) {
  Merger merger;
  const MergeInput input = input_with(walk(kTrueStart));
  const int first = merger.run(input).merged->revision;
  EXPECT_EQ(merger.run(input).merged->revision, first + 1);
}

TEST(Merger, EveryRobotOfTheFloorGetsACorrection) {
  auto graph = std::make_shared<PoseGraph>(*walk(kTrueStart));
  const Pose2 T_map_other(1, 1.5, 0.4);
  graph->nodes.push_back(node_in_square(6, T_map_other, kTrueStart, "robot2"));
  PoseEdge link;
  link.from = 2, link.to = 6;
  link.T_from_to = graph->nodes[2].T_map_robot.inverse() * T_map_other;
  link.sqrt_information.diagonal() << 10, 10, 30;
  graph->edges.push_back(link);
  Merger merger;
  const MergeResult result = merger.run(input_with(graph));
  ASSERT_EQ(result.T_map_graph.size(), 2u);
  for (const auto& [robot, T] : result.T_map_graph) EXPECT_THAT(T, test::IsNear(Pose2(), 0.1, 0.02)) << robot;
}

TEST(Merger, ANewGenerationOfNodesStartsAfreshWithTheSamePlanAnchorsAndVerdicts) {
  Merger merger;
  MergeInput input = input_with(walk(kTrueStart), 0);
  input.wall_verdicts[2] = WallVerdict::kGone;
  (void)merger.run(input);
  // Another robot's nodes now have these ids, and it stands elsewhere.
  const Pose2 T_layout_other(7, 4, kPi / 2);
  input.floor = {walk(T_layout_other, "robot2"), 1};
  input.start = PlanStart{T_layout_other, 0.3, 0.05};
  const MergeResult again = merger.run(input);
  EXPECT_EQ(again.generation, 1);
  EXPECT_TRUE(again.complaint.empty());
  const Point2 corner = square_plan().frame().to_metres(square_plan().corners[0].p_px);
  EXPECT_THAT(again.merged->layout_to_map(corner), test::IsNearPoint(T_layout_other.inverse() * corner, 0.1));
  EXPECT_EQ(again.merged->walls[2].state, WallState::kMissing) << "what a person said stays said";
}

TEST(Merger, AnotherPlanReplacesTheFirst) {
  Merger merger;
  MergeInput input = input_with(walk(kTrueStart));
  (void)merger.run(input);
  LayoutMap other = square_plan(300);
  input.layout = std::make_shared<const LayoutView>(LayoutView{"other", other});
  const MergeResult result = merger.run(input);
  ASSERT_EQ(result.merged->corners.size(), 4u);
  EXPECT_EQ(result.merged->corners[2].p_layout_px, other.corners[2].p_px);
  input.layout.reset();
  EXPECT_TRUE(merger.run(input).merged->corners.empty()) << "and can be taken away";
}

TEST(Merger, AMeasuredWallHasItsLengthAndLosesItAgain) {
  Merger merger;
  MergeInput input = input_with(walk(kTrueStart));
  const auto length_of_first = [](const MergeResult& r) { return r.merged->walls.at(0).segment_map.length(); };
  const double seen_m = length_of_first(merger.run(input));
  EXPECT_NEAR(seen_m, 10, 0.15);
  input.wall_lengths_m[0] = 10.6;
  EXPECT_NEAR(length_of_first(merger.run(input)), 10.6, 0.1) << "a person's word is harder than what was seen";
  input.wall_lengths_m.clear();
  EXPECT_NEAR(length_of_first(merger.run(input)), seen_m, 0.1);
}

TEST(Merger, APinnedCornerIsWhereItWasPinned) {
  Merger merger;
  MergeInput input = input_with(walk(kTrueStart));
  const Point2 p_true = merger.run(input).merged->corners.at(1).p_map;
  input.corner_pins[1] = p_true + Point2(0.3, -0.2);
  EXPECT_THAT(merger.run(input).merged->corners.at(1).p_map,
              test::IsNearPoint(Point2(p_true + Point2(0.3, -0.2)), 0.05));
}

}  // namespace
}  // namespace smokemap
