#include "slam/loop_closer.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "slam/slam.hpp"
#include "slam/trajectory_error.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

PoseEdge step_between(int from, int to, const Pose2& z, double sigma_m, double sigma_rad) {
  PoseEdge edge;
  edge.from = from;
  edge.to = to;
  edge.T_from_to = z;
  edge.sqrt_information = Eigen::Vector3d(1 / sigma_m, 0.5 / sigma_m, 1 / sigma_rad).asDiagonal();
  edge.kind = EdgeKind::kMatched;
  return edge;
}

/// A way of `count` nodes that bends, and how far along it each node is.
std::pair<PoseGraph, NodeScans> bent_way(int count, double sigma_m, double sigma_rad) {
  PoseGraph graph;
  NodeScans scans;
  for (int i = 0; i < count; ++i) {
    PoseNode node;
    node.id = i;
    if (i > 0) {
      const Pose2 z(1, 0.1, i % 3 ? 0.2 : -0.1);
      node.T_map_robot = graph.nodes.back().T_map_robot * z;
      graph.edges.push_back(step_between(i - 1, i, z, sigma_m, sigma_rad));
    }
    graph.nodes.push_back(node);
    scans.add({}, i, false);
  }
  return {graph, scans};
}

TEST(GraphDistances, SpreadLikeManyDrawnWays) {
  const int count = 12;
  auto [graph, scans] = bent_way(count, 0.02, 0.01);
  const Point2 end = graph.nodes.back().T_map_robot.translation();
  const Eigen::Matrix3d told = graph_distances(graph, scans, 0, 1.0).back().covariance_at(end);
  std::mt19937_64 random(1);
  Eigen::Matrix3d drawn = Eigen::Matrix3d::Zero();
  const int draws = 4000;
  for (int k = 0; k < draws; ++k) {
    Pose2 at = graph.nodes.front().T_map_robot;
    for (const PoseEdge& edge : graph.edges) {
      const Eigen::Vector3d noise =
          edge.sqrt_information.inverse() * Eigen::Vector3d(normal(random, 1), normal(random, 1), normal(random, 1));
      at = at * Pose2(edge.T_from_to.translation() + noise.head<2>(), edge.T_from_to.heading() + noise.z());
    }
    const Eigen::Vector3d off = at.vector() - graph.nodes.back().T_map_robot.vector();
    drawn += off * off.transpose() / draws;
  }
  EXPECT_LT((told - drawn).norm(), 0.08 * drawn.norm());
}

TEST(GraphDistances, AreTheSameInBothDirectionsSeenFromTheirEnds) {
  const auto [graph, scans] = bent_way(9, 0.02, 0.01);
  const Eigen::Matrix3d there = graph_distances(graph, scans, 0, 1.0)[8].spread;
  const Eigen::Matrix3d back = graph_distances(graph, scans, 8, 1.0)[0].spread;
  EXPECT_LT((there - back).norm(), 1e-9 * there.norm());
}

TEST(GraphDistances, TakeALoopAsShortCutUnlessItWasRejected) {
  auto [graph, scans] = bent_way(30, 0.02, 0.01);
  PoseEdge loop = step_between(2, 27, graph.nodes[2].T_map_robot.inverse() * graph.nodes[27].T_map_robot, 0.02, 0.01);
  loop.kind = EdgeKind::kLoop;
  graph.edges.push_back(loop);
  const auto with = graph_distances(graph, scans, 0, 1.0);
  EXPECT_NEAR(with[27].way_m, 2 + 1, 1e-9);
  EXPECT_NEAR(with[29].way_m, 2 + 1 + 2, 1e-9);
  graph.edges.back().state = LinkState::kRejected;
  EXPECT_NEAR(graph_distances(graph, scans, 0, 1.0)[27].way_m, 27, 1e-9);
}

TEST(GraphDistances, NeverReachWhatNothingLeadsTo) {
  auto [graph, scans] = bent_way(3, 0.02, 0.01);
  graph.edges.pop_back();
  EXPECT_FALSE(std::isfinite(graph_distances(graph, scans, 0, 1.0)[2].way_m));
}

