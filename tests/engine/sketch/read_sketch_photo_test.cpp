#include "sketch/read_sketch_photo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sketch/clean_sketch.hpp"
#include "sketch/drawing_lines.hpp"
#include "sketch/skeleton.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

/// Paper in uneven light, with a pen drawing of two rooms.
cv::Mat drawing(const cv::Scalar& pen, bool ruled) {
  cv::Mat paper(900, 1200, CV_8UC3, cv::Scalar(235, 238, 240));
  if (ruled)
    for (int y = 60; y < 900; y += 60)
      cv::line(paper, {0, y}, {1199, y + 6}, cv::Scalar(190, 190, 190), 2, cv::LINE_AA);
  const auto line = [&](int x1, int y1, int x2, int y2) { cv::line(paper, {x1, y1}, {x2, y2}, pen, 5, cv::LINE_AA); };
  line(200, 150, 1000, 156), line(1000, 156, 996, 740), line(996, 740, 204, 745), line(204, 745, 200, 150),
      line(600, 153, 604, 742);
  for (int y = 0; y < paper.rows; ++y)
    for (int x = 0; x < paper.cols; ++x)
      for (auto& value : paper.at<cv::Vec3b>(y, x).val)
        value = static_cast<uchar>(value * (0.55 + 0.4 * x / paper.cols));
  cv::GaussianBlur(paper, paper, {3, 3}, 0.8);
  return paper;
}

int rooms_of(const SketchPhoto& photo) {
  const auto clean = clean_sketch({photo.width_px, photo.height_px, photo.strokes});
  if (!clean.ok()) return 0;
  cv::Mat labels;
  return cv::connectedComponents(clean->free_space, labels, 4) - 1;
}

TEST(SketchPhoto, ReadsABlackPenInUnevenLight) {
  const auto photo = read_sketch_photo(drawing(cv::Scalar(30, 30, 30), false));
  ASSERT_THAT(photo, IsOk());
  EXPECT_EQ(rooms_of(*photo), 2);
  double length = 0;
  for (const auto& s : photo->strokes)
    for (std::size_t i = 0; i + 1 < s.points_px.size(); ++i) length += (s.points_px[i + 1] - s.points_px[i]).norm();
  EXPECT_NEAR(length, 800 + 584 + 792 + 595 + 589, 60);
}

TEST(SketchPhoto, TellsABluePenFromGrayRulings) {
  const auto photo = read_sketch_photo(drawing(cv::Scalar(170, 60, 40), true));
  ASSERT_THAT(photo, IsOk());
  EXPECT_EQ(rooms_of(*photo), 2);
}

TEST(SketchPhoto, DoesNotTakeLongWallsForPrintedLines) {
  // Three walls across two thirds of the picture were once left out as rulings.
  const auto photo = read_sketch_photo(drawing(cv::Scalar(30, 30, 30), false));
  ASSERT_THAT(photo, IsOk());
  EXPECT_TRUE(photo->warnings.empty());
}

TEST(SketchPhoto, LeavesPrintedLinesOutUnderABlackPen) {
  const auto photo = read_sketch_photo(drawing(cv::Scalar(30, 30, 30), true));
  ASSERT_THAT(photo, IsOk());
  EXPECT_EQ(rooms_of(*photo), 2);
}

TEST(SketchPhoto, LeavesOutTitlesRoomNamesAndJoinedUpWriting) {
  cv::Mat picture = drawing(cv::Scalar(30, 30, 30), false);
  const auto plain = read_sketch_photo(picture);
  cv::putText(picture, "GROUND FLOOR", {300, 90}, cv::FONT_HERSHEY_SIMPLEX, 2, cv::Scalar(30, 30, 30), 4, cv::LINE_AA);
  cv::putText(picture, "office", {300, 440}, cv::FONT_HERSHEY_SIMPLEX, 2.2, cv::Scalar(30, 30, 30), 4, cv::LINE_AA);
  cv::Point before(700, 420);
  for (int i = 1; i <= 60; ++i) {  // a wave that rises and falls like joined-up letters
    const cv::Point next(700 + 3 * i, 420 + static_cast<int>(std::lround(28 * std::sin(0.9 * i))));
    cv::line(picture, before, next, cv::Scalar(30, 30, 30), 4, cv::LINE_AA);
    before = next;
  }
  const auto written = read_sketch_photo(picture);
  ASSERT_TRUE(plain.ok() && written.ok());
  EXPECT_EQ(rooms_of(*written), 2);
  EXPECT_EQ(written->strokes.size(), plain->strokes.size());
}

TEST(SketchPhoto, KeepsAPieceOfWallThatStandsFreeInARoom) {
  cv::Mat picture = drawing(cv::Scalar(30, 30, 30), false);
  const auto plain = read_sketch_photo(picture);
  cv::line(picture, {300, 300}, {300, 500}, cv::Scalar(30, 30, 30), 5, cv::LINE_AA);
  const auto more = read_sketch_photo(picture);
  ASSERT_TRUE(plain.ok() && more.ok());
  EXPECT_EQ(more->strokes.size(), plain->strokes.size() + 1);
}

