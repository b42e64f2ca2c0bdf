#include "sketch/hatching.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "sketch/clean_sketch.hpp"
#include "sketch/read_sketch_photo.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Stroke line_of(StrokeKind kind, std::vector<Point2> points_px) {
  Stroke stroke;
  stroke.kind = kind;
  stroke.points_px = std::move(points_px);
  return stroke;
}

/// A house 600 x 400 with a box in its upper right corner, hatched at `heading_rad` with `count` lines.
SketchMap house_with_box(double heading_rad, int count, StrokeKind kind) {
  SketchMap sketch;
  sketch.width_px = 800, sketch.height_px = 600;
  sketch.strokes = {line_of(StrokeKind::kWall, {{100, 100}, {700, 100}, {700, 500}, {100, 500}, {100, 100}}),
                    line_of(StrokeKind::kWall, {{560, 100}, {560, 220}, {700, 220}})};
  const Hatching box{{{564, 104}, {696, 104}, {696, 216}, {564, 216}}, heading_rad};
  const std::vector<Segment2> lines = hatching_lines(box);
  for (int i = 0; i < std::min(count, static_cast<int>(lines.size())); ++i)
    sketch.strokes.push_back(
        line_of(kind, {lines[static_cast<std::size_t>(i)].a, lines[static_cast<std::size_t>(i)].b}));
  return sketch;
}

bool is_free(const SketchMap& sketch, int x, int y) {
  const auto clean = clean_sketch(sketch);
  return clean.ok() && clean->free_space.at<uchar>(y, x) == 255;
}

TEST(Hatching, OfAPenIsFilledAndTheRestStaysFree) {
  for (const StrokeKind kind : {StrokeKind::kWall, StrokeKind::kNote})
    for (const double heading : {0.6, kPi / 4, 2.2}) {
      const SketchMap sketch = house_with_box(heading, 8, kind);
      EXPECT_FALSE(is_free(sketch, 630, 160));
      EXPECT_FALSE(is_free(sketch, 570, 110)) << "the corners that no line reaches belong to it";
      EXPECT_TRUE(is_free(sketch, 300, 300));
      EXPECT_TRUE(is_free(sketch, 650, 300));
    }
}

TEST(Hatching, IsNoStair) {
  for (const double heading : {0.0, kPi / 2, 0.1})
    EXPECT_TRUE(find_hatched_strokes(house_with_box(heading, 8, StrokeKind::kNote).strokes, 600).areas.empty());
  EXPECT_TRUE(is_free(house_with_box(0, 8, StrokeKind::kNote), 630, 160)) << "people walk on steps";
}

TEST(Hatching, TakesFourLines) {
  EXPECT_TRUE(find_hatched_strokes(house_with_box(0.8, 3, StrokeKind::kWall).strokes, 600).areas.empty());
  const HatchedStrokes four = find_hatched_strokes(house_with_box(0.8, 4, StrokeKind::kWall).strokes, 600);
  ASSERT_EQ(four.areas.size(), 1u);
  EXPECT_EQ(std::count(four.is_hatching.begin(), four.is_hatching.end(), true), 4);
  EXPECT_NEAR(line_angle_between(four.areas.front().heading_rad, 0.8), 0, 0.01);
}

TEST(Hatching, OfTwoBoxesIsTwoAreasInAnyOrderOfStrokes) {
  SketchMap sketch = house_with_box(0.8, 8, StrokeKind::kWall);
  const SketchMap other = house_with_box(0.8, 8, StrokeKind::kWall);
  for (std::size_t i = 2; i < other.strokes.size(); ++i) {
    Stroke moved = other.strokes[i];
    for (Point2& p : moved.points_px) p += Point2(-440, 260);
    sketch.strokes.push_back(moved);
  }
  std::mt19937_64 random(1);
  for (int round = 0; round < 5; ++round) {
    std::shuffle(sketch.strokes.begin(), sketch.strokes.end(), random);
    EXPECT_EQ(find_hatched_strokes(sketch.strokes, 600).areas.size(), 2u);
  }
}

