#include "matching/align.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>

#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

MapRaster raster_of(const cv::Mat& rooms) { return make_raster(*segmentation_from_labels(rooms), 44, 3); }

cv::Mat office_rooms(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return test::office_plan(random).rooms;
}

/// Farthest that the corners of the picture are from where they should be, in pixels of b.
double worst_corner(const Eigen::Affine2d& found, const Eigen::Affine2d& truth, const cv::Size& size) {
  double worst = 0;
  for (const Point2& p : {Point2(0, 0), Point2(size.width, 0), Point2(0, size.height), Point2(size.width, size.height)})
    worst = std::max(worst, (found * p - truth * p).norm());
  return worst;
}

TEST(AlignmentSearch, LaysAMapOverItself) {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const cv::Mat rooms = office_rooms(seed);
    const MapRaster raster = raster_of(rooms);
    const MapAlignment best = AlignmentSearch(raster, raster, Facing::kAsDrawn).best({}, 1).front();
    EXPECT_LT(worst_corner(best.T_b_a_px, Eigen::Affine2d::Identity(), rooms.size()), 2 * raster.px_per_cell);
    EXPECT_GT(best.score, 0.98);
  }
}

TEST(AlignmentSearch, FindsQuarterTurnsAndScale) {
  const cv::Mat rooms = office_rooms(4);
  cv::Mat turned;
  cv::rotate(rooms, turned, cv::ROTATE_90_CLOCKWISE);
  cv::resize(turned, turned, cv::Size(), 1.7, 1.7, cv::INTER_NEAREST);
  Eigen::Affine2d truth = Eigen::Affine2d::Identity();  // p -> 1.7 * (rows - 1 - y, x)
  truth.linear() << 0, -1.7, 1.7, 0;
  truth.translation() = Point2(1.7 * (rooms.rows - 1), 0);
  const MapAlignment best = AlignmentSearch(raster_of(rooms), raster_of(turned), Facing::kAsDrawn).best({}, 1).front();
  EXPECT_LT(worst_corner(best.T_b_a_px, truth, rooms.size()), 3 * raster_of(turned).px_per_cell);
}

TEST(AlignmentSearch, TakesMirrorImagesOnlyWhereAllowed) {
  const cv::Mat rooms = office_rooms(5);
  cv::Mat mirrored;
  cv::flip(rooms, mirrored, 1);
  const MapRaster a = raster_of(mirrored), b = raster_of(rooms);
  const auto without = AlignmentSearch(a, b, Facing::kAsDrawn).best({}, 8),
             with = AlignmentSearch(a, b, Facing::kEither).best({}, 8);
  for (const MapAlignment& alignment : without) EXPECT_GT(alignment.T_b_a_px.linear().determinant(), 0);
  EXPECT_LT(with.front().T_b_a_px.linear().determinant(), 0);
  EXPECT_GT(with.front().score, without.front().score);
}

TEST(AlignmentSearch, GivesDifferentCandidatesOfEveryTurnBestFirst) {
  const MapRaster raster = raster_of(office_rooms(6));
  const auto found = AlignmentSearch(raster, raster, Facing::kAsDrawn).best({}, 8);
  EXPECT_EQ(found.size(), 8u);
  std::set<int> turns;
  for (size_t i = 0; i < found.size(); ++i) {
    const Eigen::Matrix2d linear = found[i].T_b_a_px.linear();
    turns.insert(static_cast<int>(std::lround(std::atan2(linear(1, 0), linear(0, 0)) / (std::numbers::pi / 2)) + 4) %
                 4);
    if (i > 0) {
      EXPECT_GE(found[i - 1].score, found[i].score);
    }
  }
  EXPECT_EQ(turns.size(), 4u);
}

TEST(AlignmentSearch, ObeysPinsThatContradictTheLooks) {
  const cv::Mat rooms = office_rooms(7);
  const MapRaster raster = raster_of(rooms);
  const AlignmentSearch search(raster, raster, Facing::kAsDrawn);
  const cv::Rect box = cv::boundingRect(rooms != 0);
  const Point2 low(box.x, box.y), high(box.x + box.width, box.y + box.height), sum = low + high;
  const std::vector<Pin> upside_down = {{low, sum - low}, {high, sum - high}};
  const MapAlignment best = search.best(upside_down, 1).front();
  for (const Pin& pin : upside_down) EXPECT_LT((best.T_b_a_px * pin.p_a_px - pin.p_b_px).norm(), 0.2 * box.width);
  EXPECT_LT(best.score, search.best({}, 1).front().score);
  EXPECT_LT(best.T_b_a_px.linear()(0, 0), 0);
}

}  // namespace
}  // namespace smokemap
