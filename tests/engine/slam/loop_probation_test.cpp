#include "slam/loop_probation.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace smokemap {
namespace {

/// Two visits side by side, 20 m each, nodes every metre; the graph has the second one off by a drift. Nodes 0 .. 20
/// and 21 .. 41, both at x = 0 .. 20.
struct TwoWays {
  PoseGraph graph;
  NodeScans scans;
  std::vector<Pose2> truth;

  explicit TwoWays(const Pose2& T_drift) {
    for (int i = 0; i < 42; ++i) {
      PoseNode node;
      node.id = i;
      truth.emplace_back(i % 21, i < 21 ? 0.0 : 0.5, 0.0);
      node.T_map_robot = i < 21 ? truth.back() : T_drift * truth.back();
      graph.nodes.push_back(node);
      scans.add({}, i < 21 ? i : 50 + i, false);
    }
  }
  /// What a loop at x says that is wrong by T_error.
  PoseEdge loop(int x, const Pose2& T_error = {}) const {
    PoseEdge edge;
    edge.from = x;
    edge.to = 21 + x;
    edge.T_from_to =
        truth[static_cast<std::size_t>(edge.from)].inverse() * T_error * truth[static_cast<std::size_t>(edge.to)];
    edge.kind = EdgeKind::kLoop;
    return edge;
  }
  double off_m(const PoseEdge& loop) const {
    return ((truth[static_cast<std::size_t>(loop.from)] * loop.T_from_to).translation() -
            truth[static_cast<std::size_t>(loop.to)].translation())
        .norm();
  }
};

TEST(LoopProbation, BelievesSmallCorrectionsAtOnce) {
  const TwoWays ways(Pose2(0.8, -0.9, 0.03));
  LoopProbation probation{LoopParams()};
  EXPECT_EQ(probation.admit(ways.graph, ways.scans, {ways.loop(3)}).size(), 1U);
  EXPECT_EQ(probation.waiting(), 0);
}

TEST(LoopProbation, BelievesALargeCorrectionWhenAnotherClosesTheSameGapFartherOnThanTheGapIsLong) {
  const TwoWays ways(Pose2(4, 0, 0.02));
  LoopProbation probation{LoopParams()};
  EXPECT_TRUE(probation.admit(ways.graph, ways.scans, {ways.loop(3)}).empty());
  EXPECT_TRUE(probation.admit(ways.graph, ways.scans, {ways.loop(6)}).empty()) << "3 m on, 4 m wide";
  EXPECT_EQ(probation.waiting(), 2);
  EXPECT_EQ(probation.admit(ways.graph, ways.scans, {ways.loop(11)}).size(), 3U) << "the third bears out the first two";
  EXPECT_EQ(probation.waiting(), 0);
}

TEST(LoopProbation, NeverBelievesALoopThatStaysAlone) {
  const TwoWays ways(Pose2(4, 0, 0));
  LoopProbation probation{LoopParams()};
  for (int round = 0; round < 5; ++round)
    EXPECT_TRUE(
        probation.admit(ways.graph, ways.scans, round ? std::vector<PoseEdge>{} : std::vector{ways.loop(3)}).empty());
  EXPECT_EQ(probation.waiting(), 1);
}

TEST(LoopProbation, BelievesWhatWaitedOnceTheGraphHasComeNearIt) {
  TwoWays ways(Pose2(4, 0, 0));
  LoopProbation probation{LoopParams()};
  EXPECT_TRUE(probation.admit(ways.graph, ways.scans, {ways.loop(3)}).empty());
  for (std::size_t i = 21; i < 42; ++i) ways.graph.nodes[i].T_map_robot = Pose2(0.2, 0, 0) * ways.truth[i];
  EXPECT_EQ(probation.admit(ways.graph, ways.scans, {}).size(), 1U);
}

// One room farther on looked just like the right one: the map was folded by 5 m and the right place never looked for.
TEST(LoopProbation, OfWrongAndRightLoopsMixedBelievesTheRightOnes) {
  int wrong = 0, right = 0, planted = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    const TwoWays ways(Pose2(uniform(random, 2, 5), uniform(random, -1, 1), uniform(random, -0.05, 0.05)));
    LoopProbation probation{LoopParams()};
    for (int x = 0; x <= 20; x += 2) {
      const bool astray = uniform01(random) < 0.5;  // at least 2 m from where the graph is and from the truth
      const Pose2 T_error = astray ? Pose2(uniform(random, -6, 6), uniform(random, 3, 8), uniform(random, -0.3, 0.3))
                                   : Pose2(normal(random, 0.03), normal(random, 0.03), normal(random, 0.004));
      planted += !astray;
      for (const PoseEdge& loop : probation.admit(ways.graph, ways.scans, {ways.loop(x, T_error)}))
        ++(ways.off_m(loop) < 0.3 ? right : wrong);
    }
  }
  EXPECT_LE(wrong, 3) << "pairs that agree by chance";
  EXPECT_GE(right, 8 * planted / 10);
}

}  // namespace
}  // namespace smokemap
