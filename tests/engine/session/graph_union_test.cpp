#include "session/graph_union.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A robot that drove `n` metres straight on, a node a metre.
PoseGraph straight(const std::string& robot, int n, const Pose2& T_slam_first = Pose2()) {
  PoseGraph graph;
  for (int i = 0; i < n; ++i) {
    PoseNode node;
    node.id = i;
    node.robot = robot;
    node.T_map_robot = T_slam_first * Pose2(i, 0, 0);
    graph.nodes.push_back(node);
    if (i == 0) continue;
    PoseEdge edge;
    edge.from = i - 1, edge.to = i;
    edge.T_from_to = Pose2(1, 0, 0);
    graph.edges.push_back(edge);
  }
  return graph;
}

/// Robot b's node 1 stands 2 m left of robot a's node 2, turned by a quarter.
GraphLink beside() { return {2, 1, Pose2(0, 2, kPi / 2), 0.1, 0.02}; }

/// Every edge that is not a link of robots fits the poses.
void expect_consistent(const PoseGraph& graph) {
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) EXPECT_EQ(graph.nodes[i].id, static_cast<int>(i));
  for (const PoseEdge& edge : graph.edges) {
    const Pose2& from = graph.nodes.at(static_cast<std::size_t>(edge.from)).T_map_robot;
    const Pose2& to = graph.nodes.at(static_cast<std::size_t>(edge.to)).T_map_robot;
    EXPECT_THAT(from.inverse() * to, test::IsNear(edge.T_from_to, 1e-9, 1e-9));
  }
}

TEST(GraphUnion, OfOneRobotIsItsGraph) {
  GraphUnion all;
  all.update("a", straight("a", 4));
  const PoseGraph graph = all.graph();
  ASSERT_EQ(graph.nodes.size(), 4u);
  EXPECT_EQ(graph.edges.size(), 3u);
  expect_consistent(graph);
  EXPECT_THAT(*all.T_union_slam("a"), test::IsNear(Pose2(), 1e-12, 1e-12));
}

TEST(GraphUnion, AJoiningRobotIsMovedToItsLink) {
  GraphUnion all;
  all.update("a", straight("a", 3));
  all.update("b", straight("b", 3, Pose2(50, -7, 1)));
  EXPECT_EQ(all.graph().nodes.size(), 3u) << "not before it joined";
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  const PoseGraph graph = all.graph();
  ASSERT_EQ(graph.nodes.size(), 6u);
  EXPECT_EQ(graph.edges.size(), 5u);
  expect_consistent(graph);
  EXPECT_THAT(graph.nodes[4].T_map_robot, test::IsNear(Pose2(2, 2, kPi / 2), 1e-9, 1e-9));
  EXPECT_THAT(graph.nodes[5].T_map_robot, test::IsNear(Pose2(2, 3, kPi / 2), 1e-9, 1e-9));
}

TEST(GraphUnion, IdsStayWhileBothRobotsDriveOn) {
  GraphUnion all;
  all.update("a", straight("a", 3));
  all.update("b", straight("b", 3));
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  const PoseGraph before = all.graph();
  all.update("a", straight("a", 5));
  all.update("b", straight("b", 4));
  const PoseGraph after = all.graph();
  ASSERT_EQ(after.nodes.size(), 9u);
  for (std::size_t i = 0; i < before.nodes.size(); ++i) EXPECT_EQ(after.nodes[i].robot, before.nodes[i].robot);
  expect_consistent(after);
  EXPECT_EQ(all.generation(), 0);
}

TEST(GraphUnion, WhenALoopMovesTheFirstRobotTheOthersMoveAlong) {
  GraphUnion all;
  all.update("a", straight("a", 3));
  all.update("b", straight("b", 3));
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  PoseGraph moved = straight("a", 3);
  moved.nodes[2].T_map_robot = Pose2(2.5, 0.5, 0.1);
  all.update("a", moved);
  const PoseGraph graph = all.graph();
  EXPECT_THAT(graph.nodes[2].T_map_robot.inverse() * graph.nodes[4].T_map_robot,
              test::IsNear(beside().T_union_own, 1e-9, 1e-9));
}

TEST(GraphUnion, WhoLeavesTakesItsNodesAlongAndTheRestKeepsItsPlaces) {
  GraphUnion all;
  all.update("a", straight("a", 3));
  all.update("b", straight("b", 2));
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  all.update("a", straight("a", 5));  // a's nodes now lie around b's
  all.leave("b");
  EXPECT_EQ(all.generation(), 1);
  const PoseGraph graph = all.graph();
  ASSERT_EQ(graph.nodes.size(), 5u);
  expect_consistent(graph);
  EXPECT_FALSE(all.T_union_slam("b"));
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  EXPECT_EQ(all.graph().nodes.size(), 7u) << "it may come back";
}

