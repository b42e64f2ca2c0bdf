#include "sketch/outside.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "sketch/clean_sketch.hpp"
#include "sketch/gaps.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Stroke drawn(std::vector<Point2> points) {
  Stroke stroke;
  stroke.points_px = std::move(points);
  return stroke;
}

bool is_inside(const CleanSketch& clean, int x, int y) { return clean.free_space.at<uchar>(y, x) == 255; }

TEST(Outline, IsClosedStraightAcrossAWideEntrance) {
  // The entrance is a fifth of the drawing wide: more than any door that a loose end looks for.
  const auto clean = clean_sketch({800,
                                   700,
                                   {drawn({Point2(340, 600), Point2(100, 600), Point2(100, 100), Point2(700, 100),
                                           Point2(700, 600), Point2(460, 600)})}});
  ASSERT_THAT(clean, test::IsOk());
  EXPECT_TRUE(is_inside(*clean, 400, 300));
  EXPECT_TRUE(is_inside(*clean, 400, 590));  // up to the straight line, not only as far as a disc reaches
  EXPECT_FALSE(is_inside(*clean, 400, 610));
  ASSERT_EQ(clean->gaps.size(), 1U);
  EXPECT_FALSE(clean->gaps[0].closed_by_us);
  EXPECT_NEAR(clean->gaps[0].gap_px.length(), 120, 12);
  EXPECT_FALSE(clean->warnings.empty());
}

TEST(Outline, DoesNotLoseTheRoomsBehindAWideEntrance) {
  const auto clean =
      clean_sketch({800,
                    700,
                    {drawn({Point2(340, 600), Point2(100, 600), Point2(100, 100), Point2(700, 100), Point2(700, 600),
                            Point2(460, 600)}),
                     drawn({Point2(100, 300), Point2(380, 300)}), drawn({Point2(430, 300), Point2(700, 300)})}});
  ASSERT_THAT(clean, test::IsOk());
  EXPECT_TRUE(is_inside(*clean, 400, 450));
  EXPECT_TRUE(is_inside(*clean, 200, 200));
}

TEST(Outline, LeavesACourtyardAndABayOutside) {
  // Two wings of rooms round a yard that is open to the south.
  const auto clean =
      clean_sketch({900,
                    800,
                    {drawn({Point2(100, 100), Point2(800, 100), Point2(800, 700), Point2(550, 700), Point2(550, 300),
                            Point2(350, 300), Point2(350, 700), Point2(100, 700), Point2(100, 100)})}});
  ASSERT_THAT(clean, test::IsOk());
  EXPECT_TRUE(is_inside(*clean, 200, 400));
  EXPECT_FALSE(is_inside(*clean, 450, 500));
  EXPECT_TRUE(clean->gaps.empty());
}

TEST(Outline, KeepsABayOutsideWhenTheEntranceIsOpen) {
  const auto clean = clean_sketch(
      {900,
       800,
       {drawn({Point2(500, 700), Point2(800, 700), Point2(800, 100), Point2(100, 100), Point2(100, 300),
               Point2(220, 300), Point2(220, 450), Point2(100, 450), Point2(100, 700), Point2(360, 700)})}});
  ASSERT_THAT(clean, test::IsOk());
  EXPECT_TRUE(is_inside(*clean, 500, 400));
  EXPECT_FALSE(is_inside(*clean, 150, 375));
  EXPECT_EQ(clean->gaps.size(), 1U);
}

TEST(Outline, HasNoInsideWhereWallsMeetNowhere) {
  EXPECT_THAT(
      clean_sketch(
          {800, 600, {drawn({Point2(100, 100), Point2(600, 110)}), drawn({Point2(100, 500), Point2(600, 480)})}}),
      test::Fails(Errc::kDegenerate));
}

TEST(Gaps, AnOvershootingLineIsNone) {
  // A wall that was meant to end at another one and ran on past it.
  const std::vector<Stroke> walls{drawn({Point2(100, 100), Point2(700, 100)}),
                                  drawn({Point2(400, 500), Point2(400, 88)}),
                                  drawn({Point2(440, 60), Point2(440, 97)})};
  for (const SketchGap& gap : find_gaps(walls, 600, {})) EXPECT_GT((gap.gap_px.a - Point2(400, 88)).norm(), 1);
}

TEST(Gaps, ALineThatStopsShortIsClosedByUs) {
  const std::vector<Stroke> walls{drawn({Point2(100, 100), Point2(700, 100)}),
                                  drawn({Point2(400, 500), Point2(400, 112)})};
  const auto gaps = find_gaps(walls, 600, {});
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_TRUE(gaps[0].closed_by_us);
  EXPECT_NEAR(gaps[0].gap_px.length(), 12, 1e-6);
}

}  // namespace
}  // namespace smokemap
