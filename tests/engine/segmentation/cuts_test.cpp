#include "segmentation/cuts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "segmentation/thickness.hpp"
#include "segmentation/wall_rings.hpp"

namespace smokemap {
namespace {

/// Two rooms of 60 x 60 side by side, a wall of 6 between them and a door of 16 in it.
cv::Mat two_rooms() {
  cv::Mat map(90, 160, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 60, 60)).setTo(255);
  map(cv::Rect(76, 10, 60, 60)).setTo(255);
  map(cv::Rect(70, 30, 6, 16)).setTo(255);
  return map;
}

std::vector<Cut> cuts_of(const cv::Mat& map, double longest_px = 100) {
  CutSearch search;
  search.longest_px = longest_px;
  search.tolerance_px = 1.5;
  return candidate_cuts(map, trace_wall_rings(map, 1.5), search);
}

size_t count_reflex(const std::vector<WallRing>& rings) {
  size_t count = 0;
  for (const WallRing& ring : rings)
    count += static_cast<size_t>(
        std::count_if(ring.corners.begin(), ring.corners.end(), [](const WallCorner& c) { return c.is_reflex; }));
  return count;
}

TEST(TraceWallRings, FindsTheFourCornersOfADoor) {
  const std::vector<WallRing> rings = trace_wall_rings(two_rooms(), 1.5);
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_EQ(rings[0].corners.size(), 12u);
  EXPECT_EQ(count_reflex(rings), 4u);
}

TEST(TraceWallRings, SeesAPillarFromOutside) {
  cv::Mat map(80, 80, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(5, 5, 70, 70)).setTo(255);
  map(cv::Rect(30, 30, 12, 12)).setTo(0);
  const std::vector<WallRing> rings = trace_wall_rings(map, 1.5);
  ASSERT_EQ(rings.size(), 2u);
  EXPECT_GE(count_reflex(rings), 4u);  // all on the pillar: the room has none
  for (const WallRing& ring : rings)
    for (const WallCorner& corner : ring.corners)
      EXPECT_TRUE(!corner.is_reflex || cv::norm(corner.p - cv::Point(36, 36)) < 12);
}

TEST(TraceWallRings, TakesNoWobbleForACorner) {
  cv::Mat map(80, 200, CV_8UC1, cv::Scalar(0));
  for (int x = 10; x < 190; ++x) map(cv::Rect(x, 20 + (x / 7) % 2, 1, 40)).setTo(255);
  EXPECT_EQ(count_reflex(trace_wall_rings(map, 1.5)), 0u);
}

TEST(WallRing, TakesTheShorterWayRound) {
  const WallRing ring{{}, 100};
  EXPECT_EQ(ring.way_px(10, 30), 20);
  EXPECT_EQ(ring.way_px(95, 5), 10);
  EXPECT_EQ(ring.way_px(0, 50), 50);
}

TEST(CandidateCuts, ContainTheDoorWithBothItsWallsBehindIt) {
  const std::vector<Cut> cuts = cuts_of(two_rooms());
  const bool found = std::any_of(cuts.begin(), cuts.end(), [](const Cut& cut) {
    return std::abs(cut.length_px - 17) < 2.5 && std::abs(cut.a.x - cut.b.x) <= 1 && cut.support > 1.9;
  });
  EXPECT_TRUE(found);
}

TEST(CandidateCuts, RunThroughFreeSpaceFromWallToWall) {
  const cv::Mat map = two_rooms();
  const std::vector<Cut> cuts = cuts_of(map);
  EXPECT_FALSE(cuts.empty());
  for (const Cut& cut : cuts) {
    EXPECT_NEAR(cut.length_px, cv::norm(cut.b - cut.a), 1.1);
    cv::LineIterator pixel(map, cut.a, cut.b, 8);
    int walls = 0;
    for (int i = 0; i < pixel.count; ++i, ++pixel) walls += **pixel != 255;
    EXPECT_LE(walls, 1);
    for (const cv::Point& end : {cut.a, cut.b}) {
      const cv::Mat round = map(cv::Rect(end.x - 2, end.y - 2, 5, 5));
      EXPECT_LT(cv::countNonZero(round), 25) << "an end hangs in the air";
    }
  }
}

TEST(CandidateCuts, AreNoLongerThanAskedFor) {
  for (const Cut& cut : cuts_of(two_rooms(), 30)) EXPECT_LE(cut.length_px, 33);
}

TEST(CandidateCuts, AreNoneInARoomWithoutCorners) {
  cv::Mat map(60, 60, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 40, 40)).setTo(255);
  EXPECT_TRUE(cuts_of(map).empty());
}

TEST(LookBeside, SeesThatADoorIsNarrowerThanBothItsRooms) {
  const cv::Mat map = two_rooms(), clearance = clearance_image(map);
  const Cut door{{70, 30}, {70, 45}, 15, 2};
  const CutSides sides = look_beside(map, clearance, door);
  for (const double extent : sides.extent_px) EXPECT_NEAR(extent, 45, 16);  // at most three lengths to either side
  EXPECT_GT(std::min(sides.clearance_px[0], sides.clearance_px[1]), 15);
}

TEST(LookBeside, SeesThatACorridorIsAsWideAsItsMouth) {
  cv::Mat map(120, 200, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 80, 100)).setTo(255);
  map(cv::Rect(90, 50, 100, 20)).setTo(255);
  const CutSides sides = look_beside(map, clearance_image(map), {{89, 50}, {89, 69}, 19, 2});
  EXPECT_NEAR(std::min(sides.extent_px[0], sides.extent_px[1]), 20, 1.5);
  EXPECT_GT(std::max(sides.extent_px[0], sides.extent_px[1]), 55);
  EXPECT_NEAR(std::max(sides.clearance_px[0], sides.clearance_px[1]), 40, 3);
}

TEST(LookBeside, TakesAWallOnOneSideForNoRoom) {
  const cv::Mat map = two_rooms();
  const CutSides sides = look_beside(map, clearance_image(map), {{10, 10}, {10, 60}, 50, 0});
  EXPECT_EQ(std::min(sides.extent_px[0], sides.extent_px[1]), 0);
}

}  // namespace
}  // namespace smokemap