TEST(SketchPhoto, LeavesHatchingOutAndTheBoxRoundItIn) {
  cv::Mat picture = drawing(cv::Scalar(30, 30, 30), false);
  cv::rectangle(picture, {700, 155}, {860, 300}, cv::Scalar(30, 30, 30), 5, cv::LINE_AA);
  for (int x = 715; x < 850; x += 16)
    cv::line(picture, {x, 300}, {x + 10, 155}, cv::Scalar(30, 30, 30), 2, cv::LINE_AA);
  const auto photo = read_sketch_photo(picture);
  ASSERT_THAT(photo, IsOk());
  EXPECT_EQ(rooms_of(*photo), 3);
}

TEST(SketchPhoto, StrokesLieOnTheInk) {
  const cv::Mat picture = drawing(cv::Scalar(30, 30, 30), false);
  const auto photo = read_sketch_photo(picture);
  ASSERT_THAT(photo, IsOk());
  for (const auto& s : photo->strokes)
    for (const auto& p : s.points_px) {
      ASSERT_TRUE(p.x() >= 0 && p.y() >= 0 && p.x() < picture.cols && p.y() < picture.rows);
      const cv::Rect around = cv::Rect(static_cast<int>(p.x()) - 4, static_cast<int>(p.y()) - 4, 9, 9) &
                              cv::Rect(0, 0, picture.cols, picture.rows);
      cv::Mat green;
      cv::extractChannel(picture(around), green, 1);
      double darkest = 255;
      cv::minMaxLoc(green, &darkest);
      EXPECT_LT(darkest, 110);
    }
}

TEST(SketchPhoto, GivesTheSameStrokesTwice) {
  const cv::Mat picture = drawing(cv::Scalar(30, 30, 30), true);
  const auto one = read_sketch_photo(picture), two = read_sketch_photo(picture);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->strokes.size(), two->strokes.size());
  for (std::size_t i = 0; i < one->strokes.size(); ++i) EXPECT_EQ(one->strokes[i].points_px, two->strokes[i].points_px);
}

TEST(SketchPhoto, SaysNoToPicturesWithoutADrawing) {
  EXPECT_THAT(read_sketch_photo(cv::Mat()), Fails(Errc::kInvalidArgument));
  EXPECT_THAT(read_sketch_photo(cv::Mat(1, 1, CV_8UC3, cv::Scalar(0, 0, 0))), Fails(Errc::kDegenerate));
  EXPECT_THAT(read_sketch_photo(cv::Mat(500, 500, CV_8UC3, cv::Scalar(250, 250, 250))), Fails(Errc::kDegenerate));
  SketchPhotoParams params;
  params.max_megapixels = 0.1;
  EXPECT_THAT(read_sketch_photo(cv::Mat(500, 500, CV_8UC3, cv::Scalar(250, 250, 250)), params), Fails(Errc::kTooLarge));
}

TEST(Skeleton, WalksACrossFromItsMiddle) {
  cv::Mat mask = cv::Mat::zeros(101, 101, CV_8UC1);
  cv::line(mask, {10, 50}, {90, 50}, cv::Scalar(255), 3);
  cv::line(mask, {50, 10}, {50, 90}, cv::Scalar(255), 3);
  const auto branches = trace_skeleton(mask, 5);
  int arms = 0;
  for (const auto& b : branches)
    if (b.free_a != b.free_b && b.points.size() > 25) ++arms;
  EXPECT_EQ(arms, 4);
}

TEST(Skeleton, WalksARingAsOneClosedBranch) {
  cv::Mat mask = cv::Mat::zeros(101, 101, CV_8UC1);
  cv::circle(mask, {50, 50}, 30, cv::Scalar(255), 3);
  const auto branches = trace_skeleton(mask, 5);
  ASSERT_EQ(branches.size(), 1U);
  EXPECT_EQ(branches[0].points.front(), branches[0].points.back());
  EXPECT_GT(branches[0].points.size(), 150U);
}

TEST(Hatching, IsLeftOutAndWallsAreNot) {
  std::vector<Polyline> lines;
  for (int i = 0; i < 8; ++i) lines.push_back({Point2(100 + 8 * i, 200), Point2(120 + 8 * i, 160)});
  lines.push_back({Point2(0, 0), Point2(500, 0)});
  lines.push_back({Point2(0, 300), Point2(500, 300)});
  EXPECT_EQ(without_hatching(lines, std::vector<double>(lines.size(), 3.0), 20).size(), 2U);
}

TEST(Hatching, LeavesTheStrongerLineOfAWallBesideSteps) {
  std::vector<Polyline> lines;
  for (int i = 0; i < 8; ++i) lines.push_back({Point2(100, 200 + 15 * i), Point2(200, 200 + 15 * i)});
  std::vector<double> widths(lines.size(), 3.0);
  widths[0] = 6;
  const auto kept = without_hatching(lines, widths, 20);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].front(), Point2(100, 200));
}

}  // namespace
}  // namespace smokemap
