#include <gtest/gtest.h>

#include <cmath>

#include "slam/align.hpp"
#include "slam/graph_edge_cost.hpp"
#include "slam/motion_model.hpp"
#include "slam/pose_search.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

Pose2 random_pose(std::mt19937_64& random, double half_m, double half_rad) {
  return {uniform(random, -half_m, half_m), uniform(random, -half_m, half_m), uniform(random, -half_rad, half_rad)};
}

TEST(PointToLine, HasTheDerivativeItSays) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Pose2 T = random_pose(random, 5, 3);
    const Point2 p(uniform(random, -5, 5), uniform(random, -5, 5)), q(uniform(random, -5, 5), 1);
    const double a = uniform(random, -3, 3);
    const Point2 n(std::cos(a), std::sin(a));
    const PointToLine row = point_to_line(p, q, n, T);
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d up = T.vector(), down = T.vector();
      up[k] += 1e-6;
      down[k] -= 1e-6;
      const double numeric = (point_to_line(p, q, n, {up.x(), up.y(), up.z()}).residual_m -
                              point_to_line(p, q, n, {down.x(), down.y(), down.z()}).residual_m) /
                             2e-6;
      EXPECT_NEAR(row.jacobian[k], numeric, 1e-6);
    }
  }
}

TEST(GraphEdgeCost, HasTheDerivativesItSays) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::Matrix3d root = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 9; ++i) root(i / 3, i % 3) += uniform(random, -0.5, 0.5);
    const GraphEdgeCost cost(random_pose(random, 1, 0.5), root);
    Eigen::Vector3d x[2] = {random_pose(random, 3, 3).vector(), random_pose(random, 3, 3).vector()};
    const double* poses[2] = {x[0].data(), x[1].data()};
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> J[2];
    double* jacobians[2] = {J[0].data(), J[1].data()};
    Eigen::Vector3d r, up, down;
    ASSERT_TRUE(cost.Evaluate(poses, r.data(), jacobians));
    if (std::abs(wrap_angle(x[1].z() - x[0].z())) > 2.5) continue;  // the wrap is no derivative
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k) {
        x[side][k] += 1e-6;
        cost.Evaluate(poses, up.data(), nullptr);
        x[side][k] -= 2e-6;
        cost.Evaluate(poses, down.data(), nullptr);
        x[side][k] += 1e-6;
        EXPECT_LT((J[side].col(k) - (up - down) / 2e-6).norm(), 1e-5);
      }
  }
}

TEST(GraphEdgeCost, IsZeroAtTheMeasurementAndInStandardDeviations) {
  const Pose2 a(1, 2, 0.7), z(0.5, -0.2, 0.3), b = a * z;
  const Eigen::Matrix3d root = Eigen::Vector3d(10, 10, 100).asDiagonal();  // 0.1 m, 0.01 rad
  const Eigen::Vector3d va = a.vector(), vb = b.vector(), off = (a * z * Pose2(0, 0, 0.02)).vector();
  const double *exact[2] = {va.data(), vb.data()}, *turned[2] = {va.data(), off.data()};
  Eigen::Vector3d r;
  GraphEdgeCost(z, root).Evaluate(exact, r.data(), nullptr);
  EXPECT_LT(r.norm(), 1e-12);
  GraphEdgeCost(z, root).Evaluate(turned, r.data(), nullptr);
  EXPECT_NEAR(r.norm(), 2, 1e-9);
}

TEST(PoseSearch, FindsWhatTryingAllFinds) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Point2> known, points;
    for (int i = 0; i < 30; ++i) known.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1));
    const Pose2 hidden = random_pose(random, 0.3, 0.2);
    for (int i = 0; i < 30; i += 2) points.push_back(hidden.inverse() * known[static_cast<std::size_t>(i)]);
    const LikelihoodGrid grid(known, 0.1, 0.1, 4);
    const auto found = search_pose(points, grid, {Pose2(), 0.5, 0.3}, 0.01);
    ASSERT_TRUE(found);
    double farthest = 0.1, best = 0;
    for (const Point2& p : points) farthest = std::max(farthest, p.norm());
    const double step = 2 * std::asin(0.05 / farthest);
    const int angles = static_cast<int>(std::ceil(0.3 / step));
    for (int a = -angles; a <= angles; ++a)
      for (int y = -5; y <= 5; ++y)
        for (int x = -5; x <= 5; ++x) {
          double sum = 0;
          for (const Point2& p : points) {
            const Cell c = grid.frame().cell_of(Pose2(0, 0, a * step) * p);
            sum += grid.most(0, c.x + x, c.y + y);
          }
          best = std::max(best, sum / (255.0 * static_cast<double>(points.size())));
        }
    EXPECT_NEAR(found->score, best, 1e-12);
  }
}

