#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "layout/drafting.hpp"
#include "layout/read_layout.hpp"
#include "tests/engine/layout/drawn_plan.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A wall with a door in it, the leaf at `at`, turned as a whole by `heading`; the arc may be squashed, as in a
/// photograph.
struct DoorInWall {
  cv::Mat ink = cv::Mat::zeros(400, 1200, CV_8UC1);
  InkStroke left, right, leaf, arc_start, arc_end;
};

DoorInWall draw_door(double heading, double squash = 1, bool with_arc = true) {
  constexpr double kWidth = 80;
  DoorInWall door;
  const Point2 u(std::cos(heading), std::sin(heading)), n(-u.y(), u.x()), at(600, 200);
  const auto stroke = [&](const Point2& a, const Point2& b, double thickness, bool draw) {
    InkStroke s;
    s.axis = {a, b}, s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
    if (draw)
      cv::line(door.ink, testing::detail::px(a), testing::detail::px(b), cv::Scalar(255), static_cast<int>(thickness));
    return s;
  };
  const auto on_arc = [&](double t) { return Point2(at + kWidth * (std::cos(t) * n + squash * std::sin(t) * u)); };
  door.left = stroke(at - 160 * u, at, 4, true);
  door.right = stroke(at + squash * kWidth * u, at + (squash * kWidth + 160) * u, 4, true);
  door.leaf = stroke(at, at + kWidth * n, 3, true);
  if (with_arc)
    for (double t = 0; t < kPi / 2; t += 0.05) stroke(on_arc(t), on_arc(t + 0.05), 3, true);
  door.arc_start = stroke(on_arc(0.1), on_arc(0.5), 3, false);
  door.arc_end = stroke(on_arc(0.9), on_arc(1.3), 3, false);
  return door;
}

std::vector<bool> leaves_of(const DoorInWall& door, const cv::Mat& hidden = {}) {
  return door_leaves({door.left, door.right, door.leaf, door.arc_start, door.arc_end}, door.ink,
                     hidden.empty() ? cv::Mat::zeros(door.ink.size(), CV_8UC1) : hidden);
}

const std::vector<bool> kLeafAndArc{false, false, true, true, true}, kNothing(5, false);

TEST(DoorLeaves, AreToldFromWallsByTheirArc) {
  for (double heading = 0; heading < 3.1; heading += 0.37)
    EXPECT_EQ(leaves_of(draw_door(heading)), kLeafAndArc) << heading;
}

TEST(DoorLeaves, AreToldInPhotographsThatSquashTheArc) {
  for (const double squash : {0.85, 1.15}) EXPECT_EQ(leaves_of(draw_door(0.2, squash)), kLeafAndArc) << squash;
}

TEST(DoorLeaves, WithoutAnArcAreStubsOfWalls) { EXPECT_EQ(leaves_of(draw_door(0, 1, false)), kNothing); }

// Regression: a door that opens along a stub of wall took the stub with it.
TEST(DoorLeaves, MuchThickerThanTheArcAreStubsOfWalls) {
  auto door = draw_door(0);
  cv::line(door.ink, testing::detail::px(door.leaf.axis.a), testing::detail::px(door.leaf.axis.b), cv::Scalar(255), 14);
  door.leaf.thickness_px = 14;
  EXPECT_EQ(leaves_of(door), kNothing);
}

TEST(DoorLeaves, AreToldWhereAnArrowHidesAPartOfTheArc) {
  auto door = draw_door(0);
  cv::Mat hidden = cv::Mat::zeros(door.ink.size(), CV_8UC1);
  const cv::Rect arrow(640, 240, 30, 60);
  hidden(arrow).setTo(255), door.ink(arrow).setTo(0);
  EXPECT_TRUE(leaves_of(door, hidden)[2]);
  EXPECT_FALSE(leaves_of(door)[2]) << "nothing hides it: there is no arc";
}

TEST(DoorLeaves, AreNotSeenInASolidSector) {
  auto door = draw_door(0);
  cv::ellipse(door.ink, {600, 200}, {80, 80}, 0, 0, 90, cv::Scalar(255), cv::FILLED);
  EXPECT_EQ(leaves_of(door), kNothing);
}

// Regression: where leaves are as thick as walls they were sure walls, and rooms ended at them.
TEST(DoorLeaves, AsThickAsWallsAreNoWalls) {
  cv::Mat picture(1100, 1600, CV_8UC3, cv::Scalar(255, 255, 255));
  const cv::Scalar ink(20, 20, 20);
  const auto wall = [&](int x1, int y1, int x2, int y2) { cv::line(picture, {x1, y1}, {x2, y2}, ink, 5); };
  wall(200, 200, 1400, 200), wall(1400, 200, 1400, 800), wall(1400, 800, 200, 800), wall(200, 800, 200, 200);
  std::vector<Segment2> leaves;
  for (const int x : {500, 800, 1100}) {
    wall(x, 200, x, 420), wall(x, 500, x, 800);
    wall(x, 420, x + 80, 420);
    cv::ellipse(picture, {x, 420}, {80, 80}, 0, 0, 90, ink, 4, cv::LINE_AA);
    leaves.push_back({Point2(x + 10, 420), Point2(x + 80, 420)});
  }
  const auto reading = read_layout(picture);
  ASSERT_THAT(reading, test::IsOk());
  EXPECT_EQ(testing::covered_by(leaves, testing::wall_segments(reading->layout), 6), 0);
  EXPECT_EQ(reading->layout.rooms_px.size(), 4U);
  EXPECT_EQ(std::count_if(reading->layout.openings.begin(), reading->layout.openings.end(),
                          [](const LayoutOpening& o) { return o.kind == OpeningKind::kDoor; }),
            3);
}

}  // namespace
}  // namespace smokemap
