#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/random.hpp"
#include "grids/distance_map.hpp"
#include "grids/log_odds_grid.hpp"
#include "grids/occupancy_grid.hpp"
#include "tests/support/ndt_grid.hpp"

namespace smokemap {
namespace {

using Eigen::Vector2d;

OccupancyGrid random_occupancy(std::mt19937_64& random, int width, int height) {
  OccupancyGrid grid(GridFrame{0.1, {-2, 3}, width, height});
  for (std::int8_t& cell : grid.cells())
    cell = static_cast<std::int8_t>(static_cast<int>(uniform_index(random, 102)) - 1);
  return grid;
}

TEST(OccupancyImage, HasTheHighestYOnTopAndTheGraysOfMapServer) {
  std::mt19937_64 random(1);
  const OccupancyGrid grid = random_occupancy(random, 17, 9);
  const cv::Mat image = to_image(grid), mask = free_mask(grid, 20);
  ASSERT_EQ(image.size(), cv::Size(17, 9));
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 17; ++x) {
      const int percent = grid.at({x, y}), gray = image.at<std::uint8_t>(8 - y, x);
      if (percent < 0) {
        EXPECT_EQ(gray, 205);
      } else {
        EXPECT_NEAR(gray, 254 * (1 - percent / 100.0), 1);
      }
      EXPECT_EQ(mask.at<std::uint8_t>(8 - y, x), percent >= 0 && percent <= 20 ? 255 : 0);
    }
}

TEST(OccupancyGrid, IsUnknownOutside) {
  const OccupancyGrid grid(GridFrame{0.1, {0, 0}, 3, 2}, 50);
  for (const Cell outside : {Cell{-1, 0}, Cell{3, 0}, Cell{0, 2}, Cell{0, -1}})
    EXPECT_EQ(grid.get(outside), OccupancyGrid::kUnknown);
  EXPECT_EQ(grid.get({2, 1}), 50);
  EXPECT_TRUE(OccupancyGrid().empty());
}

TEST(LogOddsGrid, SumsWhatBeamsSaidUpToItsClamp) {
  std::mt19937_64 random(2);
  const LogOddsParams params;
  LogOddsGrid grid(0.1, params);
  std::map<std::pair<int, int>, std::pair<int, int>> counts;  // hits and passes of a cell by its centre, in decimetres
  for (int beam = 0; beam < 60; ++beam) {                     // along one row, so that the cells passed are known
    const int from = static_cast<int>(uniform_index(random, 20)),
              length = 1 + static_cast<int>(uniform_index(random, 15));
    const Vector2d a(0.1 * from + 0.05, 0.05), b(0.1 * (from + length) + 0.05, 0.05);
    const bool hit = uniform01(random) < 0.6;
    hit ? grid.add_hit(a, b) : grid.add_free(a, b);
    for (int x = from; x < from + length; ++x) ++counts[{x, 0}].second;
    hit ? ++counts[{from + length, 0}].first : ++counts[{from + length, 0}].second;
  }
  for (const auto& [cell, seen] : counts) {
    const Cell at = grid.frame().cell_of({0.1 * cell.first + 0.05, 0.05});
    const double sum = seen.first * params.hit + seen.second * params.pass;
    EXPECT_NEAR(grid.log_odds(at), std::clamp(sum, -params.clamp, params.clamp), 1e-9);
    EXPECT_TRUE(grid.seen(at));
  }
  EXPECT_FALSE(grid.seen(grid.frame().cell_of({0.55, 0.35})));
}

TEST(LogOddsGrid, OccupancyIsCutToWhatWasSeenWithItsMargin) {
  LogOddsGrid grid(0.1);
  EXPECT_TRUE(grid.occupancy().empty());
  grid.reserve({-20, -20}, {20, 20});
  grid.add_hit({1.05, 1.05}, {1.55, 1.05});
  const OccupancyGrid seen = grid.occupancy(2);
  EXPECT_EQ(seen.frame().width_cells, 6 + 4);
  EXPECT_EQ(seen.frame().height_cells, 1 + 4);
  EXPECT_GT(seen.get(seen.frame().cell_of({1.55, 1.05})), 65);
  EXPECT_LT(seen.get(seen.frame().cell_of({1.25, 1.05})), 45);
  EXPECT_EQ(seen.get(seen.frame().cell_of({1.25, 1.15})), OccupancyGrid::kUnknown);
  grid.clear();
  EXPECT_TRUE(grid.occupancy().empty());
}

TEST(DistanceMap, FromOccupiedCellsEqualsBruteForce) {
  std::mt19937_64 random(3);
  OccupancyGrid grid(GridFrame{0.1, {-1, -2}, 40, 30}, 0);
  std::vector<Cell> walls;
  for (int i = 0; i < 12; ++i) {
    const Cell cell{static_cast<int>(uniform_index(random, 40)), static_cast<int>(uniform_index(random, 30))};
    grid.at(cell) = 100;
    walls.push_back(cell);
  }
  const DistanceMap map = DistanceMap::from_occupied(grid, 0.8);
  for (int y = 1; y < 29; ++y)  // looked up between four centres: the outermost have none beyond
    for (int x = 1; x < 39; ++x) {
      double best = 0.8;
      for (const Cell& wall : walls) best = std::min(best, 0.1 * std::hypot(wall.x - x, wall.y - y));
      EXPECT_NEAR(map.at(grid.frame().center_of({x, y})), best, 1e-5);
    }
}

TEST(DistanceMap, ChangesNoFasterThanOneMetreAMetre) {
  std::mt19937_64 random(4);
  std::vector<EndPoints> segments;
  const auto anywhere = [&](double reach) {
    return Vector2d(uniform(random, -reach, reach), uniform(random, -reach, reach));
  };
  for (int i = 0; i < 6; ++i) segments.emplace_back(anywhere(2), anywhere(2));
  const DistanceMap map = DistanceMap::from_segments(segments, 0.05, 1.0);
  for (int i = 0; i < 500; ++i) {
    const Vector2d p = anywhere(3), q = p + 0.2 * anywhere(1);
    EXPECT_LE(std::abs(map.at(p) - map.at(q)), 1.42 * (p - q).norm() + 1e-6);  // bilinear: sqrt 2 along a diagonal
    EXPECT_GE(map.at(p), 0);
    EXPECT_LE(map.at(p), 1.0);
  }
}

/// What NDT cells hold does not depend on the order of their points, nor on where the world lies on the lattice.
TEST(NdtGrid, ForgetsTheOrderOfItsPointsAndMovesByWholeCells) {
  std::mt19937_64 random(5);
  std::vector<Vector2d> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(uniform(random, -2, 2), 0.3 * normal(random, 1));
  NdtGrid forwards(0.5), backwards(0.5), moved(0.5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    forwards.add_point(points[i]);
    backwards.add_point(points[points.size() - 1 - i]);
    moved.add_point(points[i] + Vector2d(7.5, -3));
  }
  ASSERT_EQ(forwards.cells(), backwards.cells());
  for (const Cell& cell : forwards.cells()) {
    const NdtCell &a = *forwards.find(cell), &b = *backwards.find(cell), &c = *moved.find({cell.x + 15, cell.y - 6});
    EXPECT_EQ(a.count, b.count);
    EXPECT_LT((a.mean - b.mean).norm(), 1e-12);
    EXPECT_LT((a.scatter - b.scatter).norm(), 1e-10);
    EXPECT_LT((a.mean + Vector2d(7.5, -3) - c.mean).norm(), 1e-12);
    EXPECT_LT((a.scatter - c.scatter).norm(), 1e-9);
  }
}

TEST(NdtGrid, TurnsItsCovarianceWithTheWall) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 20; ++i) {
    const double angle = uniform(random, -1.5, 1.5);
    const Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    NdtGrid grid(4.0);
    for (int k = 0; k < 300; ++k)
      grid.add_point(Vector2d(2, 2) + uniform(random, -1, 1) * along + normal(random, 0.02) * across);
    const NdtCell& cell = *grid.at({2, 2});
    EXPECT_NEAR(std::abs(std::cos(cell.main_direction() - angle)), 1, 1e-3);
    const Eigen::Matrix2d covariance = cell.covariance();
    EXPECT_NEAR(along.dot(covariance * along), 1.0 / 3, 0.06);
    EXPECT_NEAR(across.dot(covariance * across), 4e-4, 2e-4);
  }
}

}  // namespace
}  // namespace smokemap