TEST(PoseSearch, SaysHowGoodTheSecondBestPlaceIs) {
  std::vector<Point2> known, points;
  for (int i = 0; i < 10; ++i) {
    points.emplace_back(0.1 * i, 0.0);
    points.emplace_back(0.0, 0.1 * i);
  }
  for (const Point2& p : points) {
    known.push_back(p);
    known.push_back(p + Point2(2, 0));  // the same corner again
  }
  const LikelihoodGrid twice(known, 0.1, 0.1, 5), once(points, 0.1, 0.1, 5);
  const auto doubtful = search_pose(points, twice, {Pose2(1, 0, 0), 1.5, 0.1}, 0.3, 0.6);
  const auto certain = search_pose(points, once, {Pose2(1, 0, 0), 1.5, 0.1}, 0.3, 0.6);
  ASSERT_TRUE(doubtful && certain);
  EXPECT_GT(doubtful->runner_up_score, 0.92 * doubtful->score);
  EXPECT_LT(certain->runner_up_score, 0.92 * certain->score);
}

TEST(PoseSearch, HasNoAnswerBelowTheLeastScore) {
  const LikelihoodGrid grid({{0, 0}}, 0.1, 0.1, 3);
  EXPECT_FALSE(search_pose({{5, 5}, {-5, 5}}, grid, {Pose2(), 0.3, 0.1}, 0.2));
  EXPECT_FALSE(search_pose({}, grid, {Pose2(), 0.3, 0.1}, 0.0));
}

/// A robot in the ring of corridors, its scan and a map of the same place.
struct MatchFixture : testing::Test {
  std::mt19937_64 random{4};
  std::vector<Segment2> walls = test::ring_of_corridors();
  SlamParams params;
  SurfaceMap map{0.1};
  std::vector<SurfacePoint> points(const Pose2& at) {
    return surface_points(test::scan_at(walls, at, 0, random), params.beams, {}, params.points).surface;
  }
  void SetUp() override {
    map.reset({7, 5}, 20);
    for (const Pose2& at : {Pose2(12.5, 1, 0), Pose2(13, 1.2, 0.3), Pose2(13, 1, 1.2)}) map.add(points(at), at);
  }
};

TEST_F(MatchFixture, AlignsToAFewMillimetres) {
  for (int trial = 0; trial < 30; ++trial) {
    const Pose2 truth(13 + uniform(random, -0.3, 0.3), 1 + uniform(random, -0.3, 0.3), uniform(random, -0.5, 1.0));
    const Pose2 guess = truth * random_pose(random, 0.12, 0.06);
    const ScanAlignment found = align(points(truth), map, guess, params.align);
    EXPECT_THAT(found.T_map_robot, IsNear(truth, 0.012, 0.006));
    EXPECT_GT(found.score, 0.6);
  }
}

TEST_F(MatchFixture, HasNoScoreWhereThereIsNoMap) {
  const ScanAlignment found = align(points(Pose2(1, 9, 0)), map, Pose2(100, 100, 0), params.align);
  EXPECT_EQ(found.matched, 0);
  EXPECT_EQ(found.score, 0);
}

TEST_F(MatchFixture, KnowsThatACorridorSaysNothingAlongItself) {
  const std::vector<Segment2> corridor{{{-30, -1}, {30, -1}}, {{30, 1}, {-30, 1}}};
  map.reset({0, 0}, 20);
  const auto scan = surface_points(test::scan_at(corridor, {}, 0, random), params.beams, {}, params.points).surface;
  map.add(scan, {});
  const ScanAlignment found = align(scan, map, {}, params.align);
  EXPECT_LT(found.information(0, 0), 0.05 * found.information(1, 1));
}

