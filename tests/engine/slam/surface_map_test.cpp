#include "slam/surface_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "slam/align.hpp"
#include "slam/likelihood_grid.hpp"
#include "slam/node_scans.hpp"
#include "slam/principal_line.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

std::vector<SurfacePoint> random_surface(std::mt19937_64& random, int count, double reach_m) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double turn = uniform(random, -kPi, kPi);
    points.push_back({{uniform(random, -reach_m, reach_m), uniform(random, -reach_m, reach_m)},
                      {std::cos(turn), std::sin(turn)},
                      uniform(random, 0.5, 3)});
  }
  return points;
}

std::vector<SurfaceMap::Surface> all_surfaces(const SurfaceMap& map) {
  std::vector<SurfaceMap::Surface> all;
  map.for_each([&](const SurfaceMap::Surface& s) { all.push_back(s); });
  return all;
}

TEST(SurfaceMap, FindsTheNearestThatTryingAllFinds) {
  std::mt19937_64 random(1);
  SurfaceMap map(0.1);
  map.reset({0, 0}, 4);
  map.add(random_surface(random, 500, 3), {});
  const auto all = all_surfaces(map);
  int found_any = 0;
  for (int i = 0; i < 1000; ++i) {
    const Point2 p(uniform(random, -4, 4), uniform(random, -4, 4));
    const double turn = uniform(random, -kPi, kPi), gate = uniform(random, 0.05, 0.8);
    const bool any = uniform01(random) < 0.3;
    const Point2 normal = any ? Point2(0, 0) : Point2(std::cos(turn), std::sin(turn));
    double best = gate;
    for (const auto& s : all)
      if (any || s.normal.dot(normal) >= 0.7) best = std::min(best, (s.p - p).norm());
    SurfaceMap::Surface found;
    const bool is_found = map.nearest(p, normal, gate, 0.7, found);
    ASSERT_EQ(is_found, best < gate);
    if (is_found) {
      EXPECT_NEAR((found.p - p).norm(), best, 1e-12);
    }
    found_any += is_found;
  }
  EXPECT_GT(found_any, 300);
}

TEST(SurfaceMap, AveragesByWeightAndKeepsTheFacesOfAThinWallApart) {
  SurfaceMap map(0.1);
  map.reset({0, 0}, 2);
  map.add({{{0.02, 0.05}, {0, 1}, 1}, {{0.06, 0.07}, {0, 1}, 3}, {{0.05, 0.03}, {0, -1}, 1}}, {});
  ASSERT_EQ(map.size(), 2u);
  SurfaceMap::Surface upper, lower;
  ASSERT_TRUE(map.nearest({0.05, 0.05}, {0, 1}, 0.3, 0.7, upper));
  ASSERT_TRUE(map.nearest({0.05, 0.05}, {0, -1}, 0.3, 0.7, lower));
  EXPECT_LT((upper.p - Point2(0.05, 0.065)).norm(), 1e-12);
  EXPECT_EQ(upper.weight, 4);
  EXPECT_LT((lower.p - Point2(0.05, 0.03)).norm(), 1e-12);
}

TEST(SurfaceMap, LeavesOutPointsWithoutDirectionAndPlacesOutside) {
  SurfaceMap map(0.1);
  SurfaceMap::Surface found;
  EXPECT_TRUE(map.empty());
  EXPECT_FALSE(map.covers({0, 0}, 0));
  map.reset({5, 5}, 1);
  map.add({{{5, 5}, {0, 0}, 1}, {{9, 9}, {1, 0}, 1}, {{-1e9, 0}, {1, 0}, 1}}, {});
  EXPECT_TRUE(map.empty());
  EXPECT_FALSE(map.nearest({5, 5}, {0, 0}, 1, 0.7, found));
  EXPECT_TRUE(map.covers({5, 5}, 0.5));
  EXPECT_FALSE(map.covers({5.8, 5}, 0.5));
}

TEST(SurfaceMap, IsAsGoodAsNewAfterAReset) {
  std::mt19937_64 random(2);
  SurfaceMap used(0.1), fresh(0.1);
  used.reset({0, 0}, 3);
  used.add(random_surface(random, 300, 3), {});
  const auto points = random_surface(random, 200, 2);
  for (SurfaceMap* map : {&used, &fresh}) {
    map->reset({1, 1}, 3);
    map->add(points, Pose2(0.3, -0.2, 0.7));
  }
  const auto a = all_surfaces(used), b = all_surfaces(fresh);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ((a[i].p - b[i].p).norm(), 0);
}

