#include "navigation/bottleneck.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

constexpr int kCols = 60, kRows = 40;

/// Blocked everywhere but in the boxes (x, y, width, height in cells of 0.1 m).
CostMap map_of(const std::vector<std::array<int, 4>>& boxes, Ground ground = Ground::kFree) {
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.origin = Eigen::Vector2d(-1, 2);
  frame.width_cells = kCols;
  frame.height_cells = kRows;
  std::vector<Ground> cells(frame.cell_count(), Ground::kBlocked);
  for (const auto& [x, y, width, height] : boxes)
    for (int v = y; v < y + height; ++v)
      for (int u = x; u < x + width; ++u) cells[frame.index({u, v})] = ground;
  return CostMap(frame, std::move(cells), CostMapParams{});
}

Point2 centre(const CostMap& map, int x, int y) { return map.frame().center_of({x, y}); }

TEST(Bottleneck, IsTheDoorBetweenTwoRooms) {
  const CostMap map = map_of({{5, 5, 20, 25}, {30, 5, 20, 25}, {25, 15, 5, 3}});
  const auto narrow = bottleneck_between(map, centre(map, 10, 10), centre(map, 45, 25));
  ASSERT_TRUE(narrow);
  EXPECT_NEAR(narrow->width_m, 0.3, 0.11);
  EXPECT_NEAR(narrow->p_map.x(), centre(map, 27, 16).x(), 0.35);
  EXPECT_NEAR(narrow->p_map.y(), centre(map, 27, 16).y(), 0.15);
}

TEST(Bottleneck, IsThatOfTheWiderOfTwoWays) {
  const CostMap map = map_of({{5, 5, 20, 30}, {30, 5, 20, 30}, {25, 8, 5, 2}, {25, 20, 5, 7}});
  const auto narrow = bottleneck_between(map, centre(map, 10, 9), centre(map, 45, 9));
  ASSERT_TRUE(narrow);
  EXPECT_NEAR(narrow->width_m, 0.7, 0.11);
}

TEST(Bottleneck, IsNothingWhereNoWayLeads) {
  const CostMap map = map_of({{5, 5, 20, 25}, {30, 5, 20, 25}});
  EXPECT_FALSE(bottleneck_between(map, centre(map, 10, 10), centre(map, 45, 25)));
  EXPECT_FALSE(bottleneck_between(map, centre(map, 10, 10), centre(map, 1, 1)));
  EXPECT_FALSE(bottleneck_between(map, Point2(-50, 0), centre(map, 10, 10)));
}

/// The largest clearance with which a flood from one place reaches the other.
double widest_by_flood(const CostMap& map, Cell from, Cell to) {
  double best = -1;
  for (double least = 0.05; least < 3; least += 0.1) {
    std::vector<bool> seen(map.frame().cell_count(), false);
    std::vector<Cell> stack{from};
    while (!stack.empty()) {
      const Cell cell = stack.back();
      stack.pop_back();
      if (!map.frame().contains(cell) || seen[map.frame().index(cell)] || map.clearance_m(cell) < least) continue;
      seen[map.frame().index(cell)] = true;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) stack.push_back({cell.x + dx, cell.y + dy});
    }
    if (seen[map.frame().index(to)]) best = least;
  }
  return best;
}

TEST(Bottleneck, AgreesWithAFloodOfEveryWidth) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<std::array<int, 4>> boxes;
    for (int i = 0; i < 7; ++i)
      boxes.push_back({1 + static_cast<int>(uniform(random, 0, 38)), 1 + static_cast<int>(uniform(random, 0, 22)),
                       3 + static_cast<int>(uniform(random, 0, 16)), 3 + static_cast<int>(uniform(random, 0, 12))});
    const CostMap map = map_of(boxes, seed % 2 == 0 ? Ground::kFree : Ground::kPlanned);
    const Cell from{boxes[0][0] + boxes[0][2] / 2, boxes[0][1] + boxes[0][3] / 2};
    const Cell to{boxes[1][0] + boxes[1][2] / 2, boxes[1][1] + boxes[1][3] / 2};
    const auto narrow = bottleneck_between(map, map.frame().center_of(from), map.frame().center_of(to));
    const double flood = widest_by_flood(map, from, to);
    EXPECT_EQ(narrow.has_value(), flood > 0) << "seed " << seed;
    if (!narrow) continue;
    // The flood starts where it stands, which may be narrower than the middle lines that the graph walks on.
    const double ends = std::min(map.clearance_m(from), map.clearance_m(to));
    EXPECT_NEAR(std::min(0.5 * (narrow->width_m + 0.1), ends), flood, 0.16) << "seed " << seed;
    ++compared;
  }
  EXPECT_GT(compared, 5);
}

TEST(TooNarrowAWay, IsSaidWithItsWidthAndWhatTheRobotNeeds) {
  const CostMap map = map_of({{5, 5, 20, 25}, {30, 5, 20, 25}, {25, 15, 5, 3}});
  const auto reason = too_narrow_a_way(map, centre(map, 10, 10), centre(map, 45, 25));
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("0.3 m wide"), std::string::npos) << *reason;
  EXPECT_NE(reason->find("needs 0.6 m"), std::string::npos) << *reason;
}

TEST(TooNarrowAWay, IsNoReasonWhereTheWayIsWideOrThereIsNone) {
  const CostMap wide = map_of({{5, 5, 20, 25}, {30, 5, 20, 25}, {25, 10, 5, 9}});
  EXPECT_FALSE(too_narrow_a_way(wide, centre(wide, 10, 10), centre(wide, 45, 25)));
  const CostMap apart = map_of({{5, 5, 20, 25}, {30, 5, 20, 25}});
  EXPECT_FALSE(too_narrow_a_way(apart, centre(apart, 10, 10), centre(apart, 45, 25)));
}

}  // namespace
}  // namespace smokemap
