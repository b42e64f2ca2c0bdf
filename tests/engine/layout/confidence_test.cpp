#include "layout/confidence.hpp"

#include <gtest/gtest.h>

#include "layout/edit.hpp"

namespace smokemap {
namespace {

/// A square room with a stray stroke beside it.
LayoutMap room_and_stray(double ink = 0.9, double stray_thickness = 8) {
  LayoutMap map;
  for (const Point2& p :
       {Point2(0, 0), Point2(400, 0), Point2(400, 400), Point2(0, 400), Point2(100, 100), Point2(112, 105)}) {
    LayoutCorner corner;
    corner.p_px = p;
    map.corners.push_back(corner);
  }
  for (int i = 0; i < 4; ++i) map.walls.push_back({i, (i + 1) % 4, 8, ink, false});
  map.walls.push_back({4, 5, stray_thickness, ink, false});
  return with_degrees(map);
}

TEST(Confidence, IsHighForLongWallsThatMeetAndLowForStrayStrokes) {
  LayoutMap map = room_and_stray();
  grade_confidence(map);
  for (int w = 0; w < 4; ++w) EXPECT_GT(map.walls[static_cast<std::size_t>(w)].confidence, 0.95);
  EXPECT_LT(map.walls[4].confidence, 0.6);
}

TEST(Confidence, GrowsWithInkAndFallsWithOddThickness) {
  LayoutMap faint = room_and_stray(0.4), dark = room_and_stray(1.0), odd = room_and_stray(1.0, 20);
  for (LayoutMap* map : {&faint, &dark, &odd}) grade_confidence(*map);
  for (std::size_t w = 0; w < dark.walls.size(); ++w) EXPECT_LT(faint.walls[w].confidence, dark.walls[w].confidence);
  EXPECT_LT(odd.walls[4].confidence, dark.walls[4].confidence);
}

TEST(Confidence, CountsAnOpeningAsSomethingThatIsMet) {
  LayoutMap map = room_and_stray(), at_door = room_and_stray();
  at_door.openings.push_back({{{112, 105}, {180, 140}}, OpeningKind::kDoor, 1});
  grade_confidence(map), grade_confidence(at_door);
  EXPECT_GT(at_door.walls[4].confidence, map.walls[4].confidence);
}

TEST(Confidence, OfWhatAPersonDrewStays) {
  LayoutMap map = room_and_stray();
  map.walls[4].by_person = true, map.walls[4].confidence = 1;
  grade_confidence(map);
  EXPECT_DOUBLE_EQ(map.walls[4].confidence, 1);
}

TEST(Confidence, OfCornersFollowsTheirWallsAndIsNeverSaidTooHigh) {
  LayoutMap map = room_and_stray();
  grade_confidence(map);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_GT(map.corners[c].confidence, 0.8);
    EXPECT_LE(map.corners[c].confidence, 0.89);
  }
  EXPECT_LT(map.corners[4].confidence, map.corners[0].confidence);
}

TEST(Confidence, DoesNotDependOnTheScaleOfThePicture) {
  LayoutMap small = room_and_stray(), large = room_and_stray();
  for (auto& c : large.corners) c.p_px *= 5;
  for (auto& w : large.walls) w.thickness_px *= 5;
  grade_confidence(small), grade_confidence(large);
  for (std::size_t w = 0; w < small.walls.size(); ++w)
    EXPECT_NEAR(small.walls[w].confidence, large.walls[w].confidence, 1e-9);
}

TEST(Confidence, OfNothingIsNothing) {
  LayoutMap map;
  grade_confidence(map);
  EXPECT_TRUE(map.walls.empty());
}

}  // namespace
}  // namespace smokemap
