#include "sketch/drawing_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "sketch/figures.hpp"
#include "sketch/pen.hpp"

namespace smokemap {
namespace {

constexpr int kPrinted = 60, kPen = 200;

struct Ink {
  cv::Mat mask = cv::Mat::zeros(600, 800, CV_8UC1);
  cv::Mat strength = cv::Mat::zeros(600, 800, CV_8UC1);

  void line(const cv::Point& a, const cv::Point& b, int value) {
    cv::line(mask, a, b, cv::Scalar(255), 3);
    cv::line(strength, a, b, cv::Scalar(value), 3);
  }
};

Ink ruled_sheet(double slope) {
  Ink ink;
  for (int y = 40; y < 560; y += 50) ink.line({0, y}, {799, y + static_cast<int>(slope * 799)}, kPrinted);
  return ink;
}

TEST(RuledLines, AreErasedAndThePenStays) {
  for (const double slope : {0.0, 0.02, -0.03}) {
    Ink ink = ruled_sheet(slope);
    ink.line({200, 100}, {210, 480}, kPen);
    ink.line({210, 480}, {600, 470}, kPen);
    const int before = cv::countNonZero(ink.strength == kPen);
    EXPECT_GE(erase_ruled_lines(ink.mask, ink.strength, 3.0), 8) << slope;
    EXPECT_LT(cv::countNonZero(ink.mask & (ink.strength == kPrinted)), 0.15 * 11 * 3 * 800) << slope;
    EXPECT_GT(cv::countNonZero(ink.mask & (ink.strength == kPen)), 0.97 * before) << slope;
  }
}

TEST(RuledLines, AreNotTheLongWallsOfOnePen) {
  Ink ink;
  for (const int y : {80, 300, 520}) ink.line({60, y}, {740, y}, kPen);
  ink.line({60, 80}, {60, 520}, kPen), ink.line({740, 80}, {740, 520}, kPen);
  const cv::Mat before = ink.mask.clone();
  EXPECT_EQ(erase_ruled_lines(ink.mask, ink.strength, 3.0), 0);
  EXPECT_EQ(cv::countNonZero(before != ink.mask), 0);
}

TEST(RuledLines, TwoOfThemAreNoRuling) {
  Ink ink;
  ink.line({0, 100}, {799, 100}, kPrinted), ink.line({0, 400}, {799, 400}, kPrinted);
  EXPECT_EQ(erase_ruled_lines(ink.mask, ink.strength, 3.0), 0);
}

TEST(Straightened, StaysWithinItsToleranceOfWhatWasDrawn) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    SkeletonBranch branch;
    double y = 50;
    for (int x = 0; x < 200; ++x) branch.points.emplace_back(x, static_cast<int>(y += uniform(random, -1, 1)));
    const auto lines = straightened({branch}, 3.0);
    ASSERT_EQ(lines.size(), 1U);
    for (const cv::Point& p : branch.points) {
      double nearest = 1e9;
      for (std::size_t i = 0; i + 1 < lines[0].size(); ++i)
        nearest = std::min(nearest, distance({lines[0][i], lines[0][i + 1]}, Point2(p.x, p.y)));
      EXPECT_LE(nearest, 3.01);
    }
    EXPECT_LT(lines[0].size(), branch.points.size() / 2);
  }
}

TEST(PolylineLength, AddsItsPieces) {
  EXPECT_NEAR(polyline_length({Point2(0, 0), Point2(3, 4), Point2(3, 14)}), 15, 1e-12);
  EXPECT_EQ(polyline_length({Point2(1, 1)}), 0);
  EXPECT_EQ(polyline_length({}), 0);
}

/// A house of one line, and what else is drawn.
cv::Mat house() {
  cv::Mat mask = cv::Mat::zeros(600, 800, CV_8UC1);
  cv::rectangle(mask, {100, 100}, {700, 500}, cv::Scalar(255), 3);
  cv::line(mask, {400, 100}, {400, 500}, cv::Scalar(255), 3);
  return mask;
}

