#include "slam/slam.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "slam/graph_solver.hpp"
#include "slam/render_map.hpp"
#include "slam/trajectory_error.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsNear;
using test::IsOk;

struct Drive {
  Trajectory truth;  ///< in the frame of the first pose
  std::vector<LaserScan> scans;
  std::vector<Odometry> odometry;
};

/// Two rounds through the ring of corridors; wheels that drift 4 degrees in 10 m.
Drive two_rounds(double step_m = 0.25, std::uint64_t seed = 1, int beams = 180) {
  std::mt19937_64 random(seed);
  const auto walls = test::ring_of_corridors();
  test::Wheels wheels(0.97, 0.007, 0.05, seed);
  Drive run;
  double seconds = 100;
  std::optional<Pose2> T_start_world;
  for (const Pose2& at : test::rounds(2, step_m)) {
    if (!T_start_world) T_start_world = at.inverse();
    run.odometry.push_back(wheels.read(at, seconds));
    run.scans.push_back(test::scan_at(walls, at, seconds, random, beams));
    run.truth.push_back({from_seconds(seconds), *T_start_world * at, Eigen::Matrix3d::Zero()});
    seconds += 0.5;
  }
  return run;
}

Slam drive(const Drive& run, bool with_odometry = true, SlamParams params = {}) {
  params.graph.polish_rounds = 1;
  Slam slam(params);
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    if (with_odometry) slam.add_odometry(run.odometry[i]);
    EXPECT_THAT(slam.add_scan(run.scans[i]), IsOk());
    if (i % 20 == 19) slam.optimize();
  }
  slam.polish();
  return slam;
}

double ate(const Slam& slam, const Drive& run) {
  const auto error = absolute_error(slam.trajectory(), run.truth);
  return error ? error->rmse_m : 1e9;
}

TEST(Slam, ClosesTheLoopOfTwoRoundsToCentimetres) {
  const Drive run = two_rounds();
  const Slam slam = drive(run);
  EXPECT_LT(ate(slam, run), 0.03);
  EXPECT_GT(slam.counters().loops_closed, 0);
  ASSERT_EQ(slam.trajectory().size(), run.scans.size());
  for (std::size_t i = 0; i < run.scans.size(); ++i) EXPECT_EQ(slam.trajectory()[i].stamp, run.scans[i].stamp);
}

TEST(Slam, BeatsItsOdometryWithoutAnyToo) {
  const Drive run = two_rounds(0.2, 2);
  const Slam slam = drive(run, false);
  EXPECT_LT(ate(slam, run), 0.05);
  EXPECT_EQ(slam.counters().without_odometry, static_cast<std::int64_t>(run.scans.size()) - 1);
}

TEST(Slam, BeginsWhereItIsTold) {
  const Drive run = two_rounds(0.6, 3);
  SlamParams params;
  params.T_map_start = Pose2(20, -7, 2.2);
  const Trajectory here = drive(run).trajectory(), there = drive(run, true, params).trajectory();
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_THAT(there[i].T_map_robot, IsNear(params.T_map_start * here[i].T_map_robot, 0.03, 0.01));
}

TEST(Slam, GivesTheSameBytesForTheSameCalls) {
  const Drive run = two_rounds(0.6, 4);
  const Trajectory a = drive(run).trajectory(), b = drive(run).trajectory();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d va = a[i].T_map_robot.vector(), vb = b[i].T_map_robot.vector();
    EXPECT_EQ(std::memcmp(va.data(), vb.data(), sizeof(double) * 3), 0);
  }
}

TEST(Slam, HoldsItsCourseThroughBlindScansAndSaysSo) {
  Drive run = two_rounds(0.25, 5);
  for (std::size_t i = 30; i < 36; ++i) run.scans[i].ranges_m.assign(180, std::numeric_limits<float>::quiet_NaN());
  const Slam slam = drive(run);
  EXPECT_EQ(slam.counters().too_few_points, 6);
  EXPECT_EQ(slam.trajectory().size(), run.scans.size());
  EXPECT_LT(ate(slam, run), 0.10);
}

