#include "grids/grid_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/support/ndt_grid.hpp"

namespace smokemap {
namespace {

Eigen::Vector2d drawn_point(std::mt19937_64& random, double half_m) {
  return {uniform(random, -half_m, half_m), uniform(random, -half_m, half_m)};
}

TEST(GridFrame, EveryPointLiesInItsCellAndEveryCentreFindsItsCellAgain) {
  std::mt19937_64 random(1);
  GridFrame frame;
  frame.resolution_m = 0.07;
  frame.origin = {-3.1, 8.3};
  frame.width_cells = 40;
  frame.height_cells = 30;
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector2d p = drawn_point(random, 20);
    const Cell cell = frame.cell_of(p);
    EXPECT_EQ(frame.cell_of(frame.center_of(cell)), cell);
    EXPECT_LE((frame.center_of(cell) - p).cwiseAbs().maxCoeff(), 0.5 * frame.resolution_m + 1e-9);
  }
}

TEST(GridFrame, IndicesOfItsCellsAreAllDifferentAndBelowTheirCount) {
  GridFrame frame;
  frame.width_cells = 7;
  frame.height_cells = 5;
  std::vector<bool> seen(frame.cell_count(), false);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x) {
      ASSERT_TRUE(frame.contains({x, y}));
      ASSERT_FALSE(seen.at(frame.index({x, y})));
      seen[frame.index({x, y})] = true;
    }
  EXPECT_FALSE(frame.contains({7, 0}));
  EXPECT_FALSE(frame.contains({0, 5}));
  EXPECT_FALSE(frame.contains({-1, 0}));
}

TEST(GridFrame, AroundCornersHoldsThemWithTheirMarginOnWholeCells) {
  std::mt19937_64 random(2);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector2d a = drawn_point(random, 30), b = drawn_point(random, 30);
    const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
    const double margin = uniform(random, 0, 2);
    const GridFrame frame = frame_around(low, high, 0.25, margin);
    EXPECT_TRUE(frame.contains(frame.cell_of(low - Eigen::Vector2d::Constant(margin - 1e-6))));
    EXPECT_TRUE(frame.contains(frame.cell_of(high + Eigen::Vector2d::Constant(margin - 1e-6))));
    for (int axis = 0; axis < 2; ++axis) {
      const double cells = frame.origin[axis] / 0.25;
      EXPECT_NEAR(cells, std::round(cells), 1e-6);
    }
    EXPECT_LE(frame.width_cells, (high.x() - low.x() + 2 * margin) / 0.25 + 3);
  }
}

TEST(PixelFrame, ThereAndBackIsWhereItBegan) {
  std::mt19937_64 random(3);
  const PixelFrame frame{480, 0.037};
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector2d p = drawn_point(random, 500);
    EXPECT_LT((frame.to_pixels(frame.to_metres(p)) - p).norm(), 1e-9);
  }
  EXPECT_LT(frame.to_metres({0, 479}).norm(), 1e-12);       // the lowest left pixel
  EXPECT_GT(frame.to_metres({0, 0}).y(), 0);                // up is up
  EXPECT_NEAR(frame.to_metres({100, 479}).x(), 3.7, 1e-9);  // and right is right
}

TEST(NdtGrid, CellsOfNegativePlacesStayApart) {
  NdtGrid grid(0.5);
  for (const double x : {-0.75, -0.25, 0.25, 0.75})
    for (const double y : {-0.75, -0.25, 0.25, 0.75}) grid.add_point({x, y});
  EXPECT_EQ(grid.cells().size(), 16u);
  for (const Cell cell : grid.cells()) EXPECT_LT((grid.find(cell)->mean - grid.center_of(cell)).norm(), 1e-12);
}

TEST(NdtGrid, AGaussianNeedsThreePointsAndMoreHitsThanPasses) {
  NdtGrid grid(1.0);
  grid.add_point({0.5, 0.5});
  grid.add_point({0.6, 0.5});
  EXPECT_FALSE(grid.at({0.5, 0.5})->has_gaussian());
  grid.add_point({0.7, 0.5});
  EXPECT_TRUE(grid.at({0.5, 0.5})->has_gaussian());
  EXPECT_NEAR(std::abs(std::cos(grid.at({0.5, 0.5})->main_direction())), 1, 1e-9);
  for (int k = 0; k < 100; ++k) grid.add_free({-3, 0.5}, {3.5, 0.5});
  EXPECT_FALSE(grid.at({0.5, 0.5})->has_gaussian());
}

TEST(NdtGrid, CovarianceOfAWallKeepsASmallestWidth) {
  NdtGrid grid(1.0);
  for (int k = 0; k < 20; ++k) grid.add_point({0.025 + 0.05 * k, 0.5});
  const Eigen::Matrix2d covariance = grid.at({0.5, 0.5})->covariance(0.01);
  EXPECT_NEAR(covariance(1, 1), 0.01 * covariance(0, 0), 1e-12);
  EXPECT_NEAR(covariance(0, 1), 0, 1e-12);
}

}  // namespace
}  // namespace smokemap
