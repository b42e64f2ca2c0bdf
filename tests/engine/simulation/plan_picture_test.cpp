#include "simulation/plan_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

DistortedPlan wrong_plan(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  auto building = random_building({}, random);
  EXPECT_TRUE(building.ok());
  PlanDistortionParams params;
  params.missing_walls = params.phantom_walls = 1;
  auto plan = distort(*building, params, random);
  EXPECT_TRUE(plan.ok());
  return *plan;
}

int darkness_at(const cv::Mat& gray, const Point2& p_px) {
  return 255 -
         gray.at<uchar>(cv::Point(static_cast<int>(std::lround(p_px.x())), static_cast<int>(std::lround(p_px.y()))));
}

TEST(PlanPicture, IsDarkOnWallsAndLightInRoomsAndDoors) {
  const DistortedPlan plan = wrong_plan(1);
  std::mt19937_64 random(2);
  PlanPictureParams params;
  params.windows = params.route = params.signs = params.room_names = params.doors = false;
  const auto picture = draw_plan(plan.drawn, params, random);
  ASSERT_THAT(picture, test::IsOk());
  cv::Mat gray;
  cv::cvtColor(picture->sheet, gray, cv::COLOR_BGR2GRAY);
  const TrueLayout truth = true_layout(plan, *picture);
  for (std::size_t i = 0; i < truth.layout.walls.size(); ++i) {
    const Segment2 line = truth.layout.wall_px(static_cast<int>(i));
    if (line.length() < 6) continue;
    for (const double share : {0.1, 0.37, 0.5, 0.8})
      EXPECT_GT(darkness_at(gray, line.a + share * (line.b - line.a)), 150) << "wall " << i;
  }
  for (const LayoutOpening& opening : truth.layout.openings) {
    if (opening.kind == OpeningKind::kDoor) {
      EXPECT_LT(darkness_at(gray, opening.gap_px.midpoint()), 30);
    }
  }
  for (const Polygon& room : truth.layout.rooms_px) EXPECT_LT(darkness_at(gray, centroid(room)), 30);
}

TEST(PlanPicture, DrawsWallsWhereTruthSays) {
  FloorPlan square = one_room_building();
  std::mt19937_64 random(3);
  PlanPictureParams params;
  params.sheet = params.windows = params.signs = params.route = params.room_names = false;
  const auto picture = draw_plan(square, params, random);
  ASSERT_THAT(picture, test::IsOk());
  cv::Mat gray;
  cv::cvtColor(picture->sheet, gray, cv::COLOR_BGR2GRAY);
  const Point2 wall = picture->to_pixels({0, 2});  // the left wall; weigh the ink across it
  const int row = static_cast<int>(std::lround(wall.y()));
  double ink = 0, moment = 0;
  for (int x = static_cast<int>(wall.x()) - 60; x < static_cast<int>(wall.x()) + 60; ++x) {
    const double dark = 255 - gray.at<uchar>(row, x);
    ink += dark;
    moment += dark * x;
  }
  EXPECT_NEAR(moment / ink, wall.x(), 0.15);
  EXPECT_NEAR(ink / 230, 0.30 / picture->metres_per_pixel, 1.0) << "thickness";
}

TEST(PlanPicture, HasTwoLineWidthsAndColouredSigns) {
  const DistortedPlan plan = wrong_plan(4);
  std::mt19937_64 random(5);
  PlanPictureParams params;
  params.you_are_here = plan.warp(Point2(5, 5));
  const auto picture = draw_plan(plan.drawn, params, random);
  ASSERT_THAT(picture, test::IsOk());
  EXPECT_GE(picture->signs.size(), 5u);
  for (const LayoutSign& sign : picture->signs) {
    const cv::Vec3b edge = picture->sheet.at<cv::Vec3b>(
        cv::Point(static_cast<int>(sign.p_px.x() - 0.85 * sign.radius_px), static_cast<int>(sign.p_px.y())));
    const int strongest = edge[2] > edge[1] && edge[2] > edge[0] ? 2 : edge[1] > edge[0] ? 1 : 0;
    EXPECT_EQ(strongest, sign.colour == "red" ? 2 : sign.colour == "green" ? 1 : 0) << sign.colour;
  }
  ASSERT_TRUE(picture->you_are_here_px);
  EXPECT_THAT(picture->to_plan(*picture->you_are_here_px), test::IsNearPoint(*params.you_are_here, 1e-9));
}