TEST(Slam, SurvivesStampsThatStepBackAndDuplicates) {
  Drive run = two_rounds(0.25, 6);
  for (std::size_t i = 10; i + 1 < run.scans.size(); i += 10) {
    run.scans[i].stamp -= from_seconds(0.7);
    run.odometry[i].stamp = run.scans[i].stamp;
    run.truth[i].stamp = run.scans[i].stamp;
  }
  run.scans[21] = run.scans[20];
  run.truth[21] = run.truth[20];
  const Slam slam = drive(run);
  EXPECT_EQ(slam.counters().duplicates, 1);
  EXPECT_GT(slam.counters().stamps_back, 10);
  EXPECT_LT(ate(slam, run), 0.04);
}

TEST(Slam, BridgesAnOdometryThatTeleports) {
  Drive run = two_rounds(0.2, 7);
  for (std::size_t i = 60; i < run.odometry.size(); ++i)
    run.odometry[i].T_odom_robot = Pose2(100, 50, 1) * run.odometry[i].T_odom_robot;
  const Slam slam = drive(run);
  EXPECT_EQ(slam.counters().jumps, 1);
  EXPECT_LT(ate(slam, run), 0.05);
}

TEST(Slam, TakesScansThatChangeTheirNumberOfBeams) {
  Drive run = two_rounds(0.25, 8);
  const Drive wide = two_rounds(0.25, 8, 360);
  for (std::size_t i = 0; i < run.scans.size(); i += 2) run.scans[i] = wide.scans[i];
  EXPECT_LT(ate(drive(run), run), 0.03);
}

TEST(Slam, RefusesMalformedScansAndGoesOn) {
  Drive run = two_rounds(0.5, 9);
  Slam slam;
  LaserScan broken = run.scans[0];
  broken.angle_increment_rad = 0;
  EXPECT_THAT(slam.add_scan(broken), Fails(Errc::kCorrupt));
  EXPECT_THAT(slam.add_scan(run.scans[0]), IsOk());
  EXPECT_EQ(slam.counters().malformed, 1);
  EXPECT_EQ(slam.trajectory().size(), 1u);
}

TEST(Slam, SaysWhereOdometryBeganInTheMap) {
  const Drive run = two_rounds(0.5, 10);
  Slam slam;
  for (std::size_t i = 0; i < 30; ++i) {
    slam.add_odometry(run.odometry[i]);
    const auto outcome = slam.add_scan(run.scans[i]);
    ASSERT_TRUE(outcome);
    EXPECT_THAT(slam.T_map_odom() * run.odometry[i].T_odom_robot, IsNear(outcome->pose.T_map_robot, 1e-9, 1e-9));
  }
}

TEST(Slam, AnEmptyOneAnswersCalmly) {
  Slam slam;
  EXPECT_FALSE(slam.optimize());
  slam.polish();
  EXPECT_TRUE(slam.trajectory().empty());
  EXPECT_TRUE(slam.graph().nodes.empty());
  EXPECT_TRUE(render_map(slam.graph()).empty());
}

TEST(Slam, AKidnappedRobotSpoilsNothingAndIsCounted) {
  Drive run = two_rounds(0.25, 11);
  std::mt19937_64 random(1);
  const std::vector<Segment2> elsewhere{
      {{0, 0}, {5, 1}}, {{5, 1}, {3, 6}}, {{3, 6}, {-1, 4}}, {{-1, 4}, {0, 0}}, {{1, 1}, {1, 2}}};
  Slam slam;
  for (std::size_t i = 0; i < 60; ++i) (void)slam.add_scan(run.scans[i]).ok();
  for (int i = 0; i < 20; ++i)
    (void)slam.add_scan(test::scan_at(elsewhere, {2, 2.5, 0.02 * i}, 200 + 0.5 * i, random)).ok();
  slam.optimize();
  EXPECT_GE(slam.counters().poor_matches, 1);
  EXPECT_EQ(slam.counters().lost, 1);
  EXPECT_EQ(slam.counters().loops_closed, 0);
  EXPECT_EQ(slam.trajectory().size(), 80u);
}

