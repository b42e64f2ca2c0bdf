#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "grids/distance_map.hpp"
#include "grids/log_odds_grid.hpp"
#include "grids/ray.hpp"
#include "tests/support/ndt_grid.hpp"

namespace smokemap {
namespace {

using Eigen::Vector2d;

Vector2d anywhere(std::mt19937_64& random, double half) {
  return {uniform(random, -half, half), uniform(random, -half, half)};
}

TEST(WalkRay, PassesEveryCellThatSamplesOfTheLineLieIn) {
  std::mt19937_64 random(1);
  GridFrame frame{0.1, {0, 0}, 0, 0};
  for (int trial = 0; trial < 300; ++trial) {
    const Vector2d from = anywhere(random, 3), to = anywhere(random, 3);
    std::vector<Cell> walked;
    walk_ray(frame, from, to, [&](Cell c) { return walked.push_back(c), true; });
    EXPECT_EQ(walked.front(), frame.cell_of(from));
    EXPECT_EQ(walked.back(), frame.cell_of(to));
    for (std::size_t i = 1; i < walked.size(); ++i)
      EXPECT_EQ(std::abs(walked[i].x - walked[i - 1].x) + std::abs(walked[i].y - walked[i - 1].y), 1);
    for (int k = 0; k <= 500; ++k) {
      const Vector2d p = from + (to - from) * (k / 500.0);
      const Vector2d in_cells = p / frame.resolution_m, off = in_cells - Vector2d(in_cells.array().round());
      if (off.cwiseAbs().minCoeff() < 1e-6) continue;  // on a border both cells are right
      EXPECT_NE(std::find(walked.begin(), walked.end(), frame.cell_of(p)), walked.end());
    }
  }
}

TEST(WalkRay, StopsWhenTold) {
  int visits = 0;
  walk_ray(GridFrame{0.1, {0, 0}, 0, 0}, {0.05, 0.05}, {5.05, 0.05}, [&](Cell) { return ++visits < 3; });
  EXPECT_EQ(visits, 3);
}

TEST(LogOddsGrid, ABeamClearsItsWayAndFillsItsEnd) {
  LogOddsGrid grid(0.1);
  grid.add_hit({0.05, 0.05}, {1.05, 0.05});
  const GridFrame& frame = grid.frame();
  EXPECT_LT(grid.log_odds(frame.cell_of({0.55, 0.05})), 0);
  EXPECT_GT(grid.log_odds(frame.cell_of({1.05, 0.05})), 0);
  EXPECT_FALSE(grid.seen(frame.cell_of({1.15, 0.05})));
  EXPECT_EQ(grid.occupancy().get(grid.occupancy().frame().cell_of({0.55, 0.55})), OccupancyGrid::kUnknown);
}

TEST(LogOddsGrid, TakingBackWhatWasAddedLeavesNothing) {
  std::mt19937_64 random(2);
  LogOddsGrid kept(0.05), both(0.05);
  std::vector<std::pair<Vector2d, Vector2d>> beams;
  for (int i = 0; i < 100; ++i) beams.emplace_back(anywhere(random, 4), anywhere(random, 4));
  for (std::size_t i = 0; i < 100; ++i) {
    if (i < 50) kept.add_hit(beams[i].first, beams[i].second);
    i % 3 == 2 && i >= 50 ? both.add_free(beams[i].first, beams[i].second)
                          : both.add_hit(beams[i].first, beams[i].second);
  }
  for (std::size_t i = 50; i < 100; ++i)
    i % 3 == 2 ? both.remove_free(beams[i].first, beams[i].second) : both.remove_hit(beams[i].first, beams[i].second);
  const OccupancyGrid a = kept.occupancy(), b = both.occupancy();
  EXPECT_EQ(a.frame().width_cells, b.frame().width_cells);
  EXPECT_LT((a.frame().origin - b.frame().origin).norm(), 1e-9);
  EXPECT_EQ(a.cells(), b.cells());
}

TEST(LogOddsGrid, GrowsWithoutForgetting) {
  LogOddsGrid grid(0.1);
  grid.add_hit({0, 0}, {1, 1});
  const double before = grid.log_odds(grid.frame().cell_of({1, 1}));
  grid.add_hit({0, 0}, {-90, 60});
  EXPECT_DOUBLE_EQ(grid.log_odds(grid.frame().cell_of({1, 1})), before);
  EXPECT_TRUE(grid.occupancy().get(grid.occupancy().frame().cell_of({-90, 60})) > 50);
}

TEST(LogOddsGrid, IgnoresBeamsThatAreNotFinite) {
  LogOddsGrid grid(0.1);
  grid.add_hit({0, 0}, {std::nan(""), 1});
  EXPECT_TRUE(grid.occupancy().empty());
}

TEST(NdtGrid, CellsHoldMeanAndCovarianceOfTheirPoints) {
  std::mt19937_64 random(3);
  NdtGrid grid(1.0);
  std::vector<Vector2d> points;
  for (int i = 0; i < 200; ++i) points.emplace_back(0.1 + 0.8 * uniform01(random), 0.5 + normal(random, 0.02));
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& p : points) {
    grid.add_point(p);
    mean += p / 200;
  }
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();
  for (const Vector2d& p : points) cov += (p - mean) * (p - mean).transpose() / 199;
  const NdtCell* cell = grid.at({0.5, 0.5});
  ASSERT_NE(cell, nullptr);
  EXPECT_TRUE(cell->has_gaussian());
  EXPECT_LT((cell->mean - mean).norm(), 1e-9);
  EXPECT_LT((cell->covariance(0) - cov).norm(), 1e-9);
  EXPECT_NEAR(std::sin(cell->main_direction()), 0, 0.05);
}

TEST(NdtGrid, RemembersWhatIsFree) {
  NdtGrid grid(0.5);
  for (int i = 0; i < 5; ++i) grid.add_hit({0.25, 0.25}, {4.25, 0.25});
  EXPECT_LT(grid.at({2.25, 0.25})->log_odds, 0);
  EXPECT_GT(grid.at({4.25, 0.25})->log_odds, 0);
  EXPECT_EQ(grid.at({4.75, 0.25}), nullptr);
  EXPECT_EQ(grid.cells().size(), 9u);
}

TEST(DistanceMap, EqualsBruteForceNearSegments) {
  std::mt19937_64 random(4);
  std::vector<EndPoints> segments;
  for (int i = 0; i < 8; ++i) segments.emplace_back(anywhere(random, 3), anywhere(random, 3));
  const DistanceMap map = DistanceMap::from_segments(segments, 0.05, 1.0);
  const auto brute = [&](const Vector2d& p) {
    double best = 1.0;
    for (const auto& [a, b] : segments) {
      const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      best = std::min(best, (a + t * (b - a) - p).norm());
    }
    return best;
  };
  for (int i = 0; i < 500; ++i) {
    const Vector2d p = anywhere(random, 4);
    EXPECT_NEAR(map.at(p), brute(p), 0.04);  // bilinear over cells of 5 cm
  }
}

TEST(DistanceMap, GradientIsTheDerivative) {
  std::mt19937_64 random(5);
  const DistanceMap map = DistanceMap::from_segments({{{-2, 0}, {2, 0.5}}}, 0.1, 1.5);
  for (int i = 0; i < 100; ++i) {
    const Vector2d p = map.frame().center_of(map.frame().cell_of(anywhere(random, 1))) + Vector2d(0.023, 0.031);
    const double h = 1e-5;
    const Vector2d numeric((map.at(p + Vector2d(h, 0)) - map.at(p - Vector2d(h, 0))) / (2 * h),
                           (map.at(p + Vector2d(0, h)) - map.at(p - Vector2d(0, h))) / (2 * h));
    EXPECT_LT((map.gradient(p) - numeric).norm(), 1e-5);
  }
}

TEST(DistanceMap, FromOccupiedCellsAndFarAway) {
  OccupancyGrid grid(GridFrame{0.1, {0, 0}, 50, 50}, 0);
  grid.at({25, 25}) = 100;
  const DistanceMap map = DistanceMap::from_occupied(grid, 1.0);
  EXPECT_NEAR(map.at(grid.frame().center_of({25, 25})), 0, 1e-6);
  EXPECT_NEAR(map.at(grid.frame().center_of({30, 25})), 0.5, 1e-6);
  EXPECT_DOUBLE_EQ(map.at({-50, 0}), 1.0);
  EXPECT_DOUBLE_EQ(DistanceMap().at({0, 0}), 0.0);
  EXPECT_DOUBLE_EQ(DistanceMap::from_segments({}, 0.1, 2.0).at({0, 0}), 2.0);
}

TEST(LogOddsGrid, TheGrazedEndOfABeamSaysNothingAndIsTakenBackExactly) {
  LogOddsGrid grid(0.1);
  grid.add_hit({0.05, 0.05}, {1.05, 0.05}, 0.35);
  const auto at = [&](double x) { return grid.log_odds(grid.frame().cell_of({x, 0.05})); };
  EXPECT_GT(at(1.05), 0);
  for (const double x : {0.95, 0.85, 0.75}) EXPECT_FALSE(grid.seen(grid.frame().cell_of({x, 0.05}))) << x;
  for (const double x : {0.05, 0.35, 0.65}) EXPECT_LT(at(x), 0) << x;
  grid.remove_hit({0.05, 0.05}, {1.05, 0.05}, 0.35);
  EXPECT_TRUE(grid.occupancy().empty());
}

}  // namespace
}  // namespace smokemap
