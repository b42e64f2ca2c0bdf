#include "sketch/doors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "sketch/clean_sketch.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Stroke pen_line(std::vector<Point2> points) {
  Stroke stroke;
  stroke.points_px = std::move(points);
  return stroke;
}

/// An arc as a hand draws it.
Stroke pen_arc(std::mt19937_64& random, const Point2& centre, double radius, double from_deg, double to_deg) {
  Stroke stroke;
  for (int i = 0; i <= 16; ++i) {
    const double angle = radians(from_deg + (to_deg - from_deg) * i / 16);
    stroke.points_px.push_back(centre +
                               (radius + uniform(random, -1.5, 1.5)) * Point2(std::cos(angle), std::sin(angle)));
  }
  return stroke;
}

/// Two rooms beside each other; the wall between them has a gap from y = 280 to y = 340 if `is_open`.
std::vector<Stroke> two_rooms_with_door(bool is_open) {
  std::vector<Stroke> walls{
      pen_line({Point2(100, 100), Point2(700, 100), Point2(700, 500), Point2(100, 500), Point2(100, 100)})};
  if (is_open) {
    walls.push_back(pen_line({Point2(400, 100), Point2(400, 280)}));
    walls.push_back(pen_line({Point2(400, 340), Point2(400, 500)}));
  } else {
    walls.push_back(pen_line({Point2(400, 100), Point2(400, 500)}));
  }
  return walls;
}

int parts_of(const std::vector<Stroke>& strokes) {
  const auto clean = clean_sketch({800, 600, strokes});
  if (!clean.ok()) return 0;
  cv::Mat labels;
  return cv::connectedComponents(clean->free_space, labels, 4) - 1;
}

TEST(DrawnDoors, AreALeafAndItsArcInAGap) {
  auto random = random_stream(1, 0);
  for (int trial = 0; trial < 10; ++trial) {
    auto strokes = two_rooms_with_door(true);
    strokes.push_back(pen_line({Point2(400, 280), Point2(460, 280)}));
    strokes.push_back(pen_arc(random, Point2(400, 280), 60, 0, 90));
    const DrawnDoors doors = find_drawn_doors(strokes, 600);
    ASSERT_EQ(doors.openings_px.size(), 1U) << trial;
    EXPECT_LT((doors.openings_px[0].a - Point2(400, 280)).norm(), 8);
    EXPECT_LT((doors.openings_px[0].b - Point2(400, 340)).norm(), 8);
    EXPECT_EQ(doors.marks.size(), 2U);
    EXPECT_EQ(doors.walls.size(), 3U);
    EXPECT_EQ(parts_of(strokes), 1);
  }
}

TEST(DrawnDoors, AreFoundWhenLeafAndArcAreOneStroke) {
  auto random = random_stream(2, 0);
  auto strokes = two_rooms_with_door(true);
  Stroke door = pen_line({Point2(400, 280), Point2(430, 280), Point2(460, 280)});
  const Stroke arc = pen_arc(random, Point2(400, 280), 60, 0, 90);
  door.points_px.insert(door.points_px.end(), arc.points_px.begin() + 1, arc.points_px.end());
  strokes.push_back(door);
  const DrawnDoors doors = find_drawn_doors(strokes, 600);
  ASSERT_EQ(doors.openings_px.size(), 1U);
  EXPECT_EQ(doors.marks.size(), 2U);
}

TEST(DrawnDoors, OpenAWallThatWasDrawnThrough) {
  auto random = random_stream(3, 0);
  auto strokes = two_rooms_with_door(false);
  EXPECT_EQ(parts_of(strokes), 2);
  strokes.push_back(pen_line({Point2(400, 280), Point2(460, 280)}));
  strokes.push_back(pen_arc(random, Point2(400, 280), 60, 0, 90));
  EXPECT_EQ(parts_of(strokes), 1);
}

TEST(DrawnDoors, LeaveNoWallInTheRoomTheySwingInto) {
  auto random = random_stream(4, 0);
  auto strokes = two_rooms_with_door(true);
  strokes.push_back(pen_line({Point2(400, 280), Point2(460, 280)}));
  strokes.push_back(pen_arc(random, Point2(400, 280), 60, 0, 90));
  const auto clean = clean_sketch({800, 600, strokes});
  ASSERT_THAT(clean, test::IsOk());
  EXPECT_EQ(clean->free_space.at<uchar>(322, 442), 255);
  EXPECT_EQ(clean->free_space.at<uchar>(280, 440), 255);
  ASSERT_EQ(clean->gaps.size(), 1U);
  EXPECT_FALSE(clean->gaps[0].closed_by_us);
  EXPECT_NEAR(clean->gaps[0].gap_px.length(), 60, 10);
}

TEST(DrawnDoors, AreNotRoundCornersOfRooms) {
  auto random = random_stream(5, 0);
  std::vector<Stroke> strokes{
      pen_line({Point2(160, 100), Point2(700, 100), Point2(700, 500), Point2(100, 500), Point2(100, 160)}),
      pen_arc(random, Point2(160, 160), 60, 180, 270)};
  EXPECT_TRUE(find_drawn_doors(strokes, 600).openings_px.empty());
}

TEST(DrawnDoors, AreNotStraightWallsRoundTablesOrZigzags) {
  auto random = random_stream(6, 0);
  auto strokes = two_rooms_with_door(true);
  const std::size_t before = strokes.size();
  strokes.push_back(pen_arc(random, Point2(250, 300), 50, 0, 359));
  strokes.push_back(pen_line({Point2(500, 200), Point2(540, 240), Point2(500, 280), Point2(540, 320)}));
  const DrawnDoors doors = find_drawn_doors(strokes, 600);
  EXPECT_TRUE(doors.openings_px.empty());
  EXPECT_EQ(doors.walls.size(), before + 2);
}

TEST(DrawnDoors, TurnWithTheSheet) {
  auto random = random_stream(7, 0);
  auto strokes = two_rooms_with_door(true);
  strokes.push_back(pen_line({Point2(400, 280), Point2(460, 280)}));
  strokes.push_back(pen_arc(random, Point2(400, 280), 60, 0, 90));
  auto turned = strokes;
  const double angle = 0.7;
  for (auto& s : turned)
    for (auto& p : s.points_px)
      p = Point2(std::cos(angle) * p.x() - std::sin(angle) * p.y(), std::sin(angle) * p.x() + std::cos(angle) * p.y());
  const DrawnDoors one = find_drawn_doors(strokes, 600), two = find_drawn_doors(turned, 600);
  ASSERT_EQ(one.openings_px.size(), 1U);
  ASSERT_EQ(two.openings_px.size(), 1U);
  EXPECT_NEAR(one.openings_px[0].length(), two.openings_px[0].length(), 3);
}

TEST(DrawnDoors, OfNothingAreNone) {
  EXPECT_TRUE(find_drawn_doors({}, 100).walls.empty());
  EXPECT_EQ(find_drawn_doors({pen_line({Point2(1, 1)})}, 0).walls.size(), 1U);
  EXPECT_EQ(find_drawn_doors({pen_line({Point2(1, 1), Point2(1, 1), Point2(1, 1)})}, 10).walls.size(), 1U);
}

}  // namespace
}  // namespace smokemap