TEST(PlanPicture, LeadsEveryPhotographedPixelBackToTheSheet) {
  const DistortedPlan plan = wrong_plan(6);
  std::mt19937_64 random(7);
  PlanPictureParams params;
  params.photo = true;
  params.width_px = 800;
  const auto picture = draw_plan(plan.drawn, params, random);
  ASSERT_THAT(picture, test::IsOk());
  const cv::Mat H(3, 3, CV_64F, const_cast<double*>(picture->homography.H_layout_photo.data()));
  cv::Mat flat;
  cv::warpPerspective(picture->photo, flat, H, picture->sheet.size());
  cv::Mat one, other;
  cv::cvtColor(flat, one, cv::COLOR_BGR2GRAY);
  cv::cvtColor(picture->sheet, other, cv::COLOR_BGR2GRAY);
  one.convertTo(one, CV_64F);
  other.convertTo(other, CV_64F);
  cv::Scalar mean_one, mean_other, sd_one, sd_other;
  cv::meanStdDev(one, mean_one, sd_one);
  cv::meanStdDev(other, mean_other, sd_other);
  const double correlation = cv::mean((one - mean_one[0]).mul(other - mean_other[0]))[0] / (sd_one[0] * sd_other[0]);
  EXPECT_GT(correlation, 0.75);
}

TEST(PlanPicture, GivesAPerfectReadersLayout) {
  const DistortedPlan plan = wrong_plan(8);
  std::mt19937_64 random(9);
  const auto picture = draw_plan(plan.drawn, {}, random);
  ASSERT_THAT(picture, test::IsOk());
  const TrueLayout truth = true_layout(plan, *picture);
  ASSERT_EQ(truth.corner_world.size(), truth.layout.corners.size());
  ASSERT_EQ(truth.wall_source.size(), truth.layout.walls.size());
  EXPECT_EQ(truth.layout.walls.size(), plan.drawn.walls.size() + plan.drawn.doors.size())
      << "a door cuts a wall in two";
  EXPECT_EQ(truth.layout.width_px, picture->sheet.cols);
  for (const LayoutWall& wall : truth.layout.walls) {
    EXPECT_NE(wall.corner_a, wall.corner_b);
    EXPECT_GT(wall.thickness_px, 0);
  }
  // Layout metres are plan metres up to a shift, so distances agree.
  const Segment2 wall = truth.layout.wall_m(0);
  const Segment2 drawn = plan.drawn.wall_line(0);
  EXPECT_LE(wall.length(), drawn.length() + 1e-9);
}

TEST(PlanPicture, IsTheSameForASeed) {
  const DistortedPlan plan = wrong_plan(10);
  PlanPictureParams params;
  params.photo = true;
  params.width_px = 500;
  std::mt19937_64 one(11), other(11);
  const auto a = draw_plan(plan.drawn, params, one), b = draw_plan(plan.drawn, params, other);
  EXPECT_EQ(cv::norm(a->sheet, b->sheet, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(a->photo, b->photo, cv::NORM_INF), 0);
}

TEST(PlanPicture, RefusesWhatCannotBeDrawn) {
  std::mt19937_64 random(1);
  EXPECT_THAT(draw_plan(FloorPlan{}, {}, random), test::Fails(Errc::kDegenerate));
  PlanPictureParams params;
  params.width_px = 10;
  EXPECT_THAT(draw_plan(one_room_building(), params, random), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