// The graph.

PoseEdge edge_between(int from, int to, const Pose2& z, double sigma_m, double sigma_rad, EdgeKind kind) {
  PoseEdge edge;
  edge.from = from;
  edge.to = to;
  edge.T_from_to = z;
  edge.sqrt_information = Eigen::Vector3d(1 / sigma_m, 1 / sigma_m, 1 / sigma_rad).asDiagonal();
  edge.kind = kind;
  return edge;
}

TEST(PoseGraphSolve, HalfOfTheLoopsWrongAreOutvoted) {
  std::mt19937_64 random(12);
  PoseGraph graph;
  std::vector<Pose2> truth;
  for (const Pose2& at : test::rounds(2, 0.5)) truth.push_back(at);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    PoseNode node;
    node.id = static_cast<int>(i);
    if (i == 0) {
      node.T_map_robot = truth[0];
    } else {
      const Pose2 z =
          truth[i - 1].inverse() * truth[i] * Pose2(normal(random, 0.01), normal(random, 0.01), normal(random, 0.004));
      node.T_map_robot = graph.nodes.back().T_map_robot * z;
      graph.edges.push_back(edge_between(node.id - 1, node.id, z, 0.01, 0.004, EdgeKind::kMatched));
    }
    graph.nodes.push_back(node);
  }
  const int round = static_cast<int>(truth.size()) / 2;
  std::vector<std::size_t> wrong;
  for (int k = 0; k < 20; ++k) {
    const int i = 4 * k, j = i + round;
    Pose2 z = truth[static_cast<std::size_t>(i)].inverse() * truth[static_cast<std::size_t>(j)];
    if (k % 2) {
      wrong.push_back(graph.edges.size());
      z = Pose2(uniform(random, -4, 4) + 3, uniform(random, -4, 4) - 3, uniform(random, 0.3, 1)) * z;
    }
    graph.edges.push_back(edge_between(i, j, z, 0.03, 0.006, EdgeKind::kLoop));
  }
  const auto summary = solve_pose_graph(graph, {});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->rejected, static_cast<int>(wrong.size()));
  for (const std::size_t e : wrong) EXPECT_EQ(graph.edges[e].state, LinkState::kRejected);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_THAT(graph.nodes[i].T_map_robot, IsNear(truth[i], 0.5, 0.1));
}

TEST(PoseGraphSolve, LeavesTheGraphAloneWhenStopped) {
  PoseGraph graph;
  for (int i = 0; i < 2; ++i) {
    PoseNode node;
    node.T_map_robot = Pose2(3 * i, 0, 0);
    graph.nodes.push_back(node);
  }
  graph.edges.push_back(edge_between(0, 1, Pose2(1, 0, 0), 0.1, 0.1, EdgeKind::kMatched));
  std::stop_source stop;
  stop.request_stop();
  Progress progress;
  progress.stop = stop.get_token();
  EXPECT_THAT(solve_pose_graph(graph, {}, progress), Fails(Errc::kCancelled));
  EXPECT_EQ(graph.nodes[1].T_map_robot.x(), 3);
}

// The map.

TEST(RenderMap, KeptUpToDateEqualsDrawnAnew) {
  const Drive run = two_rounds(0.5, 13);
  Slam slam = drive(run);
  PoseGraph graph = slam.graph();
  RenderParams params;
  params.moved_m = 0;
  params.moved_rad = 0;
  MapRenderer renderer(params);
  std::mt19937_64 random(2);
  for (int round = 0; round < 4; ++round) {
    std::vector<Pose2> poses;
    for (const PoseNode& node : graph.nodes)
      poses.push_back(uniform01(random) < 0.3
                          ? node.T_map_robot * Pose2(normal(random, 0.2), normal(random, 0.2), normal(random, 0.1))
                          : node.T_map_robot);
    renderer.update(graph, poses);
    const OccupancyGrid kept = renderer.occupancy(), anew = render_map(graph, poses, params);
    EXPECT_EQ(kept.frame().width_cells, anew.frame().width_cells);
    EXPECT_EQ(kept.cells(), anew.cells());
  }
}

