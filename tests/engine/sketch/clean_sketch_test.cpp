#include "sketch/clean_sketch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

Stroke wall(std::vector<Point2> points) {
  Stroke s;
  s.points_px = std::move(points);
  return s;
}

/// A line as a hand draws it: wobbling by up to two pixels.
Stroke wobbly(std::mt19937_64& random, const Point2& a, const Point2& b) {
  std::vector<Point2> points;
  for (int i = 0; i <= 20; ++i)
    points.push_back(a + (b - a) * i / 20 + Point2(uniform(random, -2, 2), uniform(random, -2, 2)));
  return wall(points);
}

SketchMap two_rooms(std::mt19937_64& random, double slip) {
  SketchMap sketch{800, 600, {}};
  const auto line = [&](double x1, double y1, double x2, double y2) {
    const Point2 a(x1, y1), b(x2, y2), u = (b - a).normalized();
    sketch.strokes.push_back(wobbly(random, a + slip * u, b - slip * u));
  };
  line(100, 100, 700, 100), line(700, 100, 700, 500), line(700, 500, 100, 500), line(100, 500, 100, 100),
      line(400, 100, 400, 500);
  return sketch;
}

int regions(const cv::Mat& free) {
  cv::Mat labels;
  return cv::connectedComponents(free, labels, 4) - 1;
}

TEST(CleanSketch, RoomsOfWobblyLinesComeOutClosed) {
  auto random = random_stream(1, 0);
  for (int trial = 0; trial < 10; ++trial) {
    const auto clean = clean_sketch(two_rooms(random, uniform(random, -6, 7)));
    ASSERT_THAT(clean, IsOk());
    EXPECT_EQ(regions(clean->free_space), 2) << trial;
    EXPECT_EQ(clean->free_space.at<uchar>(300, 250), 255);
    EXPECT_EQ(clean->free_space.at<uchar>(50, 50), 0) << "outside";
  }
}

TEST(CleanSketch, ReportsTheGapsThatItClosed) {
  auto random = random_stream(2, 0);
  const auto clean = clean_sketch(two_rooms(random, 7));
  ASSERT_THAT(clean, IsOk());
  EXPECT_GE(std::count_if(clean->gaps.begin(), clean->gaps.end(), [](const SketchGap& g) { return g.closed_by_us; }),
            4);
}

TEST(CleanSketch, ALargerGapStaysOpenAndIsReported) {
  SketchMap sketch{800,
                   600,
                   {wall({Point2(380, 100), Point2(100, 100), Point2(100, 500), Point2(700, 500), Point2(700, 100),
                          Point2(440, 100)})}};
  const auto clean = clean_sketch(sketch);
  ASSERT_THAT(clean, IsOk());
  ASSERT_EQ(clean->gaps.size(), 1U);
  EXPECT_FALSE(clean->gaps[0].closed_by_us);
  EXPECT_NEAR(clean->gaps[0].gap_px.length(), 60, 1e-9);
  EXPECT_EQ(clean->free_space.at<uchar>(300, 400), 255) << "a room with a door is a room";
  EXPECT_EQ(clean->free_space.at<uchar>(40, 400), 0);
}

TEST(CleanSketch, ADoorStrokeOpensTheWallItLiesOn) {
  auto random = random_stream(3, 0);
  auto sketch = two_rooms(random, 0);
  Stroke door = wall({Point2(400, 280), Point2(400, 340)});
  door.kind = StrokeKind::kDoor;
  sketch.strokes.push_back(door);
  const auto clean = clean_sketch(sketch);
  ASSERT_THAT(clean, IsOk());
  EXPECT_EQ(regions(clean->free_space), 1);
  EXPECT_TRUE(std::any_of(clean->gaps.begin(), clean->gaps.end(), [](const SketchGap& g) {
    return !g.closed_by_us && (g.gap_px.midpoint() - Point2(400, 310)).norm() < 3;
  }));
}

TEST(CleanSketch, ADoorStrokeAcrossAWallOpensIt) {
  auto random = random_stream(4, 0);
  auto sketch = two_rooms(random, 0);
  Stroke door = wall({Point2(375, 300), Point2(425, 300)});
  door.kind = StrokeKind::kDoor;
  sketch.strokes.push_back(door);
  const auto clean = clean_sketch(sketch);
  ASSERT_THAT(clean, IsOk());
  EXPECT_EQ(regions(clean->free_space), 1);
}

