#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "acg/auto_complete_graph.hpp"
#include "acg/node_store.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

Pose2 pose_within(std::mt19937_64& random, double reach_m) {
  return {uniform(random, -reach_m, reach_m), uniform(random, -reach_m, reach_m), uniform(random, -kPi, kPi)};
}

/// A walk of short steps, one node a second.
PoseGraph random_walk(std::mt19937_64& random, int nodes) {
  PoseGraph graph;
  Pose2 pose = pose_within(random, 5);
  for (int i = 0; i < nodes; ++i) {
    PoseNode node;
    node.id = i, node.stamp = from_seconds(i), node.T_map_robot = pose;
    node.robot = uniform01(random) < 0.3 ? "two" : "one";
    graph.nodes.push_back(node);
    pose = pose * Pose2(uniform(random, 0, 0.4), 0, uniform(random, -0.4, 0.4));
  }
  return graph;
}

void correct_to(const PoseNode& node, const Pose2& T_map_robot, MergedMap& merged) {
  merged.trajectory.emplace_back();
  merged.trajectory.back().stamp = node.stamp;
  merged.trajectory.back().T_map_robot = T_map_robot;
}

TEST(CorrectedPose, MovesEverythingAlikeWhenAllNodesMovedAlike) {
  auto random = random_stream(45, 1);
  for (int i = 0; i < 50; ++i) {
    const PoseGraph graph = random_walk(random, 6);
    const Pose2 correction = pose_within(random, 20);
    MergedMap merged;
    for (const PoseNode& n : graph.nodes) correct_to(n, correction * n.T_map_robot, merged);
    for (int k = 0; k < 10; ++k) {
      const Pose2 slam = pose_within(random, 10);
      EXPECT_THAT(corrected_pose(graph, merged, graph.nodes.front().robot, from_seconds(uniform(random, -2, 8)), slam),
                  IsNear(correction * slam, 1e-9, 1e-9));
    }
  }
}

TEST(CorrectedPose, IsTheNodesOwnAtItsTimeAndChangesNothingForAnotherGraph) {
  auto random = random_stream(45, 2);
  const PoseGraph graph = random_walk(random, 8);
  MergedMap merged;
  for (const PoseNode& n : graph.nodes) correct_to(n, pose_within(random, 3), merged);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    EXPECT_THAT(corrected_pose(graph, merged, graph.nodes[i].robot, graph.nodes[i].stamp, graph.nodes[i].T_map_robot),
                IsNear(merged.trajectory[i].T_map_robot, 1e-9, 1e-9));
  EXPECT_THAT(corrected_pose(graph, merged, "three", from_seconds(2), Pose2(1, 2, 3)), IsNear(Pose2(1, 2, 3), 0, 0));
  merged.trajectory.pop_back();
  EXPECT_THAT(corrected_pose(graph, merged, "one", from_seconds(2), Pose2(1, 2, 3)), IsNear(Pose2(1, 2, 3), 0, 0));
}

// Nodes of all robots were blended, so a robot was drawn between its own correction and that of another one.
TEST(CorrectedPose, FollowsOnlyTheRobotsOwnNodes) {
  auto random = random_stream(45, 4);
  for (int i = 0; i < 50; ++i) {
    const PoseGraph graph = random_walk(random, 12);
    const std::map<std::string, Pose2> corrections{{"one", pose_within(random, 20)}, {"two", pose_within(random, 20)}};
    MergedMap merged;
    for (const PoseNode& n : graph.nodes) correct_to(n, corrections.at(n.robot) * n.T_map_robot, merged);
    for (const auto& [robot, correction] : corrections) {
      const bool known = std::any_of(graph.nodes.begin(), graph.nodes.end(),
                                     [&, &name = robot](const PoseNode& n) { return n.robot == name; });
      const Pose2 slam = pose_within(random, 10);
      EXPECT_THAT(corrected_pose(graph, merged, robot, from_seconds(uniform(random, -2, 14)), slam),
                  IsNear(known ? correction * slam : slam, 1e-9, 1e-9));
    }
  }
}

TEST(NodeStore, KnowsTheSameWhetherNodesComeOneByOneOrAllAtOnce) {
  auto random = random_stream(45, 3);
  for (int i = 0; i < 30; ++i) {
    const PoseGraph graph = random_walk(random, 25);
    NodeStore growing({}), whole({});
    GraphState grown, taken;
    PoseGraph part;
    for (const PoseNode& node : graph.nodes) {
      part.nodes.push_back(node);
      EXPECT_EQ(growing.take(part, grown), GraphChange::kGrown);
    }
    whole.take(graph, taken);
    EXPECT_EQ(growing.spaced(), whole.spaced());
    for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
      EXPECT_THAT(grown.pose(k), IsNear(graph.nodes[k].T_map_robot, 1e-9, 1e-9));
      EXPECT_NEAR(growing.way_m()[k], whole.way_m()[k], 1e-9);
      EXPECT_EQ(growing.views()[k].robot, whole.views()[k].robot);
    }
  }
}

}  // namespace
}  // namespace smokemap
