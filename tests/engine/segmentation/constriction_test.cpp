#include "segmentation/constriction.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>
#include <set>

#include "core/random.hpp"
#include "tests/support/building_pictures.hpp"
#include "tests/support/plan_pictures.hpp"
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

TEST(Constrictions, CountNoDentInAWallAsARoomWhereMapsAreToBeMatched) {
  cv::Mat map(200, 440, CV_8UC1, cv::Scalar(0));
  const cv::Rect hall(20, 40, 150, 100), corridor(20, 144, 400, 12), door(80, 140, 8, 4);
  const cv::Rect crack(50, 36, 2, 4), dent(47, 30, 8, 6);
  for (const cv::Rect& part : {hall, corridor, door, crack, dent}) map(part).setTo(255);
  ConstrictionParams keeping = matching_segmentation_params();
  keeping.crumb_ratio = 0;
  EXPECT_EQ(segment_by_constrictions(map, keeping)->regions.size(), 3u);
  const auto found = segment_by_constrictions(map, matching_segmentation_params());
  ASSERT_EQ(found->regions.size(), 2u);
  EXPECT_EQ(found->labels.at<std::uint16_t>(32, 50), found->labels.at<std::uint16_t>(90, 90));
  EXPECT_EQ(cv::countNonZero((map == 255) != (found->labels > 0)), 0);
}

TEST(Constrictions, RefuseWhatCannotBeSplit) {
  EXPECT_THAT(segment_by_constrictions({}), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(segment_by_constrictions(cv::Mat(9, 9, CV_8UC1, cv::Scalar(0))), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(segment_by_constrictions(cv::Mat(9, 9, CV_8UC3)), test::Fails(Errc::kInvalidArgument));
  ConstrictionParams params;
  params.pinch_ratio = 2;
  EXPECT_THAT(segment_by_constrictions(rooms_with_a_door(), params), test::Fails(Errc::kInvalidArgument));
}

/// Share of true rooms that one region covers by more than four fifths of their union.
double rooms_parted(const cv::Mat& free_space, const test::PlanPicture& plan) {
  const auto found = segment_by_constrictions(free_space, matching_segmentation_params());
  if (!found) return 0;
  std::set<int> rooms;
  for (const Region& region : found->regions)
    if (const auto room = test::true_room(found->labels, region.label, plan.rooms); room.overlap > 0.8)
      rooms.insert(room.room);
  return static_cast<double>(rooms.size()) / static_cast<double>(plan.boxes.size());
}

TEST(Constrictions, FindTheRoomsOfOfficesHallsAndTwoWings) {
  double sum = 0;
  for (std::uint64_t seed = 50; seed < 56; ++seed) {
    std::mt19937_64 random(seed);
    const test::PlanPicture plan = seed % 3 == 0   ? test::office_plan(random)
                                   : seed % 3 == 1 ? test::hall_plan(random)
                                                   : test::building_plan(random);
    sum += rooms_parted(plan.free_space, plan);
  }
  EXPECT_GT(sum / 6, 0.8);
}

TEST(Constrictions, LabelAllFreeSpaceAndNothingElseInRegionsOfOnePiece) {
  for (std::uint64_t seed = 60; seed < 64; ++seed) {
    std::mt19937_64 random(seed);
    const cv::Mat map = seed % 2 ? test::hall_plan(random).free_space : test::building_plan(random).free_space;
    const auto found = segment_by_constrictions(map, matching_segmentation_params());
    ASSERT_THAT(found, test::IsOk());
    EXPECT_EQ(cv::countNonZero((map == 255) != (found->labels > 0)), 0);
    for (const Region& region : found->regions) {
      cv::Mat parts;
      const cv::Mat own = found->labels == region.label;
      EXPECT_EQ(cv::connectedComponents(own, parts, 4), 2) << "region " << region.label;
      EXPECT_EQ(cv::countNonZero(own), static_cast<int>(region.area_px));
    }
  }
}

TEST(Constrictions, BordersJoinRegionsThatTouchAndLieBetweenThem) {
  std::mt19937_64 random(65);
  const auto found = segment_by_constrictions(test::office_plan(random).free_space, matching_segmentation_params());
  ASSERT_THAT(found, test::IsOk());
  ASSERT_GE(found->borders.size(), 4u);
  for (const RegionBorder& border : found->borders) {
    EXPECT_NE(border.label_a, border.label_b);
    EXPECT_GT(border.width_px, 0);
    const Point2 middle = border.line_px.midpoint();
    const cv::Rect around(static_cast<int>(middle.x()) - 12, static_cast<int>(middle.y()) - 12, 25, 25);
    const cv::Mat near = found->labels(around & cv::Rect({}, found->labels.size()));
    EXPECT_GT(cv::countNonZero(near == border.label_a), 0);
    EXPECT_GT(cv::countNonZero(near == border.label_b), 0);
  }
}

TEST(Constrictions, FindTheSameRoomsWithAPixelOfNoise) {
  double sum = 0;
  for (std::uint64_t seed = 70; seed < 73; ++seed) {
    std::mt19937_64 random(seed);
    const test::PlanPicture plan = test::office_plan(random);
    cv::Mat rough = plan.free_space.clone(), shrunk;
    cv::erode(plan.free_space, shrunk, cv::Mat());
    for (int y = 0; y < rough.rows; ++y)
      for (int x = 0; x < rough.cols; ++x)
        if (shrunk.at<uchar>(y, x) != plan.free_space.at<uchar>(y, x) && uniform01(random) < 0.2)
          rough.at<uchar>(y, x) = 0;
    sum += rooms_parted(rough, plan);
  }
  EXPECT_GT(sum / 3, 0.8);
}

TEST(Constrictions, FindTheSameRoomsOnAMapTurnedByAQuarter) {
  std::mt19937_64 random(75);
  const test::PlanPicture plan = test::office_plan(random);
  test::PlanPicture turned = plan;
  cv::rotate(plan.free_space, turned.free_space, cv::ROTATE_90_CLOCKWISE);
  cv::rotate(plan.rooms, turned.rooms, cv::ROTATE_90_CLOCKWISE);
  EXPECT_NEAR(rooms_parted(plan.free_space, plan), rooms_parted(turned.free_space, turned), 0.12);
}

TEST(Constrictions, DoNotMindAnotherHouseOnTheSheet) {
  std::mt19937_64 random(76);
  const test::PlanPicture plan = test::office_plan(random);
  cv::Mat both;
  cv::copyMakeBorder(plan.free_space, both, 0, 0, 0, 240, cv::BORDER_CONSTANT, cv::Scalar(0));
  both(cv::Rect(plan.free_space.cols + 20, 60, 200, 200)).setTo(255);  // one hall, joined to nothing
  const auto alone = segment_by_constrictions(plan.free_space, matching_segmentation_params());
  const auto beside = segment_by_constrictions(both, matching_segmentation_params());
  ASSERT_TRUE(alone && beside);
  EXPECT_EQ(beside->regions.size(), alone->regions.size() + 1);
}

}  // namespace
}  // namespace smokemap
