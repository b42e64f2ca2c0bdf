#include "grids/paper_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;

TEST(AsBgr, SpreadsGrayCutsSixteenBitsAndLaysTransparencyOnWhite) {
  const auto gray = as_bgr(cv::Mat(2, 3, CV_8UC1, cv::Scalar(77)));
  ASSERT_TRUE(gray);
  EXPECT_EQ(gray->type(), CV_8UC3);
  EXPECT_EQ(gray->at<cv::Vec3b>(1, 2), cv::Vec3b(77, 77, 77));
  const auto wide = as_bgr(cv::Mat(1, 1, CV_16UC3, cv::Scalar(0, 257 * 40, 65535)));
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->at<cv::Vec3b>(0, 0), cv::Vec3b(0, 40, 255));
  const auto half = as_bgr(cv::Mat(1, 1, CV_8UC4, cv::Scalar(0, 100, 255, 51)));  // a fifth opaque
  ASSERT_TRUE(half);
  EXPECT_EQ(half->at<cv::Vec3b>(0, 0), cv::Vec3b(204, 224, 255));
  const auto nothing = as_bgr(cv::Mat(1, 1, CV_8UC4, cv::Scalar(9, 9, 9, 0)));
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));
}

TEST(AsBgr, RefusesWhatIsNoPicture) {
  EXPECT_THAT(as_bgr(cv::Mat()), Fails(Errc::kInvalidArgument));
  EXPECT_THAT(as_bgr(cv::Mat(2, 2, CV_32FC1)), Fails(Errc::kInvalidArgument));
  EXPECT_THAT(as_bgr(cv::Mat(2, 2, CV_8UC2)), Fails(Errc::kInvalidArgument));
}

TEST(AtWorkSize, ScalesBothSidesAlikeAndEnlargesAtMostTwice) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 30; ++i) {
    const cv::Mat picture(20 + static_cast<int>(uniform_index(random, 600)),
                          20 + static_cast<int>(uniform_index(random, 600)), CV_8UC3, cv::Scalar(1, 2, 3));
    const WorkPicture work = at_work_size(picture, 200, 400);
    const int side = std::max(picture.rows, picture.cols), now = std::max(work.bgr.rows, work.bgr.cols);
    EXPECT_NEAR(now, work.scale * side, 0.51);
    EXPECT_NEAR(work.bgr.rows, work.scale * picture.rows, 0.51);
    EXPECT_LE(work.scale, 2.0);
    EXPECT_LE(now, 400);
    if (side >= 100) {
      EXPECT_GE(now, std::min(side, 200));
    }
    if (side >= 200 && side <= 400) {
      EXPECT_EQ(work.scale, 1.0);
      EXPECT_EQ(work.bgr.data, picture.data) << "nothing to do, nothing copied";
    }
    EXPECT_EQ(work.bgr.at<cv::Vec3b>(0, 0), cv::Vec3b(1, 2, 3));
  }
}

/// Paper with a black line, lit from the left: half as bright on the right.
cv::Mat lit_sheet() {
  cv::Mat sheet(240, 320, CV_8UC3);
  for (int y = 0; y < sheet.rows; ++y)
    for (int x = 0; x < sheet.cols; ++x) {
      const double light = 240 - 120.0 * x / sheet.cols;
      const bool line = y >= 118 && y < 122;
      sheet.at<cv::Vec3b>(y, x) =
          line ? cv::Vec3b(10, 10, 10) : cv::Vec3b::all(static_cast<std::uint8_t>(std::lround(light)));
    }
  return sheet;
}

TEST(DivideLight, LeavesPaperWhiteAndInkBlackWhereverTheLampStands) {
  const PaperView view = divide_light(lit_sheet(), 0.05);
  for (int x = 10; x < 310; x += 5) {
    EXPECT_LT(view.darkness.at<std::uint8_t>(60, x), 20) << x;
    EXPECT_LT(view.darkness.at<std::uint8_t>(200, x), 20) << x;
    EXPECT_GT(view.darkness.at<std::uint8_t>(120, x), 200) << x;
    EXPECT_EQ(view.chroma.at<std::uint8_t>(120, x), 0) << x;
  }
}

TEST(DivideLight, ShowsColourAsChromaAndLessDark) {
  cv::Mat sheet(160, 160, CV_8UC3, cv::Scalar(230, 230, 230));
  sheet(cv::Rect(60, 60, 20, 20)).setTo(cv::Scalar(30, 30, 220));  // red ink
  const PaperView view = divide_light(sheet, 0.3);
  EXPECT_GT(view.chroma.at<std::uint8_t>(70, 70), 150);
  EXPECT_LT(view.darkness.at<std::uint8_t>(70, 70), 40);
  EXPECT_LT(view.chroma.at<std::uint8_t>(20, 20), 10);
}

TEST(InkThreshold, PartsTwoHeapsOfDarknessHoweverMuchPaperThereIs) {
  std::mt19937_64 random(2);
  cv::Mat darkness(100, 100, CV_8UC1);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const double mean = y < 90 ? 5 : y < 95 ? 90 : 210;  // paper, pencil, ink
      darkness.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::clamp(mean + normal(random, 6), 0.0, 255.0));
    }
  const int threshold = ink_threshold(darkness, 0.0, 1.0);
  EXPECT_GT(threshold, 105);
  EXPECT_LT(threshold, 195);
  EXPECT_EQ(ink_threshold(darkness, 0.9, 0.95), static_cast<int>(0.9 * 255)) << "held between its limits";
  EXPECT_EQ(ink_threshold(darkness, 0.1, 0.2), static_cast<int>(0.2 * 255));
}

TEST(InkThreshold, AnEmptySheetGetsTheMiddle) {
  EXPECT_EQ(ink_threshold(cv::Mat(20, 20, CV_8UC1, cv::Scalar(0)), 0.2, 0.9), 128);
}

}  // namespace
}  // namespace smokemap