/// A corridor with six rooms that are exactly alike, 3 m apart.
std::vector<Segment2> offices_built_alike() {
  std::vector<Segment2> walls{{{0, 0}, {18, 0}}, {{18, 0}, {18, 2}}, {{0, 2}, {0, 0}}, {{0, 6}, {18, 6}}};
  for (int room = 0; room < 6; ++room) {
    const double x = 3.0 * room;
    walls.push_back({{x, 6}, {x, 2}});
    walls.push_back({{x, 2}, {x + 1, 2}});
    walls.push_back({{x + 2, 2}, {x + 3, 2}});
    walls.push_back({{x + 0.1, 5}, {x + 0.8, 5}});  // a desk
    walls.push_back({{x + 0.8, 5}, {x + 0.8, 4.4}});
  }
  walls.push_back({{18, 2}, {18, 6}});
  return walls;
}

/// Into every room and out again, then back along the corridor.
std::vector<Pose2> visit_all_rooms(double step_m) {
  std::vector<Point2> corners{{0.8, 1}};
  for (int room = 0; room < 6; ++room)
    for (const double y : {1.0, 4.0, 1.0}) corners.push_back({3.0 * room + 1.5, y});
  corners.push_back({0.8, 1});
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Point2 way = corners[i + 1] - corners[i];
    const double heading = std::atan2(way.y(), way.x());
    if (!poses.empty()) {
      const double turn = wrap_angle(heading - poses.back().heading());
      const int parts = static_cast<int>(std::abs(turn) / 0.25) + 1;
      const double from = poses.back().heading();
      for (int k = 1; k <= parts; ++k) poses.emplace_back(corners[i], from + turn * k / parts);
    }
    for (double s = step_m; s <= way.norm(); s += step_m)
      poses.emplace_back(corners[i] + s * way.normalized(), heading);
  }
  return poses;
}

// A loop one room farther on was believed: 2.5 m off, with every scan matched.
TEST(LoopCloser, IsNotFooledByRoomsThatAreAlike) {
  const auto walls = offices_built_alike();
  for (const std::uint64_t seed : {1}) {
    std::mt19937_64 random(seed);
    test::Wheels wheels(0.97, 0.004, 0.05, seed);
    Slam slam;
    Trajectory truth;
    double seconds = 0;
    for (const Pose2& at : visit_all_rooms(0.3)) {
      slam.add_odometry(wheels.read(at, seconds));
      ASSERT_TRUE(slam.add_scan(test::scan_at(walls, at, seconds, random)));
      truth.push_back({from_seconds(seconds), at, Eigen::Matrix3d::Zero()});
      seconds += 0.5;
    }
    slam.polish();
    const auto error = absolute_error(slam.trajectory(), truth);
    ASSERT_TRUE(error);
    EXPECT_LT(error->rmse_m, 0.04);
    EXPECT_GT(slam.counters().loops_closed, 0);
  }
}

/// A straight corridor 65 m long, 2.2 m wide; pillars along both walls every few metres.
std::vector<Segment2> corridor_with_pillars(std::mt19937_64& random) {
  std::vector<Segment2> walls{
      {{-10, -1.1}, {55, -1.1}}, {{55, -1.1}, {55, 1.1}}, {{55, 1.1}, {-10, 1.1}}, {{-10, 1.1}, {-10, -1.1}}};
  for (const double side : {-1.0, 1.0})
    for (double x = -9; x < 54; x += uniform(random, 2, 6)) {
      const double inner = side * (1.1 - uniform(random, 0.15, 0.35)), end = x + uniform(random, 0.2, 0.5);
      walls.push_back({{x, side * 1.1}, {x, inner}});
      walls.push_back({{x, inner}, {end, inner}});
      walls.push_back({{end, inner}, {end, side * 1.1}});
    }
  return walls;
}

/// Two visits to a corridor; how far the second is from the first is known to a few metres only.
struct TwoVisits {
  PoseGraph graph;
  NodeScans scans;
  std::vector<Pose2> truth;

