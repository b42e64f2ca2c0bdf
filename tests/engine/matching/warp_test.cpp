#include "matching/warp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

MapRaster fine_raster(const cv::Mat& rooms) { return make_raster(*segmentation_from_labels(rooms), 72, 4); }

/// Two rooms in a row whose shared wall stands at `wall_x`.
cv::Mat two_rooms(int wall_x) {
  cv::Mat rooms(140, 300, CV_16UC1, cv::Scalar(0));
  rooms(cv::Rect(20, 20, wall_x - 20, 100)).setTo(1);
  rooms(cv::Rect(wall_x + 12, 20, 268 - wall_x, 100)).setTo(2);
  return rooms;
}

MapAlignment unmoved() { return {Eigen::Affine2d::Identity(), 1}; }

Point2 carried(const Warp& warp, const MapRaster& a, const MapRaster& b, const Point2& p_a_px) {
  const Point2 at = a.to_cells(p_a_px);
  const auto to =
      warp.cells_b.at<cv::Vec2f>(static_cast<int>(std::lround(at.y())), static_cast<int>(std::lround(at.x())));
  return b.to_px(Point2(to[0], to[1]));
}

TEST(BendingPair, LeavesEqualMapsAlone) {
  std::mt19937_64 random(1);
  const MapRaster raster = fine_raster(test::office_plan(random).rooms);
  const Warp warp = BendingPair(raster, raster).bend(unmoved(), {});
  EXPECT_NEAR(warp.likeness, 1, 1e-3);
  EXPECT_NEAR(warp.bending, 0, 1e-3);
  EXPECT_NEAR(warp.scale, 1, 1e-9);
}

TEST(BendingPair, MovesAWallThatStandsElsewhereTowardsWhereItIs) {
  const MapRaster a = fine_raster(two_rooms(150)), b = fine_raster(two_rooms(175));
  const Warp warp = BendingPair(a, b).bend(unmoved(), {});
  const double wall_x = carried(warp, a, b, {156, 70}).x();  // 156 on a, 181 on b
  EXPECT_GT(wall_x, 164);
  EXPECT_LT(wall_x, 183);
  EXPECT_NEAR(carried(warp, a, b, {22, 70}).x(), 22, 6);  // the outer wall stays
  const double before = a.depth.dot(b.depth) / std::sqrt(a.depth.dot(a.depth) * b.depth.dot(b.depth));
  EXPECT_GT(warp.likeness, before);
  EXPECT_GT(warp.bending, 0);
}

TEST(BendingPair, BringsPinsToTheirPlaces) {
  const MapRaster a = fine_raster(two_rooms(150)), b = fine_raster(two_rooms(150));
  const std::vector<Pin> pins = {{Point2(70, 70), Point2(100, 60)}, {Point2(220, 80), Point2(210, 95)}};
  const Warp warp = BendingPair(a, b).bend(unmoved(), pins);
  for (const Pin& pin : pins) EXPECT_LT((carried(warp, a, b, pin.p_a_px) - pin.p_b_px).norm(), 2 * b.px_per_cell);
}

TEST(BendingPair, BendsAsLittleOnAnyScale) {
  const cv::Mat rooms = two_rooms(150);
  cv::Mat large;
  cv::resize(two_rooms(175), large, cv::Size(), 3, 3, cv::INTER_NEAREST);
  MapAlignment three = unmoved();
  three.T_b_a_px.linear() *= 3;
  const Warp same = BendingPair(fine_raster(rooms), fine_raster(two_rooms(175))).bend(unmoved(), {});
  const Warp scaled = BendingPair(fine_raster(rooms), fine_raster(large)).bend(three, {});
  EXPECT_NEAR(scaled.score, same.score, 0.02);
  EXPECT_NEAR(scaled.bending, same.bending, 0.02);
}

TEST(MapRaster, TakesPixelsToCellsAndBack) {
  const MapRaster raster = fine_raster(two_rooms(150));
  for (const Point2& p : {Point2(0, 0), Point2(37.5, 99), Point2(-4, 260)})
    EXPECT_LT((raster.to_px(raster.to_cells(p)) - p).norm(), 1e-9);
  EXPECT_LT((pixels_of_cells(raster) * Point2(3, 4) - raster.to_px(Point2(3, 4))).norm(), 1e-9);
}

TEST(MapRaster, KnowsTheDirectionOfWallsUpToQuarterTurns) {
  for (const double angle_deg : {0.0, 12.0, 30.0, 75.0}) {
    cv::Mat turned(500, 500, CV_16UC1, cv::Scalar(0)), motion = cv::getRotationMatrix2D({150, 70}, angle_deg, 1);
    motion.at<double>(0, 2) += 100, motion.at<double>(1, 2) += 180;
    cv::warpAffine(two_rooms(150), turned, motion, turned.size(), cv::INTER_NEAREST);
    const double wanted = std::fmod(CV_PI - angle_deg * CV_PI / 180, CV_PI / 2);  // pictures turn the other way
    const double miss = std::abs(fine_raster(turned).wall_direction_rad - wanted);
    EXPECT_LT(std::min(miss, CV_PI / 2 - miss), 0.06) << angle_deg;
  }
}

TEST(MapRaster, HalvedLiesWhereItLay) {
  const MapRaster fine = fine_raster(two_rooms(150)), half = halved(fine);
  EXPECT_EQ(half.depth.cols, (fine.depth.cols + 1) / 2);
  EXPECT_NEAR(cv::mean(half.depth)[0] * static_cast<double>(half.depth.total()) * 4, cv::sum(fine.depth)[0], 1e-2);
  EXPECT_LT((half.to_px(Point2(5, 7)) - fine.to_px(Point2(10.5, 14.5))).norm(), 1e-9);
}

}  // namespace
}  // namespace smokemap