TEST(Hatching, TurnsWithTheDrawing) {
  const SketchMap upright = house_with_box(0.8, 8, StrokeKind::kWall);
  for (const double turn : {0.3, 0.8, 1.4, 2.5}) {
    SketchMap turned = upright;
    const Eigen::Rotation2Dd rotation(turn);
    for (Stroke& stroke : turned.strokes)
      for (Point2& p : stroke.points_px) p = rotation * (p - Point2(400, 300)) + Point2(400, 300);
    const HatchedStrokes found = find_hatched_strokes(turned.strokes, 600);
    ASSERT_EQ(found.areas.size(), 1u) << turn;
    EXPECT_NEAR(line_angle_between(found.areas.front().heading_rad, 0.8 + turn), 0, 0.01);
  }
}

TEST(Hatching, LinesLieInTheirAreaAndRunItsWay) {
  const Hatching area{{{0, 0}, {100, 0}, {100, 60}, {0, 60}}, 0.7};
  const std::vector<Segment2> lines = hatching_lines(area);
  EXPECT_GE(lines.size(), 4u);
  for (const Segment2& line : lines) {
    EXPECT_NEAR(line_angle_between(line.heading(), 0.7), 0, 1e-9);
    for (const Point2& p : {line.a, line.b}) {
      EXPECT_GE(p.minCoeff(), -1e-9);
      EXPECT_LE(p.x(), 100 + 1e-9);
      EXPECT_LE(p.y(), 60 + 1e-9);
    }
  }
}

/// Ink of a house with two boxes: one hatched aslant, one with steps.
cv::Mat house_of_ink(double slant) {
  cv::Mat ink(900, 1200, CV_8UC1, cv::Scalar(0));
  cv::rectangle(ink, {150, 120}, {1050, 780}, cv::Scalar(255), 5);
  cv::rectangle(ink, {800, 120}, {1050, 260}, cv::Scalar(255), 5);
  cv::rectangle(ink, {150, 600}, {350, 780}, cv::Scalar(255), 5);
  for (int x = 800 - 140; x < 1050; x += 24) {
    const double lift = 140 * slant;
    cv::Mat box = ink(cv::Rect(800, 120, 250, 140));
    cv::line(box, {x - 800, 140}, {static_cast<int>(x - 800 + lift), 0}, cv::Scalar(255), 2);
  }
  for (int y = 600; y < 780; y += 22) cv::line(ink, {150, y}, {350, y}, cv::Scalar(255), 2);
  return ink;
}

TEST(HatchedInk, IsFoundAsItsBoxAndStepsAreNot) {
  const std::vector<Hatching> found = find_hatched_ink(house_of_ink(0.9));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(std::abs(signed_area(found.front().outline_px)), 250 * 140, 0.12 * 250 * 140);
  EXPECT_NEAR(line_angle_between(found.front().heading_rad, std::atan2(-1, 0.9)), 0, 0.15);
}

TEST(HatchedInk, OfPlainWallsIsNone) {
  cv::Mat ink(900, 1200, CV_8UC1, cv::Scalar(0));
  cv::rectangle(ink, {150, 120}, {1050, 780}, cv::Scalar(255), 5);
  cv::line(ink, {150, 120}, {1050, 780}, cv::Scalar(255), 5);
  cv::line(ink, {400, 120}, {400, 780}, cv::Scalar(255), 5);
  EXPECT_TRUE(find_hatched_ink(ink).empty());
  EXPECT_TRUE(find_hatched_ink(cv::Mat::zeros(50, 60, CV_8UC1)).empty());
}

TEST(HatchedInk, OnAPhotographBecomesNoRooms) {
  // Slivers between the lines of a shaft were once six rooms.
  const cv::Mat ink = house_of_ink(0.9);
  cv::Mat picture(ink.size(), CV_8UC3, cv::Scalar(235, 238, 240));
  picture.setTo(cv::Scalar(30, 30, 30), ink);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) picture.at<cv::Vec3b>(y, x) *= 0.55 + 0.4 * x / picture.cols;
  cv::GaussianBlur(picture, picture, {3, 3}, 0.8);
  const auto photo = read_sketch_photo(picture);
  ASSERT_THAT(photo, test::IsOk()) << photo.error().message;
  const auto clean = clean_sketch({photo->width_px, photo->height_px, photo->strokes});
  ASSERT_THAT(clean, test::IsOk());
  EXPECT_EQ(cv::countNonZero(clean->free_space(cv::Rect(815, 135, 220, 110))), 0);
  EXPECT_GT(cv::countNonZero(clean->free_space(cv::Rect(400, 300, 500, 400))), 0.95 * 500 * 400);
}

}  // namespace
}  // namespace smokemap