  /// @param begin_m  where the second visit begins; the first goes from 0 to 8 m
  /// @param off_m    how far off along the corridor the graph has the second visit
  TwoVisits(double begin_m, double off_m, std::mt19937_64& random) {
    const std::vector<Segment2> walls = corridor_with_pillars(random);
    for (double x = 0; x <= 8; x += 0.4) add(walls, {x, uniform(random, -0.2, 0.2), 0}, 0, 0.4, random);
    for (double x = begin_m; x <= begin_m + 5; x += 0.4)
      add(walls, {x, uniform(random, -0.2, 0.2), uniform(random, -0.1, 0.1)}, off_m, x == begin_m ? 60 : 0.4, random);
  }

 private:
  void add(const std::vector<Segment2>& walls, const Pose2& at, double off_m, double way_m, std::mt19937_64& random) {
    PoseNode node;
    node.id = static_cast<int>(truth.size());
    node.T_map_robot = Pose2(at.x() + off_m, at.y(), at.heading());
    if (node.id > 0) {
      const Pose2 z = graph.nodes.back().T_map_robot.inverse() * node.T_map_robot;
      graph.edges.push_back(step_between(node.id - 1, node.id, z, way_m > 10 ? 2.5 : 0.01, way_m > 10 ? 0.05 : 0.003));
    }
    truth.push_back(at);
    graph.nodes.push_back(node);
    way_m_ += way_m;
    scans.add(surface_points(test::scan_at(walls, at, 0, random), {}, {}, {}).surface, way_m_, false);
  }
  double way_m_ = 0;
};

/// The search knew a few metres of the old visit only: where the true place was not among them, another that looked
/// alike was alone, and a corridor was folded by 8 m. All the same it must find what there is.
TEST(LoopCloser, SlidesAlongNoCorridor) {
  int found = 0, wrong = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    std::mt19937_64 random(seed);
    const double begin_m = uniform(random, -6, 14), off_m = uniform(random, -4, 4);
    const TwoVisits visits(begin_m, off_m, random);
    LoopCloser closer{SlamParams{}};
    const int last = static_cast<int>(visits.truth.size()) - 1;
    bool seen_again = false;
    for (int node = last - 4; node <= last; node += 2)
      for (const PoseEdge& edge : closer.close(visits.graph, visits.scans, node).edges) {
        const Pose2 truth = visits.truth[static_cast<std::size_t>(edge.from)].inverse() *
                            visits.truth[static_cast<std::size_t>(edge.to)];
        const double off = (edge.T_from_to.translation() - truth.translation()).norm();
        wrong += off > 0.3;
        seen_again = true;
        EXPECT_LT(off, 0.3) << "seed " << seed << ", second visit from " << begin_m << " m, graph off by " << off_m;
      }
    inside += begin_m > 0 && begin_m < 3;
    found += seen_again && begin_m > 0 && begin_m < 3;
  }
  EXPECT_EQ(wrong, 0);
  ASSERT_GT(inside, 1);
  EXPECT_EQ(found, inside);
}

TEST(LoopCloser, GivesNothingForACorridorWithoutAnyMark) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    std::mt19937_64 random(seed);
    const std::vector<Segment2> bare{{{-30, -1.1}, {60, -1.1}}, {{60, 1.1}, {-30, 1.1}}};
    PoseGraph graph;
    NodeScans scans;
    for (int i = 0; i < 30; ++i) {
      const bool second = i >= 15;
      PoseNode node;
      node.id = i;
      node.T_map_robot = Pose2(0.4 * (second ? i - 13 : i) + (second ? 2.0 : 0), 0, 0);
      if (i > 0)
        graph.edges.push_back(step_between(i - 1, i, graph.nodes.back().T_map_robot.inverse() * node.T_map_robot,
                                           i == 15 ? 2.5 : 0.01, i == 15 ? 0.05 : 0.003));
      graph.nodes.push_back(node);
      scans.add(
          surface_points(test::scan_at(bare, Pose2(0.4 * (second ? i - 15 : i), 0, 0), 0, random), {}, {}, {}).surface,
          0.4 * i + (second ? 60 : 0), false);
    }
    LoopCloser closer{SlamParams{}};
    for (const int node : {20, 24, 29})
      for (const PoseEdge& edge : closer.close(graph, scans, node).edges)  // across it may tie, along it must not claim
        EXPECT_LT(edge.sqrt_information.row(0).norm(), 3) << seed;
  }
}

}  // namespace
}  // namespace smokemap