TEST(SurfacePoints, StraightenAScanTakenWhileTurning) {
  std::mt19937_64 random(5);
  const auto walls = test::ring_of_corridors();
  const Twist2 twist{{0.5, 0}, 1.0};
  LaserScan scan = test::scan_at(walls, {13, 1, 0}, 0, random);
  const double time_increment = 0.1 / 180;
  for (std::size_t i = 0; i < 180; ++i) {
    const Pose2 at = Pose2(13, 1, 0) * twist.after(static_cast<double>(i) * time_increment);
    scan.ranges_m[i] = static_cast<float>(
        test::cast(walls, at.translation(), at.heading() - kPi + static_cast<double>(i) * 2 * kPi / 180, 12));
  }
  const auto off_wall = [&](const ScanPoints& points) {
    double worst = 0;
    for (const Point2& p : *points.hits_robot) {
      double best = 9;
      for (const Segment2& wall : walls) best = std::min(best, distance(wall, Pose2(13, 1, 0) * p));
      worst = std::max(worst, best);
    }
    return worst;
  };
  const double bent = off_wall(surface_points(scan, {}, {}, {}));
  scan.time_increment_s = time_increment;
  EXPECT_LT(off_wall(surface_points(scan, {}, twist, {})), 0.005);
  EXPECT_GT(bent, 0.05);
}

TEST(SurfacePoints, LeaveOutUnknownBeamsAndKeepFreeOnesApart) {
  LaserScan scan;
  scan.angle_increment_rad = 0.01;
  scan.range_min_m = 0.1;
  scan.range_max_m = 10;
  scan.ranges_m.assign(100, 2.0f);
  for (std::size_t i = 0; i < 40; ++i) scan.ranges_m[i] = i % 2 ? std::numeric_limits<float>::infinity() : 0.0f;
  BeamConvention clear_air;
  clear_air.no_return_is_free = true;
  EXPECT_TRUE(surface_points(scan, {}, {}, {}).free_ends_robot->empty());
  const ScanPoints points = surface_points(scan, clear_air, {}, {});
  EXPECT_EQ(points.free_ends_robot->size(), 20u);
  for (const Point2& p : *points.hits_robot) EXPECT_NEAR(p.norm(), 2, 1e-6);
}

TEST(OdometryBuffer, PrefersTheExactStampThenThePairAround) {
  OdometryBuffer buffer;
  EXPECT_FALSE(buffer.at(0));
  buffer.add({from_seconds(1), "r", Pose2(1, 0, 0), 0, 0});
  buffer.add({from_seconds(2), "r", Pose2(2, 0, 0), 0, 0});
  buffer.add({from_seconds(1.4), "r", Pose2(7, 0, 0), 0, 0});  // a stamp that steps back
  EXPECT_THAT(*buffer.at(from_seconds(1.4)), IsNear(Pose2(7, 0, 0), 1e-9, 1e-9));
  EXPECT_THAT(*buffer.at(from_seconds(1.5)), IsNear(Pose2(1.5, 0, 0), 1e-6, 1e-9));
}

TEST(OdometryBuffer, MovesOnForHalfASecondAtMost) {
  OdometryBuffer buffer;
  buffer.add({from_seconds(0), "r", Pose2(0, 0, 0), 0, 0});
  buffer.add({from_seconds(0.1), "r", Pose2(0.1, 0, 0), 0, 0});
  EXPECT_THAT(*buffer.at(from_seconds(0.2)), IsNear(Pose2(0.2, 0, 0), 1e-6, 1e-9));
  EXPECT_THAT(*buffer.at(from_seconds(9)), IsNear(Pose2(0.6, 0, 0), 1e-6, 1e-9));
}

TEST(PredictStep, DoesNotBelieveATeleport) {
  const FrontEndParams params;
  const auto step = predict_step(Pose2(), Pose2(25, 0, 0), 0.1, Twist2{{1, 0}, 0}, params);
  EXPECT_TRUE(step.jumped);
  EXPECT_THAT(step.T_before_now, IsNear(Pose2(0.1, 0, 0), 1e-9, 1e-9));
  EXPECT_FALSE(predict_step(Pose2(), Pose2(0.2, 0, 0), 0.1, {}, params).jumped);
}

}  // namespace
}  // namespace smokemap
