#include "acg/node_store.hpp"

#include <gtest/gtest.h>

#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

PoseNode node_at(int id, const std::string& robot, const Pose2& pose) {
  PoseNode node;
  node.id = id;
  node.robot = robot;
  node.T_map_robot = pose;
  return node;
}

PoseEdge step_edge(int from, int to, const Pose2& step) {
  PoseEdge edge;
  edge.from = from;
  edge.to = to;
  edge.T_from_to = step;
  edge.sqrt_information = 50 * Eigen::Matrix3d::Identity();
  return edge;
}

/// Two robots that take turns: one drives along x, the other along y.
PoseGraph two_robots(int nodes) {
  PoseGraph graph;
  for (int i = 0; i < nodes; ++i) {
    const double way = 0.5 * (i / 2);
    graph.nodes.push_back(i % 2 == 0 ? node_at(i, "one", {way, 0, 0}) : node_at(i, "two", {10, way, kPi / 2}));
    if (i >= 2) graph.edges.push_back(step_edge(i - 2, i, {0.5, 0, 0}));
  }
  return graph;
}

TEST(NodeStore, CountsTheWayOfEachRobotByItself) {
  NodeStore store({});
  GraphState state;
  EXPECT_EQ(store.take(two_robots(10), state), GraphChange::kGrown);
  EXPECT_NEAR(store.way_m().back(), 4.0, 1e-9);  // not the ten metres between the robots, again and again
  for (const bool spaced : store.spaced()) EXPECT_TRUE(spaced);
  EXPECT_EQ(store.views()[3].robot, 1);
  EXPECT_EQ(store.views()[4].robot, 0);
}

TEST(NodeStore, GivesNewNodesTheCorrectionOfTheirOwnRobot) {
  NodeStore store({});
  GraphState state;
  store.take(two_robots(4), state);
  const Pose2 corrected(0.5, 1, 0.1);
  state.poses[2] = {corrected.x(), corrected.y(), corrected.heading()};
  EXPECT_EQ(store.take(two_robots(6), state), GraphChange::kGrown);
  EXPECT_THAT(state.pose(4), IsNear(corrected * Pose2(0.5, 0, 0), 1e-9, 1e-9));
  EXPECT_THAT(state.pose(5), IsNear(Pose2(10, 1, kPi / 2), 1e-9, 1e-9));
}

TEST(NodeStore, KeepsItsCorrectionsUntilSlamItselfMovesItsPoses) {
  NodeStore store({});
  GraphState state;
  PoseGraph graph = two_robots(4);
  store.take(graph, state);
  state.poses[2] = {0.5, 1, 0};  // SLAM slipped here, the plan said so: against SLAM's edge by fifty sigmas
  EXPECT_EQ(store.take(graph, state), GraphChange::kGrown);
  EXPECT_NEAR(state.pose(2).y(), 1, 1e-9);
  graph.nodes[1].T_map_robot = Pose2(10.4, 0, kPi / 2);
  graph.nodes[3].T_map_robot = Pose2(10.4, 0.5, kPi / 2);
  graph.edges.push_back(step_edge(0, 3, Pose2(10.4, 0.5, kPi / 2)));
  EXPECT_EQ(store.take(graph, state), GraphChange::kMoved);
  EXPECT_NEAR(state.pose(2).y(), 0, 1e-9);
}

TEST(NodeStore, BeginsAnewWithAnotherGraph) {
  NodeStore store({});
  GraphState state;
  store.take(two_robots(6), state);
  EXPECT_EQ(store.take(two_robots(2), state), GraphChange::kAnother);
  EXPECT_EQ(store.size(), 2u);
  EXPECT_EQ(state.poses.size(), 2u);
}

TEST(NodeStore, LeavesOutEdgesThatSayNothing) {
  NodeStore store({});
  GraphState state;
  PoseGraph graph = two_robots(4);
  graph.edges.push_back(step_edge(0, 99, {}));
  graph.edges.push_back(step_edge(1, 1, {}));
  graph.edges.push_back(step_edge(0, 1, Pose2(std::nan(""), 0, 0)));
  graph.edges.push_back(step_edge(0, 1, {}));
  graph.edges.back().state = LinkState::kRejected;
  store.take(graph, state);
  EXPECT_EQ(store.edges().size(), 2u);
}

}  // namespace
}  // namespace smokemap