TEST(GraphUnion, ARobotThatHungOnTheOneThatLeftLeavesToo) {
  GraphUnion all;
  for (const char* robot : {"a", "b", "c"}) all.update(robot, straight(robot, 3));
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  ASSERT_THAT(all.join("c", {4, 0, Pose2(1, 0, 0), 0.1, 0.1}), test::IsOk());
  expect_consistent(all.graph());
  all.leave("b");
  EXPECT_FALSE(all.has("c"));
  EXPECT_EQ(all.graph().nodes.size(), 3u);
  all.leave("a");
  EXPECT_TRUE(all.has("a")) << "the first robot's frame is everybody's";
}

TEST(GraphUnion, RefusesLinksToNodesThatDoNotExist) {
  GraphUnion all;
  all.update("a", straight("a", 3));
  all.update("b", straight("b", 2));
  EXPECT_THAT(all.join("c", beside()), test::Fails(Errc::kNotFound));
  EXPECT_THAT(all.join("b", {2, 7, Pose2(), 0.1, 0.1}), test::Fails(Errc::kNotFound));
  EXPECT_THAT(all.join("b", {3, 1, Pose2(), 0.1, 0.1}), test::Fails(Errc::kNotFound));
  EXPECT_FALSE(all.has("b"));
}

TEST(GraphUnion, TwoRobotsThatHungOnTheOneThatLeftWereLookedUpAtPlaceMinusOne) {
  GraphUnion all;
  for (const char* robot : {"a", "b", "c", "d", "e"}) all.update(robot, straight(robot, 3));
  ASSERT_THAT(all.join("b", beside()), test::IsOk());
  ASSERT_THAT(all.join("c", {4, 0, Pose2(1, 0, 0), 0.1, 0.1}), test::IsOk());
  ASSERT_THAT(all.join("d", {5, 0, Pose2(1, 0, 0), 0.1, 0.1}), test::IsOk());
  ASSERT_THAT(all.join("e", {8, 0, Pose2(1, 0, 0), 0.1, 0.1}), test::IsOk()) << "on c";
  all.leave("b");
  for (const char* robot : {"b", "c", "d", "e"}) EXPECT_FALSE(all.has(robot)) << robot;
  expect_consistent(all.graph());
  EXPECT_EQ(all.graph().nodes.size(), 3u);
}

TEST(GraphUnion, RefusesLinksThatWouldPullWithoutEnd) {
  GraphUnion all;
  all.update("a", straight("a", 3));
  all.update("b", straight("b", 2));
  const double nan = std::nan("");
  for (const GraphLink& link : {GraphLink{2, 1, Pose2(), 0, 0.1}, GraphLink{2, 1, Pose2(), 0.1, -1},
                                GraphLink{2, 1, Pose2(), nan, 0.1}, GraphLink{2, 1, Pose2(nan, 0, 0), 0.1, 0.1}})
    EXPECT_THAT(all.join("b", link), test::Fails(Errc::kInvalidArgument));
  EXPECT_FALSE(all.has("b"));
}

/// Robots drive, join anywhere and leave, in any order: ids stay a count, edges fit the poses, links hold.
TEST(GraphUnion, StaysConsistentWhateverRobotsDo) {
  std::mt19937_64 random(7);
  const std::vector<std::string> robots{"a", "b", "c", "d", "e"};
  for (int round = 0; round < 30; ++round) {
    GraphUnion all;
    std::map<std::string, int> driven;
    std::map<std::string, Pose2> T_slam_first;
    for (const std::string& robot : robots) {
      T_slam_first[robot] = Pose2(normal(random, 9), normal(random, 9), normal(random, 2));
      all.update(robot, straight(robot, driven[robot] = 2, T_slam_first[robot]));
    }
    int generation = 0;
    for (int step = 0; step < 60; ++step) {
      const std::string& robot = robots[uniform_index(random, robots.size())];
      const double what = uniform01(random);
      if (what < 0.4) {
        all.update(robot, straight(robot, ++driven[robot], T_slam_first[robot]));
      } else if (what < 0.8) {
        const auto nodes = all.graph().nodes.size();
        const GraphLink link{static_cast<int>(uniform_index(random, nodes)),
                             static_cast<int>(uniform_index(random, static_cast<std::uint64_t>(driven[robot]))),
                             Pose2(normal(random, 1), normal(random, 1), normal(random, 1)), 0.1, 0.1};
        ASSERT_THAT(all.join(robot, link), test::IsOk());
      } else {
        all.leave(robot);
      }
      const PoseGraph graph = all.graph();
      expect_consistent(graph);
      std::map<std::string, int> counted;
      for (const PoseNode& node : graph.nodes) ++counted[node.robot];
      for (const std::string& name : robots) EXPECT_EQ(counted[name], all.has(name) ? driven[name] : 0) << name;
      EXPECT_GE(all.generation(), generation);
      generation = all.generation();
    }
  }
}

}  // namespace
}  // namespace smokemap
