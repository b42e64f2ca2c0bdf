#include "slam/graph_worker.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "slam/slam.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

/// Scans of rounds through the ring of corridors, with wheels.
struct RingLog {
  std::vector<LaserScan> scans;
  std::vector<Odometry> odometry;
  std::vector<Pose2> truth;

  void drive(const std::vector<Pose2>& way, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    test::Wheels wheels(0.98, 0.004, 0.05, seed);
    for (const Pose2& at : way) {
      odometry.push_back(wheels.read(at, seconds));
      scans.push_back(test::scan_at(test::ring_of_corridors(), at, seconds, random));
      truth.push_back(at);
      seconds += 0.5;
    }
  }
  double seconds = 50;
};

void expect_same_bytes(const Slam& a, const Slam& b) {
  const Trajectory ta = a.trajectory(), tb = b.trajectory();
  ASSERT_EQ(ta.size(), tb.size());
  for (std::size_t i = 0; i < ta.size(); ++i) {
    const Eigen::Vector3d va = ta[i].T_map_robot.vector(), vb = tb[i].T_map_robot.vector();
    ASSERT_EQ(std::memcmp(va.data(), vb.data(), sizeof(double) * 3), 0) << "scan " << i;
  }
  EXPECT_EQ(a.graph().edges.size(), b.graph().edges.size());
  EXPECT_EQ(a.counters().loops_closed, b.counters().loops_closed);
  EXPECT_EQ(a.counters().loops_tried, b.counters().loops_tried);
}

TEST(GraphWorker, GivesTheSameBytesInTheBackgroundHoweverOftenItIsAsked) {
  RingLog log;
  log.drive(test::rounds(2, 0.6), 1);
  SlamParams params;
  params.graph.polish_rounds = 1;
  Slam asked(params), asked_rarely(params), background(params, GraphWork::kInBackground);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    for (Slam* slam : {&asked, &asked_rarely, &background}) {
      slam->add_odometry(log.odometry[i]);
      ASSERT_TRUE(slam->add_scan(log.scans[i]));
    }
    asked.optimize();
    if (i % 3 == 0) background.optimize();
  }
  for (Slam* slam : {&asked, &asked_rarely, &background}) slam->polish();
  EXPECT_GT(asked.counters().loops_closed, 0);
  expect_same_bytes(asked, asked_rarely);
  expect_same_bytes(asked, background);
}

TEST(GraphWorker, EndsWithoutWaitingForItsQueue) {
  RingLog log;
  log.drive(test::rounds(1, 0.6), 2);
  Slam slam({}, GraphWork::kInBackground);
  for (const LaserScan& scan : log.scans) ASSERT_TRUE(slam.add_scan(scan));
}  // leaves with nodes in the queue

TEST(GraphWorker, CanBeMovedWhileItWorks) {
  RingLog log;
  log.drive(test::rounds(1, 0.6), 3);
  Slam here({}, GraphWork::kInBackground);
  for (const LaserScan& scan : log.scans) ASSERT_TRUE(here.add_scan(scan));
  Slam there = std::move(here);
  there.polish();
  EXPECT_EQ(there.trajectory().size(), log.scans.size());
}

TEST(GraphWorker, NodesItHasNotSeenYetFollowTheLastItHas) {
  RingLog log;
  log.drive(test::rounds(2, 0.6), 4);
  Slam slam;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    slam.add_odometry(log.odometry[i]);
    ASSERT_TRUE(slam.add_scan(log.scans[i]));
    if (i % 25 == 24) slam.optimize();
    const PoseGraph& graph = slam.graph();
    if (i % 25 != 23) continue;  // before the next optimize: the newest nodes are the front end's alone
    for (std::size_t n = graph.nodes.size() - 5; n < graph.nodes.size(); ++n) {
      const PoseEdge& step = graph.edges[n - 1];
      ASSERT_EQ(step.to, static_cast<int>(n));
      EXPECT_THAT(graph.nodes[n - 1].T_map_robot * step.T_from_to, IsNear(graph.nodes[n].T_map_robot, 1e-9, 1e-9));
    }
  }
}

TEST(Relocation, FindsACarriedRobotAgainWhereverItIs) {
  RingLog log;
  log.drive(test::rounds(1, 0.25), 5);
  std::vector<Pose2> elsewhere;  // the corridor on the right, the other way
  for (double y = 7; y > 2; y -= 0.25) elsewhere.emplace_back(13, y, -kPi / 2);
  log.drive(elsewhere, 6);
  Slam slam;
  for (const LaserScan& scan : log.scans) ASSERT_TRUE(slam.add_scan(scan));
  slam.polish();
  EXPECT_EQ(slam.counters().lost, 1);
  EXPECT_EQ(slam.counters().relocated, 1);
  const Pose2 T_map_world = log.truth.front().inverse();
  EXPECT_THAT(slam.trajectory().back().T_map_robot, IsNear(T_map_world * log.truth.back(), 0.08, 0.02));
  EXPECT_THAT(slam.trajectory()[30].T_map_robot, IsNear(T_map_world * log.truth[30], 0.05, 0.02));
}

}  // namespace
}  // namespace smokemap