TEST(RenderMap, DrawsOnlyWhatMoved) {
  const Drive run = two_rounds(0.5, 14);
  Slam slam = drive(run);
  MapRenderer renderer;
  const auto all = static_cast<int>(slam.graph().nodes.size());
  EXPECT_EQ(renderer.update(slam.graph()), all);
  EXPECT_EQ(renderer.update(slam.graph()), 0);
  std::vector<Pose2> poses;
  for (const PoseNode& node : slam.graph().nodes) poses.push_back(node.T_map_robot);
  poses[3] = poses[3] * Pose2(0.1, 0, 0);
  EXPECT_EQ(renderer.update(slam.graph(), poses), 1);
}

TEST(RenderMap, HasWallsWhereTheWallsAre) {
  const Drive run = two_rounds(0.5, 15);
  const Slam slam = drive(run);
  const OccupancyGrid grid = render_map(slam.graph());
  const Pose2 T_map_world = Pose2(1, 1, 0).inverse();
  int walls = 0, near = 0;
  for (int y = 0; y < grid.frame().height_cells; ++y)
    for (int x = 0; x < grid.frame().width_cells; ++x) {
      if (grid.at({x, y}) < 65) continue;
      double best = 9;
      for (const Segment2& wall : test::ring_of_corridors())
        best = std::min(best, distance({T_map_world * wall.a, T_map_world * wall.b}, grid.frame().center_of({x, y})));
      ++walls;
      near += best < 0.08;
    }
  EXPECT_GT(walls, 800);
  EXPECT_GT(near, 0.98 * walls);
}

TEST(RenderedMaps, ASurfaceMetAtAGrazingAngleIsNotRubbedOutByTheBeamsAlongIt) {
  PoseGraph graph;
  for (int n = 0; n < 8; ++n) {
    PoseNode node;
    node.id = n;
    node.T_map_robot = Pose2(0.3 * n, 0, 0);
    std::vector<Point2> hits;  // a wall 0.27 m beside the way, ahead: from 60 degrees down to 4
    for (double angle = 1.05; angle > 0.07; angle -= 0.0175) hits.emplace_back(0.27 / std::tan(angle), 0.27);
    node.hits_robot = std::make_shared<const std::vector<Point2>>(std::move(hits));
    graph.nodes.push_back(node);
  }
  const OccupancyGrid grid = render_map(graph);
  int wall = 0, kept = 0, free = 0, cells = 0;
  for (double x = 0.5; x < 3.0; x += 0.05) {
    const int percent = grid.at(grid.frame().cell_of({x, 0.27}));
    ++wall, kept += percent >= 60;
    ++cells, free += grid.at(grid.frame().cell_of({x, 0.1})) <= 40;
  }
  EXPECT_GE(kept, 0.9 * wall);
  EXPECT_GE(free, 0.9 * cells) << "before it the way is free";
}

TEST(RenderedMaps, ShowWhatTheRadarSawBesideABlindLidarAndTakeItBack) {
  PoseGraph graph;
  PoseNode node;
  node.radar_hits_robot = std::make_shared<const std::vector<Point2>>(std::vector<Point2>{{2.02, 0.02}});
  graph.nodes.push_back(node);
  MapRenderer renderer;
  EXPECT_EQ(renderer.update(graph), 1);
  const OccupancyGrid grid = renderer.occupancy();
  EXPECT_GE(grid.at(grid.frame().cell_of({2.02, 0.02})), 60);
  graph.nodes[0].radar_hits_robot.reset();
  EXPECT_EQ(renderer.update(graph), 1);
  EXPECT_TRUE(renderer.occupancy().empty());
}

}  // namespace
}  // namespace smokemap
