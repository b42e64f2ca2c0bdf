#include "segmentation/maoris.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

TEST(SegmentMaoris, FindsTheRoomsOfAnOffice) {
  std::mt19937_64 random(21);
  const test::PlanPicture plan = test::office_plan(random);
  const auto result = segment_maoris(plan.free_space);
  ASSERT_TRUE(result);
  EXPECT_NEAR(static_cast<double>(result->regions.size()), static_cast<double>(plan.boxes.size()), 2);
  std::set<int> found;
  for (const Region& region : result->regions)
    found.insert(test::true_room(result->labels, region.label, plan.rooms).room);
  EXPECT_GE(found.size() + 2, plan.boxes.size());
}

TEST(SegmentMaoris, LabelsFreeSpaceAndNothingElse) {
  std::mt19937_64 random(22);
  const test::PlanPicture plan = test::office_plan(random);
  const auto result = segment_maoris(plan.free_space);
  ASSERT_TRUE(result);
  EXPECT_EQ(cv::countNonZero((result->labels != 0) != (plan.free_space == 255)), 0);
}

TEST(SegmentMaoris, GivesCrumbsOfALaserMapToTheNearestRoom) {
  // Single pixels beside the walls were once regions of their own and counted as wrong ones.
  cv::Mat map(120, 220, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 90, 90)).setTo(255);
  map(cv::Rect(110, 10, 90, 90)).setTo(255);
  map(cv::Rect(100, 46, 10, 16)).setTo(255);
  for (int x = 12; x < 200; x += 7) map.at<unsigned char>(104, x) = 255;
  const auto result = segment_maoris(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 2u);
  EXPECT_EQ(cv::countNonZero((result->labels != 0) != (map == 255)), 0);
  EXPECT_EQ(result->labels.at<unsigned short>(104, 12), result->labels.at<unsigned short>(90, 12));
}

TEST(SegmentMaoris, KeepsARoomThatTouchesNoOther) {
  cv::Mat map(120, 320, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 90, 90)).setTo(255);
  map(cv::Rect(110, 10, 90, 90)).setTo(255);
  map(cv::Rect(100, 46, 10, 16)).setTo(255);
  map(cv::Rect(220, 20, 60, 60)).setTo(255);
  const auto result = segment_maoris(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 3u);
}

TEST(SegmentMaoris, KeepsACorridorOfOneWidthWhole) {
  cv::Mat map(60, 420, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 20, 400, 22)).setTo(255);
  const auto result = segment_maoris(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 1u);
}

TEST(SegmentMaoris, GivesTheSameBytesTwice) {
  std::mt19937_64 random(23);
  const test::PlanPicture plan = test::office_plan(random);
  const auto one = segment_maoris(plan.free_space), two = segment_maoris(plan.free_space);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(cv::countNonZero(one->labels != two->labels), 0);
}

TEST(SegmentMaoris, PartsTwoRoomsAtTheirDoor) {
  cv::Mat map(100, 200, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 80, 80)).setTo(255);
  map(cv::Rect(100, 10, 80, 80)).setTo(255);
  map(cv::Rect(90, 42, 10, 14)).setTo(255);
  const auto result = segment_maoris(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 2u);
  EXPECT_NE(result->labels.at<unsigned short>(50, 40), result->labels.at<unsigned short>(50, 150));
}

TEST(SegmentMaoris, DependsOnTheLargestRoomAsPublished) {
  // Its values are shares of the largest open space: beside a great hall small rooms and their doors fall together.
  cv::Mat map(700, 700, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 20, 20)).setTo(255);
  map(cv::Rect(34, 10, 20, 20)).setTo(255);
  map(cv::Rect(30, 14, 4, 12)).setTo(255);
  const cv::Mat alone = map(cv::Rect(0, 0, 80, 60)).clone();
  map(cv::Rect(50, 100, 600, 590)).setTo(255);
  const auto small = segment_maoris(alone), beside_hall = segment_maoris(map);
  ASSERT_TRUE(small && beside_hall);
  EXPECT_LE(beside_hall->regions.size(), small->regions.size() + 1);
}

TEST(SegmentMaoris, TakesItsDoorShareFromTheKindOfMap) {
  EXPECT_EQ(maoris_params(MapKind::kRobot).door_share, 0.40);
  EXPECT_EQ(maoris_params(MapKind::kSketch).door_share, 0.60);
}

TEST(SegmentMaoris, AnswersBadInputWithOneClearError) {
  EXPECT_EQ(segment_maoris(cv::Mat()).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(segment_maoris(cv::Mat(9, 9, CV_8UC1, cv::Scalar(0))).error().code, Errc::kDegenerate);
  EXPECT_EQ(segment_maoris(cv::Mat(5000, 5000, CV_8UC1)).error().code, Errc::kTooLarge);
  MaorisParams params;
  params.threshold = 2;
  EXPECT_EQ(segment_maoris(cv::Mat(9, 9, CV_8UC1, cv::Scalar(255)), params).error().code, Errc::kInvalidArgument);
}

TEST(SegmentMaoris, AnswersOnePixel) {
  const auto result = segment_maoris(cv::Mat(1, 1, CV_8UC1, cv::Scalar(255)));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 1u);
}

}  // namespace
}  // namespace smokemap
