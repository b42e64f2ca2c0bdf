#include "layout/signs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>

namespace smokemap {
namespace {

const std::map<std::string, cv::Scalar> kSafetyColours{
    {"green", {80, 132, 0}}, {"red", {40, 30, 200}}, {"yellow", {0, 200, 245}}, {"blue", {170, 90, 0}}};

/// A sheet with black walls and a corridor's pale tint.
cv::Mat bare_sheet() {
  cv::Mat sheet(1000, 1400, CV_8UC3, cv::Scalar(255, 255, 255));
  cv::rectangle(sheet, cv::Rect(100, 400, 1200, 120), cv::Scalar(205, 235, 205), cv::FILLED);
  cv::rectangle(sheet, cv::Rect(100, 200, 1200, 600), cv::Scalar(25, 25, 25), 10);
  cv::line(sheet, {700, 200}, {700, 400}, cv::Scalar(25, 25, 25), 6);
  return sheet;
}

void draw_sign(cv::Mat& sheet, const cv::Point& middle, const cv::Scalar& colour, int size = 34) {
  cv::rectangle(sheet, cv::Rect(middle.x - size / 2, middle.y - size / 2, size, size), colour, cv::FILLED);
  cv::circle(sheet, middle, size / 5, cv::Scalar(255, 255, 255), cv::FILLED);
}

Signs signs_of(const cv::Mat& sheet) {
  const LayoutParams params;
  return find_signs(divide_light(sheet, params.background_share), params);
}

cv::Mat gray_copy(const cv::Mat& sheet) {
  cv::Mat gray, copy;
  cv::cvtColor(sheet, gray, cv::COLOR_BGR2GRAY);
  cv::cvtColor(gray, copy, cv::COLOR_GRAY2BGR);
  return copy;
}

const LayoutSign* sign_near(const Signs& signs, const Point2& p) {
  const auto found = std::find_if(signs.signs.begin(), signs.signs.end(),
                                  [&](const LayoutSign& s) { return (s.p_px - p).norm() < 6; });
  return found == signs.signs.end() ? nullptr : &*found;
}

TEST(Signs, AreToldByTheirColour) {
  cv::Mat sheet = bare_sheet();
  int x = 200;
  for (const auto& [name, colour] : kSafetyColours) draw_sign(sheet, {x, 600}, colour), x += 120;
  const Signs signs = signs_of(sheet);
  EXPECT_EQ(signs.signs.size(), kSafetyColours.size());
  x = 200;
  for (const auto& [name, colour] : kSafetyColours) {
    const auto* sign = sign_near(signs, {static_cast<double>(x), 600});
    ASSERT_NE(sign, nullptr) << name;
    EXPECT_EQ(sign->colour, name);
    EXPECT_NEAR(sign->radius_px, 17, 3);
    EXPECT_EQ(signs.covered.at<uchar>(600, x), 255);
    x += 120;
  }
}

TEST(Signs, ComeInReadingOrder) {
  cv::Mat sheet = bare_sheet();
  for (const cv::Point& at : {cv::Point(900, 700), cv::Point(300, 700), cv::Point(600, 300)})
    draw_sign(sheet, at, kSafetyColours.at("red"));
  const Signs signs = signs_of(sheet);
  ASSERT_EQ(signs.signs.size(), 3U);
  EXPECT_LT(signs.signs[0].p_px.y(), signs.signs[1].p_px.y());
  EXPECT_LT(signs.signs[1].p_px.x(), signs.signs[2].p_px.x());
}

TEST(Signs, AreNeitherHeadersNorRoutesNorTints) {
  cv::Mat sheet = bare_sheet();
  cv::rectangle(sheet, cv::Rect(20, 20, 1360, 80), kSafetyColours.at("green"), cv::FILLED);
  cv::line(sheet, {200, 460}, {900, 460}, kSafetyColours.at("green"), 6);
  EXPECT_TRUE(signs_of(sheet).signs.empty());
  EXPECT_TRUE(signs_of(bare_sheet()).signs.empty());
}

TEST(Signs, ABlueDiscIsWhereYouAre) {
  cv::Mat sheet = bare_sheet();
  cv::circle(sheet, {500, 460}, 14, kSafetyColours.at("blue"), cv::FILLED, cv::LINE_AA);
  draw_sign(sheet, {300, 600}, kSafetyColours.at("blue"));
  const Signs signs = signs_of(sheet);
  ASSERT_TRUE(signs.you_are_here_px.has_value());
  EXPECT_LT((*signs.you_are_here_px - Point2(500, 460)).norm(), 3);
  EXPECT_EQ(signs.signs.size(), 1U);
}

// Regression: on gray copies no sign was found, and walls ended at every one of them.
TEST(Signs, OnAGrayCopyAreGreyFiguresLighterThanWalls) {
  cv::Mat sheet = bare_sheet();
  const std::vector<cv::Point> places{{200, 600}, {440, 600}, {700, 300}};  // the last one over a wall
  for (const auto& at : places) draw_sign(sheet, at, kSafetyColours.at("green"));
  const Signs signs = signs_of(gray_copy(sheet));
  for (const auto& at : places) {
    const auto* sign = sign_near(signs, {static_cast<double>(at.x), static_cast<double>(at.y)});
    ASSERT_NE(sign, nullptr) << at.x;
    EXPECT_EQ(sign->colour, "grey");
    EXPECT_EQ(signs.covered.at<uchar>(at.y, at.x), 255);
  }
  EXPECT_EQ(signs.covered.at<uchar>(200, 1000), 0) << "a wall is no sign";
}

TEST(Signs, OneColouredSignIsEnoughToTrustTheColours) {
  cv::Mat sheet = bare_sheet();
  draw_sign(sheet, {200, 600}, kSafetyColours.at("green"));
  draw_sign(sheet, {440, 600}, cv::Scalar(140, 140, 140));  // a gray box of furniture
  const Signs signs = signs_of(sheet);
  ASSERT_EQ(signs.signs.size(), 1U);
  EXPECT_EQ(signs.signs[0].colour, "green");
}

TEST(Signs, ConfidenceIsAShare) {
  cv::Mat sheet = bare_sheet();
  draw_sign(sheet, {200, 600}, kSafetyColours.at("green"));
  for (const cv::Mat& picture : {sheet, gray_copy(sheet)})
    for (const auto& sign : signs_of(picture).signs) {
      EXPECT_GE(sign.confidence, 0);
      EXPECT_LE(sign.confidence, 1);
    }
}

// Regression: a sign on the arc of a door was one piece with it, and lost.
TEST(Signs, OnAGrayCopyAreFoundOnTheArcsOfDoors) {
  cv::Mat sheet = bare_sheet();
  cv::ellipse(sheet, {400, 520}, {90, 90}, 0, 0, 90, cv::Scalar(60, 60, 60), 3, cv::LINE_AA);
  cv::line(sheet, {400, 520}, {490, 520}, cv::Scalar(60, 60, 60), 3, cv::LINE_AA);
  const cv::Point at(464, 584);  // on the arc
  draw_sign(sheet, at, kSafetyColours.at("green"), 40);
  cv::rectangle(sheet, cv::Rect(at.x - 11, at.y - 11, 22, 22), cv::Scalar(255, 255, 255), cv::FILLED);  // pictogram
  const Signs signs = signs_of(gray_copy(sheet));
  ASSERT_NE(sign_near(signs, {464, 584}), nullptr);
  EXPECT_EQ(signs.signs.size(), 1U);
}

// Heads of arrows are no signs, but what they hide is hidden.
TEST(Signs, OnAGrayCopyAreNoArrows) {
  cv::Mat sheet = bare_sheet();
  for (const int turn : {-1, 1}) {
    const int x = 700 + 200 * turn;
    cv::line(sheet, {x - 30 * turn, 460}, {x, 460}, cv::Scalar(90, 90, 90), 4);
    cv::fillConvexPoly(sheet, std::vector<cv::Point>{{x, 444}, {x, 476}, {x + 24 * turn, 460}}, cv::Scalar(90, 90, 90));
  }
  draw_sign(sheet, {300, 650}, kSafetyColours.at("red"));
  const Signs signs = signs_of(gray_copy(sheet));
  ASSERT_EQ(signs.signs.size(), 1U);
  EXPECT_LT((signs.signs[0].p_px - Point2(300, 650)).norm(), 6);
  for (const int x : {490, 910}) EXPECT_EQ(signs.covered.at<uchar>(460, x), 255) << x;
}

// Regression: soft letters with their holes filled hid each other's neighbours, and what was left of a word were walls.
TEST(Signs, AreNoSoftLetters) {
  cv::Mat sheet(1000, 1400, CV_8UC3, cv::Scalar(255, 255, 255));
  cv::rectangle(sheet, cv::Rect(100, 200, 1200, 600), cv::Scalar(0, 0, 0), 14);
  cv::putText(sheet, "BEDROOM 8 ROAD", {300, 500}, cv::FONT_HERSHEY_SIMPLEX, 0.6, cv::Scalar(0, 0, 0), 2, cv::LINE_AA);
  cv::GaussianBlur(sheet, sheet, {5, 5}, 1.0);
  EXPECT_EQ(cv::countNonZero(signs_of(sheet).covered(cv::Rect(280, 470, 400, 50))), 0);
}

}  // namespace
}  // namespace smokemap
