#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <vector>

#include "core/random.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

/// Share of true rooms that one region covers by more than nine tenths of their union.
double rooms_found(const cv::Mat& free_space, const cv::Mat& rooms, size_t count) {
  const auto result = segment(free_space);
  if (!result) return 0;
  std::set<int> found;
  for (const Region& region : result->regions)
    if (const test::TrueRoom room = test::true_room(result->labels, region.label, rooms); room.overlap > 0.9)
      found.insert(room.room);
  return static_cast<double>(found.size()) / static_cast<double>(count);
}

void add_noise(cv::Mat& map, std::mt19937_64& random, double share) {
  cv::Mat grown, shrunk;
  cv::dilate(map, grown, cv::Mat());
  cv::erode(map, shrunk, cv::Mat());
  const cv::Mat before = map.clone();
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x) {
      if (grown.at<uchar>(y, x) != before.at<uchar>(y, x) && uniform01(random) < share) map.at<uchar>(y, x) = 255;
      if (shrunk.at<uchar>(y, x) != before.at<uchar>(y, x) && uniform01(random) < share) map.at<uchar>(y, x) = 0;
    }
}

TEST(SegmentStability, FindsTheSameRoomsWithAPixelOfNoiseOnBothSidesOfTheWalls) {
  double sum = 0;
  for (std::uint64_t seed = 31; seed < 35; ++seed) {
    std::mt19937_64 random(seed);
    test::PlanPicture plan = test::office_plan(random, 3);
    add_noise(plan.free_space, random, 0.25);
    sum += rooms_found(plan.free_space, plan.rooms, plan.boxes.size());
  }
  EXPECT_GT(sum / 4, 0.95);
}

TEST(SegmentStability, DoesNotCareWhereInThePictureTheHouseIs) {
  std::mt19937_64 random(36);
  const test::PlanPicture plan = test::office_plan(random);
  cv::Mat moved;
  cv::copyMakeBorder(plan.free_space, moved, 37, 5, 11, 23, cv::BORDER_CONSTANT, cv::Scalar(0));
  const auto here = segment(plan.free_space), there = segment(moved);
  ASSERT_TRUE(here && there);
  const cv::Mat same = there->labels(cv::Rect(11, 37, plan.free_space.cols, plan.free_space.rows));
  EXPECT_EQ(cv::countNonZero(same != here->labels), 0);
}

TEST(SegmentStability, FindsTheSameRoomsBesideAHallOfAnySize) {
  std::mt19937_64 random(37);
  const test::PlanPicture plan = test::office_plan(random);
  for (const int height : {120, 400}) {
    cv::Mat map, rooms;
    cv::copyMakeBorder(plan.free_space, map, 0, height + 20, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::copyMakeBorder(plan.rooms, rooms, 0, height + 20, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(0));
    map(cv::Rect(10, plan.free_space.rows + 10, map.cols - 20, height)).setTo(255);
    EXPECT_GT(rooms_found(map, rooms, plan.boxes.size()), 0.99) << height;
  }
}

TEST(SegmentStability, FindsTheSameRoomsWithChairsInThem) {
  double sum = 0;
  for (std::uint64_t seed = 41; seed < 44; ++seed) {
    std::mt19937_64 random(seed);
    test::PlanPicture plan = test::office_plan(random);
    for (int i = 0; i < 60; ++i) {
      const cv::Point at(static_cast<int>(uniform(random, 4, plan.free_space.cols - 8)),
                         static_cast<int>(uniform(random, 4, plan.free_space.rows - 8)));
      const cv::Mat around = plan.free_space(cv::Rect(at.x - 3, at.y - 3, 9, 9));
      if (cv::countNonZero(around) == static_cast<int>(around.total()))
        plan.free_space(cv::Rect(at.x, at.y, 3, 3)).setTo(0);
    }
    sum += rooms_found(plan.free_space, plan.rooms, plan.boxes.size());
  }
  EXPECT_GT(sum / 3, 0.93);
}

TEST(SegmentStability, AnOpeningOfAnyWidthShortOfTheWallPartsTwoRooms) {
  for (const int width : {12, 20, 30, 40, 50}) {
    cv::Mat map(80, 130, CV_8UC1, cv::Scalar(0));
    map(cv::Rect(10, 10, 50, 60)).setTo(255);
    map(cv::Rect(64, 10, 50, 60)).setTo(255);
    map(cv::Rect(60, 40 - width / 2, 4, width)).setTo(255);
    const auto result = segment(map);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->regions.size(), 2u) << width;
  }
}

}  // namespace
}  // namespace smokemap