/// Moving map, guess and prior together moves the answer along and changes nothing else. By whole cells, and by quarter
/// turns: the map averages in cells along its axes.
TEST(Align, IsMovedByAMoveOfEverything) {
  std::mt19937_64 random(3);
  const auto walls = test::ring_of_corridors();
  const Pose2 here(13, 1, 0.2), T(40 * 0.1, -70 * 0.1, kPi / 2);
  const auto surface = [&](const Pose2& at) {
    return surface_points(test::scan_at(walls, at, 0, random), {}, {}, {}).surface;
  };
  const auto known = surface(here), scan = surface(Pose2(13.05, 1.02, 0.25));
  SurfaceMap map(0.1), moved(0.1);
  map.reset({13, 1}, 15);
  map.add(known, here);
  moved.reset(T * Point2(13, 1), 15);
  moved.add(known, T * here);
  for (int i = 0; i < 10; ++i) {
    const Pose2 guess = here * Pose2(normal(random, 0.05), normal(random, 0.05), normal(random, 0.03));
    const ScanAlignment a = align(scan, map, guess, {}), b = align(scan, moved, T * guess, {});
    EXPECT_THAT(T * a.T_map_robot, IsNear(b.T_map_robot, 2e-3, 1e-3));
    EXPECT_NEAR(a.score, b.score, 0.02);
    EXPECT_NEAR(a.information.trace(), b.information.trace(), 0.02 * a.information.trace());
  }
}

TEST(Align, APriorHoldsWhatThePointsDoNotSay) {
  std::mt19937_64 random(4);
  const std::vector<Segment2> corridor{{{-30, -1}, {30, -1}}, {{30, 1}, {-30, 1}}};
  const auto scan = surface_points(test::scan_at(corridor, {}, 0, random), {}, {}, {}).surface;
  SurfaceMap map(0.1);
  map.reset({0, 0}, 15);
  map.add(scan, {});
  PosePrior prior{Pose2(0.5, 0.04, 0.01), Eigen::Vector3d(400, 400, 400).asDiagonal()};
  const Pose2 found = align(scan, map, prior.T_map_robot, {}, prior).T_map_robot;
  EXPECT_NEAR(found.x(), 0.5, 0.02);  // along: the prior's
  EXPECT_NEAR(found.y(), 0, 0.005);   // across: the walls'
  EXPECT_NEAR(found.heading(), 0, 0.003);
}

/// The information it claims is the curvature of what it minimizes.
TEST(Align, InformationIsTheCurvatureOfItsSum) {
  const std::vector<SurfacePoint> points{{{2, 1}, {-1, 0}, 1}, {{-1, 3}, {0, -1}, 2}, {{1, -2}, {0, 1}, 1}};
  SurfaceMap map(0.1);
  map.reset({0, 0}, 5);
  map.add(points, {});
  const AlignParams params;
  const ScanAlignment at_rest = align(points, map, {}, params);
  const auto half_sum = [&](const Eigen::Vector3d& v) {
    double sum = 0;
    for (const SurfacePoint& point : points) {
      const double r = point_to_line(point.p, point.p, point.normal, {v.x(), v.y(), v.z()}).residual_m;
      sum += 0.5 * point.weight * r * r / (params.sigma_point_m * params.sigma_point_m);
    }
    return sum;
  };
  const double h = 1e-4;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = h * Eigen::Vector3d::Unit(i), b = h * Eigen::Vector3d::Unit(k);
      const double numeric = (half_sum(a + b) - half_sum(a - b) - half_sum(b - a) + half_sum(-a - b)) / (4 * h * h);
      EXPECT_NEAR(at_rest.information(i, k), numeric, 0.01 * at_rest.information.diagonal().maxCoeff());
    }
}

