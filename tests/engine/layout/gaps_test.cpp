#include "layout/gaps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "layout/edit.hpp"

namespace smokemap {
namespace {

LayoutMap map_of(const std::vector<Segment2>& walls) {
  LayoutMap map;
  for (const auto& s : walls) {
    for (const Point2& p : {s.a, s.b}) {
      LayoutCorner corner;
      corner.p_px = p;
      map.corners.push_back(corner);
    }
    const int last = static_cast<int>(map.corners.size()) - 1;
    map.walls.push_back({last - 1, last, 8, 0.9, false});
  }
  return with_degrees(std::move(map));
}

cv::Mat signs_at(const std::vector<cv::Rect>& boxes) {
  cv::Mat covered = cv::Mat::zeros(600, 600, CV_8UC1);
  for (const auto& box : boxes) covered(box).setTo(255);
  return covered;
}

/// Every corner's degree, sorted.
std::vector<int> degrees_of(const LayoutMap& map) {
  std::vector<int> degrees;
  for (const auto& c : map.corners)
    if (c.degree > 0) degrees.push_back(c.degree);
  std::sort(degrees.begin(), degrees.end());
  return degrees;
}

TEST(LooseEnds, AreThoseThatMeetNothing) {
  LayoutMap map = map_of({{{0, 0}, {100, 0}}});
  map.walls.push_back({1, 2, 8, 1, false});
  LayoutCorner corner;
  corner.p_px = {100, 80};
  map.corners.push_back(corner);
  map = with_degrees(map);
  const auto ends = loose_ends(map);
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].outward, Point2(-1, 0));
  EXPECT_EQ(ends[1].outward, Point2(0, 1));
}

TEST(GapsAhead, LieBetweenFacingEndsOnceAndBeforeWallsAcross) {
  const auto ahead = [](const std::vector<Segment2>& walls) {
    const auto map = map_of(walls);
    return gaps_ahead(map, loose_ends(map), 8, 80);
  };
  const auto facing = ahead({{{0, 100}, {100, 100}}, {{150, 100}, {300, 100}}});
  ASSERT_EQ(facing.size(), 1U);
  EXPECT_GE(facing[0].corner_b, 0);
  const auto across = ahead({{{0, 100}, {100, 100}}, {{160, 0}, {160, 200}}});
  ASSERT_EQ(across.size(), 1U);
  EXPECT_EQ(across[0].corner_b, -1);
  EXPECT_EQ(across[0].wall_b, 1);
  EXPECT_NEAR(across[0].segment.length(), 60, 1e-9);
  EXPECT_TRUE(ahead({{{0, 100}, {100, 100}}, {{190, 100}, {300, 100}}}).empty());
}

TEST(HiddenWalls, RunStraightOnBelowASign) {
  LayoutMap map = map_of({{{100, 100}, {200, 100}}, {{260, 100}, {400, 100}}});
  repair_hidden(map, signs_at({{195, 80, 70, 40}}), 8, 100);
  ASSERT_EQ(map.walls.size(), 3U);
  EXPECT_DOUBLE_EQ(map.walls[2].confidence, 0.5);
  EXPECT_EQ(degrees_of(map), (std::vector<int>{1, 1, 2, 2}));
}

// Regression: a sign over the corner of a room left the room open.
TEST(HiddenWalls, MeetInTheCornerBelowASign) {
  LayoutMap map = map_of({{{140, 100}, {400, 100}}, {{100, 140}, {100, 400}}});
  repair_hidden(map, signs_at({{80, 80, 70, 70}}), 8, 100);
  bool corner = false;
  for (const auto& c : map.corners) corner |= (c.p_px - Point2(100, 100)).norm() < 1 && c.degree == 2;
  EXPECT_TRUE(corner);
  EXPECT_EQ(map.walls.size(), 4U);
}

TEST(HiddenWalls, EndThatNearlyReachesTheCornerIsMovedThere) {
  LayoutMap map = map_of({{{104, 100}, {400, 100}}, {{100, 140}, {100, 400}}});
  repair_hidden(map, signs_at({{80, 80, 70, 70}}), 8, 100);
  EXPECT_EQ(map.walls.size(), 3U);
  EXPECT_EQ(map.corners[0].p_px, Point2(100, 100));
  EXPECT_EQ(map.corners[0].degree, 2);
}

TEST(HiddenWalls, DoNotMeetInAnOpenCorner) {
  LayoutMap map = map_of({{{140, 100}, {400, 100}}, {{100, 140}, {100, 400}}});
  repair_hidden(map, signs_at({}), 8, 100);
  EXPECT_EQ(map.walls.size(), 2U) << "nothing hides it: it may well be open";
}

// Regression: a wall carried on below a sign ended on another one without a corner there.
TEST(HiddenWalls, CutTheWallTheyEndOn) {
  LayoutMap map = map_of({{{100, 200}, {300, 200}}, {{350, 50}, {350, 400}}});
  repair_hidden(map, signs_at({{290, 180, 80, 40}}), 8, 100);
  ASSERT_EQ(map.walls.size(), 4U);
  bool junction = false;
  for (const auto& c : map.corners) junction |= (c.p_px - Point2(350, 200)).norm() < 1 && c.degree == 3;
  EXPECT_TRUE(junction);
}

TEST(HiddenWalls, TwoOnOneWallCutItTwice) {
  LayoutMap map = map_of({{{100, 100}, {300, 100}}, {{100, 300}, {300, 300}}, {{350, 50}, {350, 400}}});
  repair_hidden(map, signs_at({{290, 80, 80, 40}, {290, 280, 80, 40}}), 8, 100);
  EXPECT_EQ(map.walls.size(), 7U);
  double length = 0;
  for (std::size_t w = 0; w < map.walls.size(); ++w) length += map.wall_px(static_cast<int>(w)).length();
  EXPECT_NEAR(length, 200 + 200 + 350 + 50 + 50, 1e-6);
}

TEST(CoveredShare, CountsWhatLiesOnTheMask) {
  const cv::Mat half = signs_at({{0, 0, 300, 600}});
  EXPECT_NEAR(covered_share({{200, 100}, {400, 100}}, half), 0.5, 0.02);
  EXPECT_DOUBLE_EQ(covered_share({{-50, -50}, {-10, -50}}, half), 0);
  EXPECT_DOUBLE_EQ(covered_share({{5, 5}, {5, 5}}, half), 0);
}

}  // namespace
}  // namespace smokemap
