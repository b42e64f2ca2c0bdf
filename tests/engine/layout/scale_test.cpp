#include "layout/scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

const LayoutParams kScaleParams{};

/// Doors of public buildings: 0.9 m and some, seen at `metres_per_pixel`.
std::vector<double> seen_doors(std::mt19937_64& random, std::size_t count, double metres_per_pixel) {
  std::vector<double> widths;
  for (std::size_t i = 0; i < count; ++i) widths.push_back(uniform(random, 0.8, 1.05) / metres_per_pixel);
  return widths;
}

TEST(GuessScale, TakesTheMedianDoorForWhatDoorsMeasure) {
  const auto scale = guess_scale({{44, 45, 46}, {}, {}}, kScaleParams);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->metres_per_pixel, 0.9 / 45, 0.01 * 0.9 / 45);
  EXPECT_GE(scale->relative_sigma, kScaleParams.door_width_sigma);
  EXPECT_FALSE(scale->by_person);
}

TEST(GuessScale, SaysNothingWithoutEvidence) {
  EXPECT_FALSE(guess_scale({}, kScaleParams).has_value());
  EXPECT_FALSE(guess_scale({{45, 45}, {}, {}}, kScaleParams).has_value()) << "two doors are a chance";
  EXPECT_FALSE(guess_scale({{0, -1, std::nan("")}, {}, {}}, kScaleParams).has_value());
}

TEST(GuessScale, ABarTellsItExactlyOnceDoorsTellWhichLengthItIs) {
  auto random = random_stream(11, 0);
  for (const double truth : {0.008, 0.02, 0.045}) {
    for (const double division_m : {1.0, 2.0, 5.0}) {
      const auto scale = guess_scale({seen_doors(random, 9, truth), division_m / truth, {}}, kScaleParams);
      ASSERT_TRUE(scale.has_value());
      EXPECT_NEAR(scale->metres_per_pixel / truth, 1, 0.02) << division_m;
    }
  }
}

TEST(GuessScale, ABarMakesItSurerThanDoorsAlone) {
  const std::vector<double> doors{44, 45, 46, 47};
  const auto alone = guess_scale({doors, {}, {}}, kScaleParams);
  const auto with_bar = guess_scale({doors, 5 / 0.02, {}}, kScaleParams);
  ASSERT_TRUE(alone && with_bar);
  EXPECT_LT(with_bar->relative_sigma, alone->relative_sigma);
}

TEST(GuessScale, ABarThatFitsNoDoorDoesNotMakeItSure) {
  // Halfway between one metre and two: either reading is as good.
  const double scale_of_doors = 0.9 / 45;
  const auto scale = guess_scale({{45, 45, 45}, std::sqrt(2.0) / scale_of_doors, {}}, kScaleParams);
  ASSERT_TRUE(scale.has_value());
  EXPECT_GT(scale->relative_sigma, 0.2);
}

TEST(GuessScale, IsWithinItsOwnSigmaAsOftenAsItSays) {
  auto random = random_stream(3, 1);
  int within = 0;
  const int trials = 200;
  for (int i = 0; i < trials; ++i) {
    const double truth = std::exp(uniform(random, std::log(0.005), std::log(0.08)));
    const double factor = std::exp(normal(random, 0.15));  // a building with unusual doors
    auto doors = seen_doors(random, 12, truth);
    for (double& d : doors) d *= factor;
    const auto scale =
        guess_scale({doors, uniform(random, 0, 1) < 0.5 ? std::optional(2 / truth) : std::nullopt, {}}, kScaleParams);
    ASSERT_TRUE(scale.has_value());
    within += std::abs(std::log(scale->metres_per_pixel / truth)) < 2 * scale->relative_sigma;
  }
  EXPECT_GT(within, 0.9 * trials);
}

TEST(GuessScale, PaperAloneIsLittleAndSaysSo) {
  const auto scale = guess_scale({{}, {}, 3400}, kScaleParams);
  if (scale) {
    EXPECT_GT(scale->relative_sigma, 0.35);
  }
  const auto with_doors = guess_scale({{45, 45, 45}, {}, 3400}, kScaleParams);
  ASSERT_TRUE(with_doors.has_value());
  EXPECT_NEAR(with_doors->metres_per_pixel, 0.02, 0.008);
}

TEST(ASeries, IsToldByTheRatioOfTheSides) {
  EXPECT_EQ(a_series_side({1414, 1000}), 1414);
  EXPECT_EQ(a_series_side({1000, 1414}), 1414);
  EXPECT_FALSE(a_series_side({1600, 1000}).has_value());
  EXPECT_FALSE(a_series_side({0, 0}).has_value());
}

/// Boxes filled in turns inside an outline.
void draw_boxes(cv::Mat& ink, const cv::Point& at, int division, int count, int height) {
  cv::rectangle(ink, cv::Rect(at.x, at.y, division * count, height), cv::Scalar(255), 1);
  for (int i = 0; i < count; i += 2)
    cv::rectangle(ink, cv::Rect(at.x + i * division, at.y, division, height), cv::Scalar(255), cv::FILLED);
}

TEST(ScaleBar, OfBoxesFilledInTurns) {
  cv::Mat ink = cv::Mat::zeros(1000, 1400, CV_8UC1);
  draw_boxes(ink, {200, 900}, 60, 5, 10);
  const auto division = find_scale_bar(ink);
  ASSERT_TRUE(division.has_value());
  EXPECT_NEAR(*division, 60, 2);
}

TEST(ScaleBar, OfTicksOnALine) {
  cv::Mat ink = cv::Mat::zeros(1000, 1400, CV_8UC1);
  cv::line(ink, {300, 905}, {620, 905}, cv::Scalar(255), 2);
  for (int i = 0; i <= 4; ++i) cv::line(ink, {300 + 80 * i, 894}, {300 + 80 * i, 905}, cv::Scalar(255), 2);
  const auto division = find_scale_bar(ink);
  ASSERT_TRUE(division.has_value());
  EXPECT_NEAR(*division, 80, 2);
}

TEST(ScaleBar, IsFoundUpright) {
  cv::Mat ink = cv::Mat::zeros(1000, 1400, CV_8UC1);
  draw_boxes(ink, {200, 900}, 60, 5, 10);
  cv::Mat turned;
  cv::rotate(ink, turned, cv::ROTATE_90_CLOCKWISE);
  const auto division = find_scale_bar(turned);
  ASSERT_TRUE(division.has_value());
  EXPECT_NEAR(*division, 60, 2);
}

TEST(ScaleBar, IsNoWallNoWordAndNoUnevenRow) {
  cv::Mat ink = cv::Mat::zeros(1000, 1400, CV_8UC1);
  cv::rectangle(ink, cv::Rect(100, 100, 400, 12), cv::Scalar(255), cv::FILLED);               // a wall
  cv::putText(ink, "IIIIIIII", {700, 300}, cv::FONT_HERSHEY_SIMPLEX, 1, cv::Scalar(255), 2);  // letters stand apart
  cv::line(ink, {300, 905}, {620, 905}, cv::Scalar(255), 2);
  for (const int x : {300, 340, 470, 500, 618}) cv::line(ink, {x, 894}, {x, 905}, cv::Scalar(255), 2);
  EXPECT_FALSE(find_scale_bar(ink).has_value());
  EXPECT_FALSE(find_scale_bar(cv::Mat::zeros(40, 50, CV_8UC1)).has_value());
}

}  // namespace
}  // namespace smokemap