TEST(LikelihoodGrid, CoarseLevelsHoldTheLargestValueOfTheirWindow) {
  std::mt19937_64 random(5);
  std::vector<Point2> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1));
  const LikelihoodGrid grid(points, 0.1, 0.1, 4);
  ASSERT_EQ(grid.levels(), 4);
  for (int level = 1; level < 4; ++level)
    for (int i = 0; i < 300; ++i) {
      const int x = static_cast<int>(uniform_index(random, 50)) - 12,
                y = static_cast<int>(uniform_index(random, 50)) - 12;
      int most = 0;
      for (int dy = 0; dy < 1 << level; ++dy)
        for (int dx = 0; dx < 1 << level; ++dx) most = std::max(most, grid.most(0, x + dx, y + dy));
      EXPECT_EQ(grid.most(level, x, y), most) << level << ": " << x << " " << y;
    }
}

TEST(LikelihoodGrid, FallsWithTheDistanceFromTheNearestPoint) {
  const LikelihoodGrid grid({{0.05, 0.05}, {0.95, 0.05}}, 0.1, 0.15, 1);
  for (int x = 0; x < 10; ++x) {
    const double away = std::min(std::abs(0.1 * x), std::abs(0.1 * x - 0.9));
    const Cell cell = grid.frame().cell_of({0.1 * x + 0.05, 0.05});
    EXPECT_NEAR(grid.most(0, cell.x, cell.y), away > 0.45 ? 0 : 255 * std::exp(-0.5 * away * away / 0.0225), 1.01) << x;
  }
}

TEST(PrincipalLine, IsTheSameWhereverThePointsAreAndHoweverTheyAreTurned) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 50; ++i) {
    const Pose2 T(uniform(random, -1e5, 1e5), uniform(random, -1e5, 1e5), uniform(random, -3, 3));
    PrincipalLine here, there;
    for (int k = 0; k < 40; ++k) {
      const Point2 p(uniform(random, -1, 1), normal(random, 0.05));
      const double weight = uniform(random, 0.1, 2);
      here.add(p, weight);
      there.add(T * p, weight);
    }
    const auto a = here.fit(), b = there.fit();
    EXPECT_LT((T * a.mean - b.mean).norm(), 1e-8);
    EXPECT_NEAR(std::abs((T.rotation() * a.normal).dot(b.normal)), 1, 1e-9);
    EXPECT_NEAR(a.rms_across_m, b.rms_across_m, 1e-7);
    EXPECT_NEAR(a.rms_along_m, b.rms_along_m, 1e-7);
    EXPECT_GT(a.rms_along_m, 5 * a.rms_across_m);
  }
}

TEST(NodeScans, KeepPointsToAMicrometre) {
  std::mt19937_64 random(7);
  NodeScans scans;
  const auto surface = random_surface(random, 100, 10);
  scans.add({}, 0, false);
  scans.add(surface, 1.5, true);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_TRUE(scans.empty(0));
  EXPECT_EQ(scans.way_m(1), 1.5);
  EXPECT_TRUE(scans.either_by_radar(0, 1));
  EXPECT_FALSE(scans.either_by_radar(0, 0));
  const auto kept = scans.surface(1);
  ASSERT_EQ(kept.size(), surface.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_LT((kept[i].p - surface[i].p).norm(), 2e-6);
    EXPECT_LT((kept[i].normal - surface[i].normal).norm(), 3e-5);
    EXPECT_NEAR(kept[i].weight, surface[i].weight, 1e-6);
    EXPECT_TRUE(kept[i].oriented());
  }
}

TEST(EdgeInformation, IsTurnedIntoTheFrameOfItsNodeAndNeverSurerThanItsSigmas) {
  Eigen::Matrix3d information = Eigen::Vector3d(1e4, 1, 1e5).asDiagonal();  // sure along x of the map
  const auto turned = edge_sqrt_information(information, kPi / 2, 0.01, 0.002);
  ASSERT_TRUE(turned);
  const Eigen::Matrix3d back = (turned->transpose() * *turned).inverse();  // covariance in the node's frame
  EXPECT_NEAR(back(1, 1), 1 / (1e4 + 1) + 1e-4, 1e-9);                     // the map's x is the node's -y
  EXPECT_NEAR(back(0, 0), 0.5 + 1e-4, 1e-9);
  EXPECT_NEAR(back(2, 2), 1 / (1e5 + 1) + 4e-6, 1e-12);
  const auto blind = edge_sqrt_information(Eigen::Matrix3d::Zero(), 0, 0.01, 0.002);
  ASSERT_TRUE(blind);
  EXPECT_LT(blind->norm(), 2);  // a metre where the points say nothing
}

}  // namespace
}  // namespace smokemap
