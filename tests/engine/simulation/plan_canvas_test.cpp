#include "simulation/plan_canvas.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

const cv::Scalar kBlack(0, 0, 0);

/// Ink of the whole picture in units of a fully black pixel, and where its centre lies.
struct Ink {
  double amount = 0;
  Point2 center = Point2::Zero();
};
Ink ink_of(const PlanCanvas& canvas) {
  cv::Mat gray;
  cv::cvtColor(canvas.picture(), gray, cv::COLOR_BGR2GRAY);
  Ink ink;
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x) {
      const double dark = (255 - gray.at<uchar>(y, x)) / 255.0;
      ink.amount += dark;
      ink.center += dark * Point2(x, y);
    }
  if (ink.amount > 0) ink.center /= ink.amount;
  return ink;
}

TEST(PlanCanvas, IsWhiteToBeginWith) {
  const PlanCanvas canvas(40, 30);
  EXPECT_EQ(ink_of(canvas).amount, 0);
  EXPECT_EQ(canvas.picture().cols, 40);
  EXPECT_EQ(canvas.picture().rows, 30);
}

TEST(PlanCanvas, FillsBoxesToAThirdOfAPixel) {
  PlanCanvas canvas(60, 60);
  canvas.box({10.25, 20.5}, {30.25, 40.5}, kBlack);
  const Ink ink = ink_of(canvas);
  EXPECT_NEAR(ink.center.x(), 20.25, 0.3);
  EXPECT_NEAR(ink.center.y(), 30.5, 0.3);
  EXPECT_NEAR(std::sqrt(ink.amount), 20.3, 0.6);
}

TEST(PlanCanvas, DrawsLinesOfTheAskedWidth) {
  PlanCanvas canvas(120, 40);
  canvas.line({10, 20}, {110, 20}, 4, kBlack);
  const Ink ink = ink_of(canvas);
  EXPECT_NEAR(ink.amount / 100, 4, 1.2);
  EXPECT_NEAR(ink.center.y(), 20, 0.3);
}

TEST(PlanCanvas, DrawsArcsCounterClockwise) {
  PlanCanvas canvas(100, 100);
  canvas.arc({50, 50}, 30, 0, kPi / 2, 2, kBlack);  // the upper right quarter of the picture
  const Ink ink = ink_of(canvas);
  EXPECT_GT(ink.center.x(), 60);
  EXPECT_LT(ink.center.y(), 40);
  EXPECT_NEAR(ink.amount, 30 * kPi / 2 * 2, 50);
}

TEST(PlanCanvas, PointsArrowsForward) {
  PlanCanvas canvas(100, 40);
  canvas.arrow({20, 20}, {80, 20}, 6, kBlack);
  const Ink ink = ink_of(canvas);
  EXPECT_GT(ink.center.x(), 50) << "the head is the heavy end";
  EXPECT_NEAR(ink.center.y(), 20, 0.3);
}

TEST(PlanCanvas, WritesTextAboveItsBaseline) {
  PlanCanvas canvas(200, 60);
  canvas.text("EXIT", {100, 40}, 14, kBlack, PlanCanvas::Anchor::kCenter);
  const Ink ink = ink_of(canvas);
  EXPECT_GT(ink.amount, 50);
  EXPECT_NEAR(ink.center.x(), 100, 6);
  EXPECT_NEAR(ink.center.y(), 33, 4);
}

TEST(PlanSymbols, HaveTheColourTheyAreKnownBy) {
  for (const PlanSymbol symbol : {PlanSymbol::kExit, PlanSymbol::kExtinguisher, PlanSymbol::kAlarm,
                                  PlanSymbol::kFirstAid, PlanSymbol::kYouAreHere}) {
    PlanCanvas canvas(40, 40);
    draw_symbol(canvas, symbol, {20, 20}, 30);
    const cv::Vec3b edge = canvas.picture().at<cv::Vec3b>(20, 7);
    const std::string word = colour_word(symbol);
    const int channel = word == "red" ? 2 : word == "green" ? 1 : 0;
    for (int other = 0; other < 3; ++other) {
      if (other != channel) {
        EXPECT_GT(edge[channel], edge[other]) << word;
      }
    }
  }
}

TEST(PlanSheet, KeepsThePlansAreaFree) {
  PlanCanvas canvas(1600, 1131);
  draw_sheet(canvas, "Evacuation plan", "Somewhere");
  const cv::Mat area = canvas.picture()(cv::Rect(40, 120, 1120, 930));
  EXPECT_EQ(cv::norm(area, cv::Mat(area.size(), CV_8UC3, cv::Scalar::all(255)), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace smokemap
