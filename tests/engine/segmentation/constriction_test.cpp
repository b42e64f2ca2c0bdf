#include "segmentation/constriction.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// Two rooms of 80 x 60 px joined by a door of 16 px in a wall of 6 px.
cv::Mat rooms_with_a_door() {
  cv::Mat map(100, 200, CV_8UC1, cv::Scalar(0));
  cv::rectangle(map, {15, 20, 80, 60}, 255, cv::FILLED);
  cv::rectangle(map, {101, 20, 80, 60}, 255, cv::FILLED);
  cv::rectangle(map, {95, 42, 6, 16}, 255, cv::FILLED);
  return map;
}

TEST(Constrictions, PartTwoRoomsAtTheirDoor) {
  const auto found = segment_by_constrictions(rooms_with_a_door());
  ASSERT_THAT(found, test::IsOk());
  ASSERT_EQ(found->regions.size(), 2u);
  ASSERT_EQ(found->borders.size(), 1u);
  EXPECT_NEAR(found->borders.front().width_px, 16, 3);
  EXPECT_NE(found->labels.at<std::uint16_t>(50, 40), found->labels.at<std::uint16_t>(50, 150));
}

TEST(Constrictions, LeaveNoFreePixelBlank) {
  const cv::Mat map = rooms_with_a_door();
  const auto found = segment_by_constrictions(map, matching_segmentation_params());
  ASSERT_THAT(found, test::IsOk());
  EXPECT_EQ(cv::countNonZero((map == 255) != (found->labels > 0)), 0);
}

TEST(Constrictions, KeepRoomsThatNothingConnects) {
  cv::Mat map = rooms_with_a_door();
  cv::rectangle(map, {95, 42, 6, 16}, 0, cv::FILLED);
  EXPECT_EQ(segment_by_constrictions(map)->regions.size(), 2u);
}

TEST(Constrictions, KeepSmallRoomsWhereMapsAreToBeMatched) {
  cv::Mat map = rooms_with_a_door();
  cv::rectangle(map, {40, 84, 14, 12}, 255, cv::FILLED);  // a cupboard with no door
  EXPECT_EQ(segment_by_constrictions(map, matching_segmentation_params())->regions.size(), 3u);
}

TEST(Constrictions, RefuseWhatCannotBeSplit) {
  EXPECT_THAT(segment_by_constrictions({}), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(segment_by_constrictions(cv::Mat(9, 9, CV_8UC1, cv::Scalar(0))), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(segment_by_constrictions(cv::Mat(9, 9, CV_8UC3)), test::Fails(Errc::kInvalidArgument));
  ConstrictionParams params;
  params.pinch_ratio = 2;
  EXPECT_THAT(segment_by_constrictions(rooms_with_a_door(), params), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