TEST(Figures, DotsLettersAndWhatStandsBesideTheHouseAreDropped) {
  cv::Mat mask = house();
  const cv::Mat before = mask.clone();
  cv::circle(mask, {200, 300}, 3, cv::Scalar(255), cv::FILLED);
  cv::putText(mask, "B", {540, 320}, cv::FONT_HERSHEY_SIMPLEX, 1, cv::Scalar(255), 2);
  cv::putText(mask, "HOME", {250, 70}, cv::FONT_HERSHEY_SIMPLEX, 1.5, cv::Scalar(255), 3);
  drop_small_figures(mask, 12, 40);
  EXPECT_EQ(cv::countNonZero(mask != before), 0);
}

TEST(Figures, RowsOfLettersAreDroppedAndALoneBoxIsNot) {
  cv::Mat mask = house();
  cv::rectangle(mask, {200, 200}, {240, 240}, cv::Scalar(255), 3);  // a pillar
  const cv::Mat before = mask.clone();
  cv::putText(mask, "lift 12", {450, 320}, cv::FONT_HERSHEY_SIMPLEX, 1.5, cv::Scalar(255), 3);
  drop_rows_of_letters(mask);
  EXPECT_EQ(cv::countNonZero((mask & before) != before), 0);
  EXPECT_LT(cv::countNonZero(mask != before), 100);  // dots of the letters at most
}

TEST(Figures, AWaveIsAWordAndAnAngleOfWallsIsNot) {
  cv::Mat mask = house();
  for (int x = 480; x < 640; ++x)
    cv::line(mask, {x, 300 + static_cast<int>(18 * std::sin(0.25 * x))},
             {x + 1, 300 + static_cast<int>(18 * std::sin(0.25 * (x + 1)))}, cv::Scalar(255), 3);
  cv::line(mask, {480, 310}, {640, 310}, cv::Scalar(255), 2);  // crossed out: many branches
  cv::line(mask, {180, 200}, {180, 300}, cv::Scalar(255), 3);
  cv::line(mask, {180, 300}, {300, 300}, cv::Scalar(255), 3);
  auto branches = trace_skeleton(mask, 4);
  drop_words(mask, branches);
  const auto inside = [&](const cv::Rect& box) {
    return std::count_if(branches.begin(), branches.end(),
                         [&](const SkeletonBranch& b) { return box.contains(b.points[b.points.size() / 2]); });
  };
  EXPECT_GE(inside({150, 150, 200, 200}), 1);
  EXPECT_GE(inside({90, 90, 40, 420}), 1);
}

TEST(Pen, IsFoundByItsColourOnGrayRuledPaperInShadow) {
  cv::Mat paper(500, 700, CV_8UC3, cv::Scalar(230, 232, 235));
  for (int y = 40; y < 500; y += 40) cv::line(paper, {0, y}, {699, y}, cv::Scalar(205, 205, 205), 2);
  cv::line(paper, {100, 90}, {600, 95}, cv::Scalar(160, 60, 40), 4);
  cv::line(paper, {100, 90}, {105, 420}, cv::Scalar(160, 60, 40), 4);
  for (int y = 0; y < paper.rows; ++y)
    for (int x = 350; x < paper.cols; ++x) paper.at<cv::Vec3b>(y, x) *= 0.6;  // a hard shadow
  const PenInk pen = find_pen(divide_light(paper, 0.03));
  EXPECT_TRUE(pen.coloured);
  EXPECT_EQ(pen.mask.at<uchar>(91, 200), 255);
  EXPECT_EQ(pen.mask.at<uchar>(94, 500), 255);
  EXPECT_EQ(pen.mask.at<uchar>(300, 102), 255);
  int on_rulings = 0;
  for (int x = 150; x < 700; x += 10) on_rulings += pen.mask.at<uchar>(240, x) != 0;
  EXPECT_LE(on_rulings, 3);
}

TEST(Pen, OfBlackInkHasNoColour) {
  cv::Mat paper(300, 400, CV_8UC3, cv::Scalar(240, 240, 240));
  cv::rectangle(paper, {50, 50}, {350, 250}, cv::Scalar(20, 20, 20), 4);
  const PenInk pen = find_pen(divide_light(paper, 0.03));
  EXPECT_FALSE(pen.coloured);
  EXPECT_EQ(pen.mask.at<uchar>(50, 200), 255);
  EXPECT_EQ(pen.mask.at<uchar>(150, 200), 0);
}

}  // namespace
}  // namespace smokemap
