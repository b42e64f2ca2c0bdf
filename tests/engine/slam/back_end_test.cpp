#include "slam/back_end.hpp"

#include <gtest/gtest.h>

#include "slam/graph_solver.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::IsNear;

/// Nodes along a way, as a front end with small errors would hand them over.
std::vector<NewNode> nodes_along(const std::vector<Pose2>& way, std::uint64_t seed, double sigma_m = 0.01,
                                 double sigma_rad = 0.003) {
  std::mt19937_64 random(seed);
  const auto walls = test::ring_of_corridors();
  std::vector<NewNode> nodes;
  for (std::size_t i = 0; i < way.size(); ++i) {
    NewNode node;
    node.node.T_map_robot = way[0];
    const ScanPoints points =
        surface_points(test::scan_at(walls, way[i], 0.5 * static_cast<double>(i), random), {}, {}, {});
    node.surface = points.surface;
    node.node.hits_robot = points.hits_robot;
    node.node.free_ends_robot = points.free_ends_robot;
    if (i > 0) {
      node.edge.T_from_to = way[i - 1].inverse() * way[i] *
                            Pose2(normal(random, sigma_m), normal(random, sigma_m), normal(random, sigma_rad));
      node.edge.sqrt_information = Eigen::Vector3d(1 / sigma_m, 1 / sigma_m, 1 / sigma_rad).asDiagonal();
      node.edge.kind = EdgeKind::kMatched;
    }
    nodes.push_back(std::move(node));
  }
  return nodes;
}

double worst_m(const PoseGraph& graph, const std::vector<Pose2>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    worst = std::max(worst, (graph.nodes[i].T_map_robot.translation() - truth[i].translation()).norm());
  return worst;
}

TEST(BackEnd, ClosesALoopAsSoonAsItIsDrivenAndPolishesToTheScansOwnNoise) {
  const std::vector<Pose2> way = test::rounds(2, 0.5);
  BackEnd back({});
  bool moved = false;
  for (NewNode& node : nodes_along(way, 1)) moved = back.add(std::move(node), {}) || moved;
  EXPECT_TRUE(moved);
  const GraphUpdate update = back.update(true);
  EXPECT_GT(update.closed, 3);
  EXPECT_EQ(update.T_map_nodes.size(), way.size());
  EXPECT_EQ(update.steps.size(), way.size() - 1);
  const double before = worst_m(back.graph(), way);
  back.polish({});
  EXPECT_LT(worst_m(back.graph(), way), 0.04);
  EXPECT_LE(worst_m(back.graph(), way), before + 0.005);
  EXPECT_GT(back.graph().edges.size(), 3 * way.size());
}

/// Solving for every loop of a way that is driven again was most of the work of long runs.
TEST(BackEnd, DoesNotSolveAgainForLoopsThatSayWhatTheGraphSays) {
  const std::vector<Pose2> way = test::rounds(2, 0.5);
  SlamParams eager, calm;
  eager.graph.agrees_within = 0;
  int solves[2] = {0, 0};
  std::vector<Pose2> ends;
  for (const bool is_calm : {false, true}) {
    BackEnd back(is_calm ? calm : eager);
    for (NewNode& node : nodes_along(way, 2)) solves[is_calm] += back.add(std::move(node), {});
    back.polish({});
    EXPECT_LT(worst_m(back.graph(), way), 0.04);
    ends.push_back(back.graph().nodes.back().T_map_robot);
  }
  EXPECT_LT(solves[1], solves[0]);
  EXPECT_GT(solves[1], 0);
  EXPECT_THAT(ends[0], IsNear(ends[1], 0.01, 0.003));
}

/// What comes out depends on the nodes and their order alone.
TEST(BackEnd, GivesTheSameGraphForTheSameNodes) {
  const std::vector<Pose2> way = test::rounds(1, 0.5);
  BackEnd a({}), b({});
  for (BackEnd* back : {&a, &b}) {
    for (NewNode& node : nodes_along(way, 3)) (void)back->add(std::move(node), {});
    back->polish({});
  }
  for (std::size_t i = 0; i < way.size(); ++i)
    EXPECT_EQ((a.graph().nodes[i].T_map_robot.vector() - b.graph().nodes[i].T_map_robot.vector()).norm(), 0);
  EXPECT_EQ(a.graph().edges.size(), b.graph().edges.size());
}

