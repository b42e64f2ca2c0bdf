#include "sketch/gaps.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

#include "sketch/clean_sketch.hpp"

namespace smokemap {
namespace {

constexpr double kExtent = 400;

Stroke wall_of(std::vector<Point2> points_px) {
  Stroke stroke;
  stroke.points_px = std::move(points_px);
  return stroke;
}

/// A square room whose outline begins and ends `gap_px` apart in the middle of its lower side.
std::vector<Stroke> room_open_by(double gap_px) {
  return {wall_of({{200 + gap_px / 2, 400}, {400, 400}, {400, 0}, {0, 0}, {0, 400}, {200 - gap_px / 2, 400}})};
}

std::vector<SketchGap> gaps_of(const std::vector<Stroke>& walls) { return find_gaps(walls, kExtent, SketchParams{}); }

bool any_closed(const std::vector<SketchGap>& gaps) {
  return std::any_of(gaps.begin(), gaps.end(), [](const SketchGap& gap) { return gap.closed_by_us; });
}

TEST(Gaps, SlipsOfThePenAreClosed) {
  for (const double gap_px : {8.0, 10.0, 12.0}) {
    const std::vector<SketchGap> gaps = gaps_of(room_open_by(gap_px));
    ASSERT_FALSE(gaps.empty()) << gap_px;
    EXPECT_TRUE(any_closed(gaps)) << gap_px;
  }
}

TEST(Gaps, OfAnyWidthUpToADoorLetNothingOut) {
  for (const double gap_px : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 9.0, 15.0, 40.0}) {
    SketchMap sketch;
    sketch.width_px = 500, sketch.height_px = 500;
    sketch.strokes = room_open_by(gap_px);
    for (Stroke& stroke : sketch.strokes)
      for (Point2& p : stroke.points_px) p += Point2(50, 50);
    const auto clean = clean_sketch(sketch);
    ASSERT_TRUE(clean.ok()) << gap_px;
    EXPECT_NEAR(cv::countNonZero(clean->free_space), 397 * 397, 0.01 * 400 * 400) << gap_px;
    EXPECT_EQ(clean->free_space.at<unsigned char>(20, 20), 0);
  }
}

TEST(Gaps, OpeningsAsWideAsADoorStayOpenAndAreReported) {
  for (const double gap_px : {25.0, 40.0, 50.0}) {
    const std::vector<SketchGap> gaps = gaps_of(room_open_by(gap_px));
    ASSERT_FALSE(gaps.empty()) << gap_px;
    EXPECT_FALSE(any_closed(gaps)) << gap_px;
    EXPECT_NEAR(gaps.front().gap_px.length(), gap_px, 3);
    EXPECT_NEAR(gaps.front().gap_px.midpoint().x(), 200, 3);
    EXPECT_NEAR(gaps.front().gap_px.midpoint().y(), 400, 3);
  }
}

TEST(Gaps, OfAClosedRoomAreNone) {
  EXPECT_TRUE(gaps_of({wall_of({{0, 0}, {400, 0}, {400, 400}, {0, 400}, {0, 0}})}).empty());
}

TEST(Gaps, TurnWithTheDrawing) {
  for (const double turn_rad : {0.4, 1.1, 2.0, 3.0}) {
    std::vector<Stroke> walls = room_open_by(40);
    const Eigen::Rotation2D<double> rotation(turn_rad);
    for (Stroke& wall : walls)
      for (Point2& p : wall.points_px) p = rotation * p;
    const std::vector<SketchGap> gaps = gaps_of(walls);
    ASSERT_EQ(gaps.size(), gaps_of(room_open_by(40)).size()) << turn_rad;
    EXPECT_NEAR((gaps.front().gap_px.midpoint() - rotation * Point2(200, 400)).norm(), 0, 3);
  }
}

TEST(Gaps, DoNotDependOnTheWayAStrokeWasDrawn) {
  for (const double gap_px : {8.0, 40.0}) {
    std::vector<Stroke> backwards = room_open_by(gap_px);
    std::reverse(backwards.front().points_px.begin(), backwards.front().points_px.end());
    const auto one = gaps_of(room_open_by(gap_px)), two = gaps_of(backwards);
    ASSERT_EQ(one.size(), two.size());
    EXPECT_EQ(any_closed(one), any_closed(two));
  }
}

TEST(Gaps, AWallThatEndsInTheMiddleOfARoomIsNoGap) {
  std::vector<Stroke> walls = {wall_of({{0, 0}, {400, 0}, {400, 400}, {0, 400}, {0, 0}}),
                               wall_of({{200, 0}, {200, 180}})};
  for (const SketchGap& gap : gaps_of(walls)) EXPECT_FALSE(gap.closed_by_us);
}

}  // namespace
}  // namespace smokemap
