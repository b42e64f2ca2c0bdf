#include "layout/sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "layout/read_layout.hpp"
#include "tests/engine/layout/drawn_plan.hpp"

namespace smokemap {
namespace {

const SheetCorners kCorners{Point2(150, 90), Point2(1320, 160), Point2(1260, 980), Point2(210, 900)};

/// The office sheet as it hangs on a dark wall, seen from the side.
cv::Mat photograph(const testing::DrawnPlan& plan) {
  const auto w = static_cast<float>(plan.picture.cols - 1), h = static_cast<float>(plan.picture.rows - 1);
  const cv::Point2f from[4] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  cv::Point2f to[4];
  for (std::size_t i = 0; i < 4; ++i)
    to[i] = {static_cast<float>(kCorners[i].x()), static_cast<float>(kCorners[i].y())};
  cv::Mat photo(1080, 1440, CV_8UC3, cv::Scalar(70, 80, 90));
  cv::warpPerspective(plan.picture, photo, cv::getPerspectiveTransform(from, to), photo.size(), cv::INTER_AREA,
                      cv::BORDER_TRANSPARENT);
  return photo;
}

TEST(Sheet, IsProposedWhereItHangs) {
  const auto proposal = propose_sheet(photograph(testing::draw_office()));
  EXPECT_GT(proposal.confidence, 0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((proposal.corners_px[i] - kCorners[i]).norm(), 4) << i;
}

double worst_corner(const SheetProposal& proposal) {
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, (proposal.corners_px[i] - kCorners[i]).norm());
  return worst / (kCorners[1] - kCorners[0]).norm();
}

// Regression: a coloured band along the top was left outside the sheet.
TEST(Sheet, HasItsHeaderInside) {
  auto plan = testing::draw_office();
  cv::rectangle(plan.picture, {0, 0, plan.picture.cols, 80}, cv::Scalar(80, 132, 0), cv::FILLED);
  EXPECT_LT(worst_corner(propose_sheet(photograph(plan))), 0.005);
}

TEST(Sheet, EndsWherePaperMeetsThePictureFrame) {
  const auto plan = testing::draw_office();
  cv::Mat framed;
  cv::copyMakeBorder(plan.picture, framed, 40, 40, 40, 40, cv::BORDER_CONSTANT, cv::Scalar(60, 65, 70));
  const auto w = static_cast<float>(plan.picture.cols - 1), h = static_cast<float>(plan.picture.rows - 1);
  const cv::Point2f from[4] = {{40, 40}, {40 + w, 40}, {40 + w, 40 + h}, {40, 40 + h}};
  cv::Point2f to[4];
  for (std::size_t i = 0; i < 4; ++i)
    to[i] = {static_cast<float>(kCorners[i].x()), static_cast<float>(kCorners[i].y())};
  cv::Mat photo(1080, 1440, CV_8UC3, cv::Scalar(150, 170, 190));
  cv::warpPerspective(framed, photo, cv::getPerspectiveTransform(from, to), photo.size(), cv::INTER_AREA,
                      cv::BORDER_TRANSPARENT);
  EXPECT_LT(worst_corner(propose_sheet(photo)), 0.005);
}

// Regression: the outline of the plan itself, or a tinted hall, was taken for the sheet.
TEST(Sheet, IsNotWhatIsPrintedOnIt) {
  auto plan = testing::draw_office();
  cv::rectangle(plan.picture, cv::Point(206, 206), cv::Point(1394, 794), cv::Scalar(205, 235, 205), cv::FILLED);
  EXPECT_EQ(propose_sheet(plan.picture).confidence, 0);
  EXPECT_EQ(propose_sheet(testing::draw_office().picture).confidence, 0);
}

TEST(Sheet, IsTheWholePictureWhenNothingStandsOut) {
  const cv::Mat white(300, 400, CV_8UC3, cv::Scalar(255, 255, 255));
  const auto proposal = propose_sheet(white);
  EXPECT_EQ(proposal.confidence, 0);
  EXPECT_EQ(proposal.corners_px[2], Point2(399, 299));
}

bool warns_of_corners(const LayoutReading& reading) {
  return std::any_of(reading.layout.warnings.begin(), reading.layout.warnings.end(),
                     [](const std::string& w) { return w.find("four corners") != std::string::npos; });
}

TEST(Sheet, WhoseRimIsHardlySeenIsSaidToBeUnsure) {
  const auto plan = testing::draw_office();
  const auto clear = read_layout(photograph(plan));
  ASSERT_TRUE(clear.ok());
  EXPECT_GT(clear->sheet_confidence, 0.9);
  EXPECT_FALSE(warns_of_corners(*clear));
  cv::Mat faint = photograph(plan);
  cv::Mat wall;
  cv::inRange(faint, cv::Scalar(70, 80, 90), cv::Scalar(70, 80, 90), wall);
  faint.setTo(cv::Scalar(240, 241, 242), wall);  // as white as the paper
  const auto unsure = read_layout(faint);
  ASSERT_TRUE(unsure.ok());
  EXPECT_LT(unsure->sheet_confidence, 0.7);
  EXPECT_EQ(warns_of_corners(*unsure), unsure->sheet_confidence > 0);
}

TEST(Sheet, RectifiesWhatWasTilted) {
  const auto plan = testing::draw_office();
  LayoutOptions options;
  options.sheet_corners_px = kCorners;
  const auto reading = read_layout(photograph(plan), options);
  ASSERT_TRUE(reading.ok());
  // truth in rectified pixels: the sheet scaled to the rectified size
  const double sx = (reading->rectified.cols - 1.0) / (plan.picture.cols - 1),
               sy = (reading->rectified.rows - 1.0) / (plan.picture.rows - 1);
  std::vector<Segment2> truth;
  for (const auto& w : plan.walls)
    truth.push_back({Point2(w.a.x() * sx, w.a.y() * sy), Point2(w.b.x() * sx, w.b.y() * sy)});
  EXPECT_GT(testing::covered_by(truth, testing::wall_segments(reading->layout), 6), 0.93);
  EXPECT_EQ(reading->layout.width_px, reading->rectified.cols);
}

TEST(Sheet, HomographyCarriesTheCornersToTheCorners) {
  const auto sheet = rectify_sheet(photograph(testing::draw_office()), kCorners, 40);
  ASSERT_TRUE(sheet.ok());
  const auto& H = sheet->homography.H_layout_photo;
  const Point2 p = kCorners[2];
  const double z = H[6] * p.x() + H[7] * p.y() + H[8];
  EXPECT_NEAR((H[0] * p.x() + H[1] * p.y() + H[2]) / z, sheet->bgr.cols - 1, 1e-6);
  EXPECT_NEAR((H[3] * p.x() + H[4] * p.y() + H[5]) / z, sheet->bgr.rows - 1, 1e-6);
}

TEST(Sheet, RefusesCornersThatMakeNoSheet) {
  const cv::Mat picture(300, 400, CV_8UC3, cv::Scalar(255, 255, 255));
  const SheetCorners crossed{Point2(0, 0), Point2(300, 200), Point2(300, 0), Point2(0, 200)};
  const SheetCorners anticlockwise{Point2(0, 0), Point2(0, 200), Point2(300, 200), Point2(300, 0)};
  const SheetCorners tiny{Point2(0, 0), Point2(8, 0), Point2(8, 8), Point2(0, 8)};
  const SheetCorners nan{Point2(0, NAN), Point2(300, 0), Point2(300, 200), Point2(0, 200)};
  for (const auto& corners : {crossed, anticlockwise, tiny, nan})
    EXPECT_EQ(rectify_sheet(picture, corners, 40).error().code, Errc::kInvalidArgument);
}

TEST(Sheet, WithoutCornersTheLayoutStaysInPixelsOfThePicture) {
  const cv::Mat photo = photograph(testing::draw_office());
  const auto reading = read_layout(photo);
  ASSERT_TRUE(reading.ok());
  EXPECT_EQ(reading->layout.width_px, photo.cols);
  EXPECT_EQ(reading->homography.H_layout_photo, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace smokemap