TEST(PairMatcher, MeasuresWhatTheScansMeasureNotWhatTheGraphSays) {
  const std::vector<Pose2> way = test::rounds(1, 0.5);
  std::mt19937_64 random(4);
  PoseGraph graph;
  NodeScans scans;
  const auto nodes = nodes_along(way, 4);
  for (std::size_t i = 0; i < way.size(); ++i) {
    PoseNode node;
    node.id = static_cast<int>(i);
    node.T_map_robot = way[i] * Pose2(normal(random, 0.03), normal(random, 0.03), normal(random, 0.01));
    graph.nodes.push_back(node);
    scans.add(nodes[i].surface, 0.5 * static_cast<double>(i), false);
  }
  PairMatcher matcher{SlamParams{}};
  const auto edges = matcher.match(graph, scans, 1, {});
  ASSERT_GT(edges.size(), 3 * way.size());
  double graph_sum = 0, edge_sum = 0;
  std::size_t within = 0;
  for (const PoseEdge& edge : edges) {
    const Pose2 truth = way[static_cast<std::size_t>(edge.from)].inverse() * way[static_cast<std::size_t>(edge.to)];
    const Pose2 said = graph.nodes[static_cast<std::size_t>(edge.from)].T_map_robot.inverse() *
                       graph.nodes[static_cast<std::size_t>(edge.to)].T_map_robot;
    // Across a corridor both know; along it only some do: compare what the edge is sure of.
    edge_sum += edge_error_sigmas(edge, Pose2(), truth);
    graph_sum += edge_error_sigmas(edge, Pose2(), said);
    within += edge_error_sigmas(edge, Pose2(), truth) < 3;
    EXPECT_LT(edge.from, edge.to);
  }
  EXPECT_LT(edge_sum, 0.6 * graph_sum);
  EXPECT_GT(within, edges.size() * 8 / 10);  // and their sigmas are honest
}

TEST(SlamParams, NameTheFirstFieldOutOfRange) {
  const auto refused = [](auto spoil, const char* name) {
    SlamParams params;
    spoil(params);
    const auto said = params.validate();
    EXPECT_FALSE(said) << name;
    if (!said) {
      EXPECT_NE(said.error().message.find(name), std::string::npos) << said.error().message;
    }
  };
  EXPECT_TRUE(SlamParams{}.validate());
  EXPECT_TRUE(SlamParams{}.for_radar().validate());
  refused([](SlamParams& p) { p.points.spacing_m = 0; }, "spacing_m");
  refused([](SlamParams& p) { p.points.least_points = 500; }, "least_points");
  refused([](SlamParams& p) { p.align.gate_m = 0.01; }, "gate_m");
  refused([](SlamParams& p) { p.align.stop_rad = std::nan(""); }, "stop_rad");
  refused([](SlamParams& p) { p.front_end.least_score = 0.9; }, "least_score");
  refused([](SlamParams& p) { p.front_end.map_nodes = 0; }, "map_nodes");
  refused([](SlamParams& p) { p.loops.joint_nodes = 0; }, "joint_nodes");
  refused([](SlamParams& p) { p.loops.search_rad = 4; }, "search_rad");
  refused([](SlamParams& p) { p.graph.agrees_within = 5; }, "agrees_within");
  refused([](SlamParams& p) { p.graph.pair_information = 0; }, "pair_information");
  refused([](SlamParams& p) { p.radar.farthest_m = 0.1; }, "farthest_m");
  refused([](SlamParams& p) { p.radar.lasting_within_m = 0; }, "lasting_within_m");
  refused([](SlamParams& p) { p.walkers.proof_m = 0.01; }, "proof_m");
  refused([](SlamParams& p) { p.T_map_start = Pose2(Eigen::Vector2d(std::nan(""), 0), 0); }, "T_map_start");
}

TEST(SlamParams, FieldsThatBoundEachOtherMayMeetButNotCross) {
  const auto meets = [](auto change) {
    SlamParams at, beyond;
    change(at, 0.0), change(beyond, 1e-6);
    EXPECT_THAT(at.validate(), test::IsOk());
    EXPECT_THAT(beyond.validate(), test::Fails(Errc::kInvalidArgument));
  };
  meets([](SlamParams& p, double more) { p.align.last_gate_m = p.align.gate_m + more; });
  meets([](SlamParams& p, double more) { p.radar.align.last_gate_m = p.radar.align.gate_m + more; });
  meets([](SlamParams& p, double more) { p.front_end.fair_score = p.front_end.least_score + more; });
  meets([](SlamParams& p, double more) { p.loops.bold_sigmas = p.loops.within_sigmas + more; });
  meets([](SlamParams& p, double more) { p.loops.most_through_bold = p.loops.most_through + more; });
  meets([](SlamParams& p, double more) { p.graph.agrees_within = p.graph.loop_kernel + more; });
  meets([](SlamParams& p, double more) { p.radar.nearest_m = p.radar.farthest_m + more; });
  meets([](SlamParams& p, double more) { p.radar.good_score = p.radar.least_score - more; });
}

}  // namespace
}  // namespace smokemap