TEST(CleanSketch, NotesAreNoWalls) {
  auto random = random_stream(5, 0);
  auto sketch = two_rooms(random, 0);
  Stroke note = wall({Point2(120, 300), Point2(380, 300)});
  note.kind = StrokeKind::kNote;
  sketch.strokes.push_back(note);
  EXPECT_EQ(regions(clean_sketch(sketch)->free_space), 2);
}

TEST(CleanSketch, TheOrderOfStrokesDoesNotMatter) {
  auto random = random_stream(6, 0);
  auto sketch = two_rooms(random, 5);
  const auto before = clean_sketch(sketch);
  std::shuffle(sketch.strokes.begin(), sketch.strokes.end(), random);
  const auto after = clean_sketch(sketch);
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_EQ(cv::countNonZero(before->free_space != after->free_space), 0);
}

TEST(CleanSketch, TurnsItsAnswerWithTheSheet) {
  auto random = random_stream(7, 0);
  const auto sketch = two_rooms(random, 6);
  SketchMap turned{600, 800, sketch.strokes};
  for (auto& s : turned.strokes)
    for (auto& p : s.points_px) p = Point2(599 - p.y(), p.x());
  const auto one = clean_sketch(sketch), two = clean_sketch(turned);
  ASSERT_TRUE(one.ok() && two.ok());
  cv::Mat expected;
  cv::rotate(one->free_space, expected, cv::ROTATE_90_CLOCKWISE);
  EXPECT_LT(cv::countNonZero(expected != two->free_space), 0.02 * cv::countNonZero(expected));
  EXPECT_EQ(one->gaps.size(), two->gaps.size());
}

TEST(CleanSketch, FilledPixelsAreFreeOrNot) {
  auto random = random_stream(8, 0);
  const auto clean = clean_sketch(two_rooms(random, 0));
  ASSERT_THAT(clean, IsOk());
  EXPECT_EQ(clean->free_space.size(), cv::Size(800, 600));
  EXPECT_EQ(cv::countNonZero(clean->free_space == 255) + cv::countNonZero(clean->free_space == 0), 800 * 600);
}

TEST(CleanSketch, SaysNoToSketchesWithoutRooms) {
  EXPECT_THAT(clean_sketch(SketchMap{}), Fails(Errc::kDegenerate));
  EXPECT_THAT(clean_sketch(SketchMap{800, 600, {wall({Point2(100, 100), Point2(500, 100)})}}),
              Fails(Errc::kDegenerate));
  EXPECT_THAT(clean_sketch(SketchMap{800, 600, {wall({Point2(100, 100)})}}), Fails(Errc::kDegenerate));
  EXPECT_THAT(clean_sketch(SketchMap{0, 600, {wall({Point2(1, 1), Point2(2, 2)})}}), Fails(Errc::kInvalidArgument));
  EXPECT_THAT(clean_sketch(SketchMap{100000, 100000, {wall({Point2(1, 1), Point2(2, 2)})}}), Fails(Errc::kTooLarge));
  EXPECT_THAT(clean_sketch(SketchMap{800, 600, {wall({Point2(NAN, 1), Point2(2, 2)})}}), Fails(Errc::kInvalidArgument));
}

TEST(CleanSketch, RandomScribblesNeverCrash) {
  auto random = random_stream(9, 0);
  for (int trial = 0; trial < 40; ++trial) {
    SketchMap sketch{300, 200, {}};
    const auto count = uniform_index(random, 12);
    for (std::uint64_t i = 0; i < count; ++i) {
      Stroke s;
      s.kind = static_cast<StrokeKind>(uniform_index(random, 3));
      s.width_px = uniform(random, 0, 20);
      const auto points = uniform_index(random, 8);
      for (std::uint64_t p = 0; p < points; ++p)
        s.points_px.emplace_back(uniform(random, -100, 400), uniform(random, -100, 300));
      sketch.strokes.push_back(s);
    }
    const auto clean = clean_sketch(sketch);
    if (clean.ok()) {
      EXPECT_EQ(clean->free_space.size(), cv::Size(300, 200));
    }
  }
}

}  // namespace
}  // namespace smokemap
