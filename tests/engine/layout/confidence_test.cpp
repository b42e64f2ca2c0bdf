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

/// A box of 900 x 300 with lines across it, `spacing_px` apart; `lean_px` is how far their upper ends lie to the right.
LayoutMap box_with_lines(int lines, double spacing_px, double height_px, double lean_px) {
  LayoutMap map;
  const auto corner = [&](double x, double y) {
    LayoutCorner c;
    c.p_px = {x, y};
    map.corners.push_back(c);
    return static_cast<int>(map.corners.size()) - 1;
  };
  const auto wall = [&](int a, int b) { map.walls.push_back({a, b, 8, 0.9, false}); };
  const int box[] = {corner(0, 0), corner(900, 0), corner(900, height_px), corner(0, height_px)};
  for (int i = 0; i < 4; ++i) wall(box[i], box[(i + 1) % 4]);
  for (int i = 1; i <= lines; ++i) {
    const int a = corner(i * spacing_px, 0), b = corner(i * spacing_px + lean_px, height_px);
    wall(a, b);
    map.walls.push_back({box[0], a, 8, 0.9, false});  // both ends meet something
    map.walls.push_back({box[3], b, 8, 0.9, false});
  }
  return with_degrees(map);
}

double surest_line(const LayoutMap& graded, int from, int to) {
  double surest = 0;
  for (int i = from; i < to; ++i)
    surest = std::max(surest, graded.walls[static_cast<std::size_t>(4 + 3 * i)].confidence);
  return surest;
}

// Regression: the hatching of cut walls and the treads of a stair were sure walls. The last of a row looks like the
// wall that the row ends at.
TEST(Confidence, IsLowForTreadsAndHatching) {
  LayoutMap stair = box_with_lines(8, 60, 240, 0), hatched = box_with_lines(20, 40, 60, 60);
  grade_confidence(stair), grade_confidence(hatched);
  EXPECT_LT(surest_line(stair, 1, 7), 0.5);
  EXPECT_LT(surest_line(hatched, 0, 20), 0.5);
  for (int side = 0; side < 4; ++side) EXPECT_GT(stair.walls[static_cast<std::size_t>(side)].confidence, 0.9);
}

TEST(Confidence, OfTheWallsBetweenOfficesStaysHigh) {
  LayoutMap offices = box_with_lines(6, 120, 260, 0);
  grade_confidence(offices);
  for (int i = 0; i < 6; ++i) EXPECT_GT(offices.walls[static_cast<std::size_t>(4 + 3 * i)].confidence, 0.9) << i;
}

TEST(Confidence, OfNothingIsNothing) {
  LayoutMap map;
  grade_confidence(map);
  EXPECT_TRUE(map.walls.empty());
}

}  // namespace
}  // namespace smokemap
