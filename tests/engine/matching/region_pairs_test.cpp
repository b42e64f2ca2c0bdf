#include "matching/region_pairs.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

struct LaidMaps {
  Segmentation a, b;
  MapRaster raster_a, raster_b;
  Warp warp;

  /// b over a, pixel by pixel, no bending but where walls ask for it.
  LaidMaps(const cv::Mat& rooms_a, const cv::Mat& rooms_b)
      : a(*segmentation_from_labels(rooms_a)),
        b(*segmentation_from_labels(rooms_b)),
        raster_a(make_raster(a, 72, 4)),
        raster_b(make_raster(b, 72, 4)),
        warp(BendingPair(raster_a, raster_b).bend({Eigen::Affine2d::Identity(), 1}, {})) {}

  PairScores scores() const { return score_pairs(a, b, raster_a, raster_b, warp); }
};

cv::Mat plan_rooms(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return test::office_plan(random).rooms;
}

/// A room of 150 beside one of 70, and the same with the large one in halves.
cv::Mat whole_and_other() {
  cv::Mat rooms(120, 260, CV_16UC1, cv::Scalar(0));
  rooms(cv::Rect(10, 10, 150, 90)).setTo(1);
  rooms(cv::Rect(166, 20, 70, 50)).setTo(2);
  return rooms;
}
cv::Mat halves_and_other() {
  cv::Mat rooms = whole_and_other();
  rooms(cv::Rect(85, 10, 75, 90)).setTo(3);
  return rooms;
}

TEST(PairScores, AreBestForARoomAndItself) {
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const cv::Mat rooms = plan_rooms(seed);
    const PairScores scores = LaidMaps(rooms, rooms).scores();
    for (Eigen::Index i = 0; i < scores.likeness.rows(); ++i) {
      EXPECT_GT(scores.likeness(i, i), 0.9);
      EXPECT_GT(scores.share_of_a(i, i), 0.9);
      EXPECT_GT(scores.share_of_b(i, i), 0.9);
      for (Eigen::Index j = 0; j < scores.likeness.cols(); ++j)
        if (j != i) {
          EXPECT_LT(scores.likeness(i, j), scores.likeness(i, i));
        }
    }
  }
}

TEST(PairScores, AreSharesBetweenZeroAndOneThatSumToNoMoreThanTheRoom) {
  const PairScores scores = LaidMaps(plan_rooms(5), plan_rooms(6)).scores();
  for (const Eigen::MatrixXd* part : {&scores.likeness, &scores.share_of_a, &scores.share_of_b}) {
    EXPECT_GE(part->minCoeff(), 0);
    EXPECT_LE(part->maxCoeff(), 1);
  }
  EXPECT_LE(scores.share_of_a.rowwise().sum().maxCoeff(), 1 + 1e-9);
}

TEST(PairScores, SayHowMuchOfAHalfLiesInTheWhole) {
  const PairScores scores = LaidMaps(halves_and_other(), whole_and_other()).scores();
  const LaidMaps maps(halves_and_other(), whole_and_other());
  const auto label = [](const Segmentation& map, int x) { return map.labels.at<unsigned short>(40, x) - 1; };
  const int whole = label(maps.b, 40);
  for (const int x : {40, 130}) {
    EXPECT_GT(scores.share_of_a(label(maps.a, x), whole), 0.85);
    EXPECT_NEAR(scores.share_of_b(label(maps.a, x), whole), 0.5, 0.1);
  }
  EXPECT_LT(scores.share_of_a(label(maps.a, 200), whole), 0.1);
}

TEST(PairScores, LookUpARoomTooSmallForTheRasterAtItsMiddle) {
  cv::Mat rooms = whole_and_other();
  rooms(cv::Rect(200, 100, 2, 2)).setTo(7);
  const PairScores scores = LaidMaps(rooms, rooms).scores();
  EXPECT_EQ(scores.likeness.rows(), 3);
  EXPECT_TRUE(scores.likeness.allFinite());
}

TEST(JoinedPairs, TakeInARegionOfBThatNobodyHasAndThatLiesUnderOneOfA) {
  const LaidMaps maps(whole_and_other(), halves_and_other());
  const PairScores scores = maps.scores();
  const auto label = [](const Segmentation& map, int x) { return map.labels.at<unsigned short>(40, x) - 1; };
  std::vector<int> partner(2, -1);
  partner[static_cast<size_t>(label(maps.a, 40))] = label(maps.b, 40);
  partner[static_cast<size_t>(label(maps.a, 200))] = label(maps.b, 200);
  Eigen::MatrixXi forbidden = Eigen::MatrixXi::Zero(2, 3);
  const auto joined = joined_pairs(partner, scores, forbidden);
  ASSERT_EQ(joined.size(), 3u);
  for (const RegionPair& pair : joined)
    if (pair.label_b - 1 == label(maps.b, 130)) {
      EXPECT_EQ(pair.label_a - 1, label(maps.a, 40));
      EXPECT_LT(pair.confidence, 1);  // less sure than a partner
    }
  forbidden(label(maps.a, 40), label(maps.b, 130)) = 1;
  EXPECT_EQ(joined_pairs(partner, scores, forbidden).size(), 2u);
  partner.assign(2, -1);  // who has no partner takes nothing in
  EXPECT_TRUE(joined_pairs(partner, scores, Eigen::MatrixXi::Zero(2, 3)).empty());
}

}  // namespace
}  // namespace smokemap
