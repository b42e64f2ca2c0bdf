#include "segmentation/segment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <string>

#include "core/random.hpp"
#include "segmentation/outline.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

cv::Mat walls(int rows, int cols) { return cv::Mat(rows, cols, CV_8UC1, cv::Scalar(0)); }

cv::Mat speckle(std::uint64_t seed, int rows, int cols, double share_free) {
  std::mt19937_64 random(seed);
  cv::Mat map = walls(rows, cols);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < cols; ++x)
      if (uniform01(random) < share_free) map.at<unsigned char>(y, x) = 255;
  return map;
}

/// Share of pixels that lie in the region that most of their region of the other partition lies in.
double agreement(const cv::Mat& one, const cv::Mat& two) {
  std::map<int, std::map<int, int>> counts;
  int total = 0, agreeing = 0;
  for (int y = 0; y < one.rows; ++y)
    for (int x = 0; x < one.cols; ++x)
      if (const int label = one.at<unsigned short>(y, x); label != 0)
        ++counts[label][two.at<unsigned short>(y, x)], ++total;
  for (const auto& [label, votes] : counts) {
    int most = 0;
    for (const auto& [other, count] : votes) most = std::max(most, count);
    agreeing += most;
  }
  return total == 0 ? 1 : static_cast<double>(agreeing) / total;
}

void expect_partition(const cv::Mat& free_space, const Segmentation& result) {
  EXPECT_EQ(cv::countNonZero((result.labels != 0) != (free_space == 255)), 0);
  double area = 0;
  for (size_t i = 0; i < result.regions.size(); ++i) {
    const Region& region = result.regions[i];
    EXPECT_EQ(region.label, static_cast<int>(i) + 1);
    EXPECT_EQ(region.area_px, cv::countNonZero(result.labels == region.label));
    EXPECT_EQ(result.labels.at<unsigned short>(static_cast<int>(region.anchor_px.y()),
                                               static_cast<int>(region.anchor_px.x())),
              region.label);
    if (i > 0) {
      EXPECT_LE(region.area_px, result.regions[i - 1].area_px);
    }
    area += region.area_px;
  }
  EXPECT_EQ(area, cv::countNonZero(free_space == 255));
}

TEST(Segment, GivesEveryFreePixelExactlyOneRegionAndWallsNone) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const cv::Mat noise = speckle(seed, 60, 80, 0.3 + 0.1 * static_cast<double>(seed));
    const auto result = segment(noise);
    ASSERT_TRUE(result);
    expect_partition(noise, *result);
  }
  std::mt19937_64 random(3);
  for (int i = 0; i < 4; ++i) {
    const test::PlanPicture plan = test::office_plan(random);
    const auto result = segment(plan.free_space);
    ASSERT_TRUE(result);
    expect_partition(plan.free_space, *result);
  }
}

TEST(Segment, FindsTheCorridorAndEveryRoomOfAnOffice) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 5; ++i) {
    const test::PlanPicture plan = test::office_plan(random);
    const auto result = segment(plan.free_space);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->regions.size(), plan.boxes.size());
    std::set<int> found;
    for (const Region& region : result->regions) {
      const test::TrueRoom room = test::true_room(result->labels, region.label, plan.rooms);
      EXPECT_GT(room.overlap, 0.9);  // rooms beside a corridor once lost a fifth of their area to it
      found.insert(room.room);
      EXPECT_EQ(region.kind == RegionKind::kCorridor, room.room == 1);
    }
    EXPECT_EQ(found.size(), plan.boxes.size());
  }
}

TEST(Segment, SaysWhereTheDoorsAreAndHowWide) {
  cv::Mat map = walls(80, 130);
  map(cv::Rect(10, 10, 50, 60)).setTo(255);
  map(cv::Rect(64, 10, 50, 60)).setTo(255);
  map(cv::Rect(60, 30, 4, 12)).setTo(255);
  const auto result = segment(map);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->regions.size(), 2u);
  ASSERT_EQ(result->borders.size(), 1u);
  EXPECT_NEAR(result->borders[0].width_px, 12, 2);
  EXPECT_NEAR(result->borders[0].line_px.midpoint().x(), 62, 4);
  EXPECT_NEAR(result->borders[0].line_px.midpoint().y(), 35.5, 2);
}

TEST(Segment, TurnsWithThePicture) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 4; ++i) {
    const test::PlanPicture plan = test::office_plan(random, 3);
    cv::Mat turned;
    cv::rotate(plan.free_space, turned, cv::ROTATE_90_CLOCKWISE);
    const auto upright = segment(plan.free_space), sideways = segment(turned);
    ASSERT_TRUE(upright && sideways);
    cv::Mat back;
    cv::rotate(sideways->labels, back, cv::ROTATE_90_COUNTERCLOCKWISE);
    EXPECT_EQ(upright->regions.size(), sideways->regions.size());
    EXPECT_GT(agreement(upright->labels, back), 0.985);
    EXPECT_GT(agreement(back, upright->labels), 0.985);
  }
}

TEST(Segment, DoesNotDependOnTheResolution) {
  std::mt19937_64 random(6);
  const test::PlanPicture plan = test::office_plan(random);
  cv::Mat doubled, shrunk;
  cv::resize(plan.free_space, doubled, {}, 2, 2, cv::INTER_NEAREST);
  const auto once = segment(plan.free_space), twice = segment(doubled);
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->regions.size(), twice->regions.size());
  cv::resize(twice->labels, shrunk, once->labels.size(), 0, 0, cv::INTER_NEAREST);
  EXPECT_GT(agreement(once->labels, shrunk), 0.98);
}

TEST(Segment, DoesNotCareForALargeHallElsewhere) {
  std::mt19937_64 random(7);
  const test::PlanPicture plan = test::office_plan(random);
  cv::Mat with_hall = walls(plan.free_space.rows + 320, plan.free_space.cols);
  plan.free_space.copyTo(with_hall(cv::Rect(0, 0, plan.free_space.cols, plan.free_space.rows)));
  with_hall(cv::Rect(10, plan.free_space.rows + 10, plan.free_space.cols - 20, 300)).setTo(255);
  const auto alone = segment(plan.free_space), beside = segment(with_hall);
  ASSERT_TRUE(alone && beside);
  EXPECT_EQ(beside->regions.size(), alone->regions.size() + 1);
  const cv::Mat same_part = beside->labels(cv::Rect(0, 0, plan.free_space.cols, plan.free_space.rows));
  EXPECT_GT(agreement(alone->labels, same_part), 0.99);
}

TEST(Segment, IsStableUnderAPixelOfNoiseOnTheWalls) {
  std::mt19937_64 random(8);
  const test::PlanPicture plan = test::office_plan(random);
  cv::Mat noisy = plan.free_space.clone(), grown;
  cv::dilate(plan.free_space, grown, cv::Mat());
  const cv::Mat rim = grown != plan.free_space;
  for (int y = 0; y < noisy.rows; ++y)
    for (int x = 0; x < noisy.cols; ++x)
      if (rim.at<unsigned char>(y, x) && uniform01(random) < 0.3) noisy.at<unsigned char>(y, x) = 255;
  const auto clean = segment(plan.free_space), rough = segment(noisy);
  ASSERT_TRUE(clean && rough);
  EXPECT_EQ(clean->regions.size(), rough->regions.size());
  EXPECT_GT(agreement(clean->labels, rough->labels), 0.97);
}

TEST(Segment, KeepsARoomThatNoDoorLeadsTo) {
  cv::Mat map = walls(100, 200);
  map(cv::Rect(5, 5, 80, 80)).setTo(255);
  map(cv::Rect(120, 30, 40, 40)).setTo(255);
  const auto result = segment(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 2u);
  EXPECT_TRUE(result->borders.empty());
}

TEST(Segment, DoesNotTakeChairsForWalls) {
  cv::Mat map = walls(140, 240);
  map(cv::Rect(10, 10, 100, 120)).setTo(255);
  map(cv::Rect(114, 10, 100, 120)).setTo(255);
  map(cv::Rect(110, 60, 4, 16)).setTo(255);
  for (int y = 30; y < 120; y += 18)
    for (int x = 30; x < 100; x += 16) map(cv::Rect(x, y, 4, 4)).setTo(0);
  const auto result = segment(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 2u);
  expect_partition(map, *result);
}

TEST(Segment, AnswersBadInputWithOneClearError) {
  EXPECT_EQ(segment(cv::Mat()).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(segment(cv::Mat(5, 5, CV_32FC1, cv::Scalar(1))).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(segment(walls(40, 40)).error().code, Errc::kDegenerate);
  EXPECT_EQ(segment(cv::Mat(9000, 9000, CV_8UC1)).error().code, Errc::kTooLarge);
  SegmentationParams params;
  params.door_ratio = 1.5;
  EXPECT_EQ(segment(walls(4, 4), params).error().code, Errc::kInvalidArgument);
}

TEST(Segment, AnswersSmallestInput) {
  cv::Mat one = walls(9, 9);
  one.at<unsigned char>(4, 4) = 255;
  const auto single = segment(one);
  ASSERT_TRUE(single);
  EXPECT_EQ(single->regions.size(), 1u);
  const auto open = segment(cv::Mat(50, 70, CV_8UC1, cv::Scalar(255)));
  ASSERT_TRUE(open);
  EXPECT_EQ(open->regions.size(), 1u);
  const auto pixel = segment(cv::Mat(1, 1, CV_8UC1, cv::Scalar(255)));
  ASSERT_TRUE(pixel);
  EXPECT_EQ(pixel->regions.size(), 1u);
}

TEST(Segment, GivesTheSameBytesTwice) {
  std::mt19937_64 random(9);
  const test::PlanPicture plan = test::office_plan(random);
  const auto one = segment(plan.free_space), two = segment(plan.free_space);
  EXPECT_EQ(cv::countNonZero(one->labels != two->labels), 0);
}

TEST(Segment, IsTheSameInAMirror) {
  std::mt19937_64 random(15);
  const test::PlanPicture plan = test::office_plan(random);
  cv::Mat mirrored, back;
  cv::flip(plan.free_space, mirrored, 1);
  const auto one = segment(plan.free_space), two = segment(mirrored);
  ASSERT_TRUE(one && two);
  cv::flip(two->labels, back, 1);
  EXPECT_EQ(one->regions.size(), two->regions.size());
  EXPECT_GT(agreement(one->labels, back), 0.985);
}

TEST(Segment, IsStableWhenThePictureIsTurnedALittle) {
  std::mt19937_64 random(16);
  const test::PlanPicture plan = test::office_plan(random, 3);
  const cv::Point2f middle(0.5f * static_cast<float>(plan.free_space.cols),
                           0.5f * static_cast<float>(plan.free_space.rows));
  for (const double angle_deg : {3.0, 17.0, 40.0}) {
    cv::Mat turn = cv::getRotationMatrix2D(middle, angle_deg, 1), turned, rooms;
    turn.at<double>(0, 2) += 150;
    turn.at<double>(1, 2) += 200;
    const cv::Size size(plan.free_space.cols + 300, plan.free_space.rows + 400);
    cv::warpAffine(plan.free_space, turned, turn, size, cv::INTER_NEAREST);
    cv::warpAffine(plan.rooms, rooms, turn, size, cv::INTER_NEAREST);
    const auto result = segment(turned);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->regions.size(), plan.boxes.size()) << angle_deg;
    for (const Region& region : result->regions)
      EXPECT_GT(test::true_room(result->labels, region.label, rooms).overlap, 0.9) << angle_deg;
  }
}

TEST(Segment, PartsOpenCubiclesFromTheCorridorTheyOpenTo) {
  cv::Mat map = walls(140, 330);
  map(cv::Rect(10, 60, 310, 36)).setTo(255);
  for (int x = 10; x < 280; x += 60) {
    map(cv::Rect(x, 10, 56, 46)).setTo(255);
    map(cv::Rect(x + 16, 56, 24, 4)).setTo(255);
  }
  const auto result = segment(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 6u);
  EXPECT_EQ(result->labels.at<unsigned short>(70, 20), result->labels.at<unsigned short>(70, 310));
}

TEST(Segment, DoesNotCutACorridorBetweenItsDoors) {
  cv::Mat map = walls(180, 330);
  map(cv::Rect(10, 80, 310, 24)).setTo(255);
  for (int x = 10; x < 280; x += 62) {
    map(cv::Rect(x, 10, 58, 64)).setTo(255);
    map(cv::Rect(x, 110, 58, 60)).setTo(255);
    map(cv::Rect(x + 20, 74, 20, 6)).setTo(255);
    map(cv::Rect(x + 24, 104, 20, 6)).setTo(255);
  }
  const auto result = segment(map);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->regions.size(), 11u);
  for (const RegionBorder& border : result->borders) {
    EXPECT_TRUE(border.is_door);
    EXPECT_NEAR(border.width_px, 20, 5);
    EXPECT_GT(border.confidence, 0.7);
  }
}

TEST(Segment, PartsADrawingWithoutDoorsAtItsWidenings) {
  cv::Mat map = walls(200, 300);
  map(cv::Rect(20, 20, 120, 160)).setTo(255);
  map(cv::Rect(140, 80, 140, 30)).setTo(255);
  const auto result = segment(map);
  ASSERT_TRUE(result);
  EXPECT_NE(result->labels.at<unsigned short>(100, 60), result->labels.at<unsigned short>(95, 220));
  const bool is_at_mouth = std::any_of(result->borders.begin(), result->borders.end(), [](const RegionBorder& border) {
    return !border.is_door && std::abs(border.line_px.midpoint().x() - 140) < 5 && border.width_px < 36;
  });
  EXPECT_TRUE(is_at_mouth);
}

TEST(Segment, DrawsStraightBoundaries) {
  std::mt19937_64 random(17);
  const test::PlanPicture plan = test::office_plan(random);
  const auto result = segment(plan.free_space);
  ASSERT_TRUE(result);
  for (const RegionBorder& border : result->borders) {
    const Point2 along = (border.line_px.b - border.line_px.a).normalized();
    const Point2 across(-along.y(), along.x());
    const cv::Mat both = (result->labels == border.label_a) | (result->labels == border.label_b);
    for (double share = 0.2; share < 0.9; share += 0.2) {
      const Point2 on = border.line_px.a + share * (border.line_px.b - border.line_px.a);
      std::set<int> sides;
      for (const double step : {-3.0, 3.0}) {
        const Point2 p = on + step * across;
        sides.insert(result->labels.at<unsigned short>(static_cast<int>(std::lround(p.y())),
                                                       static_cast<int>(std::lround(p.x()))));
      }
      EXPECT_EQ(sides, (std::set<int>{border.label_a, border.label_b}));
    }
  }
}

TEST(Segment, SaysHowSureItIs) {
  std::mt19937_64 random(18);
  const test::PlanPicture plan = test::office_plan(random);
  const auto result = segment(plan.free_space);
  ASSERT_TRUE(result);
  for (const Region& region : result->regions) {
    double least = 1;
    for (const RegionBorder& border : result->borders) {
      EXPECT_GE(border.confidence, 0.5);
      EXPECT_LE(border.confidence, 1);
      if (border.label_a == region.label || border.label_b == region.label) least = std::min(least, border.confidence);
    }
    EXPECT_EQ(region.confidence, least);
  }
}

TEST(Segment, AnswersASpeckledMegapixelInTime) {
  const auto result = segment(speckle(19, 500, 500, 0.6));
  ASSERT_TRUE(result);
  EXPECT_GE(result->regions.size(), 1u);
}

TEST(SegmentationParams, NameTheFieldThatIsOutOfRange) {
  SegmentationParams params;
  EXPECT_TRUE(params.validate());
  params.without_doors.passage_depth = -1;
  const auto wrong = params.validate();
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("passage_depth"), std::string::npos);
}

TEST(SegmentationFromLabels, RenumbersByArea) {
  cv::Mat labels(20, 40, CV_16UC1, cv::Scalar(0));
  labels(cv::Rect(0, 0, 5, 20)).setTo(900);
  labels(cv::Rect(5, 0, 30, 20)).setTo(7);
  const auto result = segmentation_from_labels(labels);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->labels.at<unsigned short>(3, 2), 2);
  EXPECT_EQ(result->labels.at<unsigned short>(3, 20), 1);
  ASSERT_EQ(result->borders.size(), 1u);
  EXPECT_NEAR(result->borders[0].width_px, 19, 1.1);
  EXPECT_EQ(segmentation_from_labels(cv::Mat(3, 3, CV_16UC1, cv::Scalar(0))).error().code, Errc::kDegenerate);
}

TEST(FreeSpaceOfPicture, IsWhatIsBrighterThanTheThreshold) {
  cv::Mat gray(1, 4, CV_8UC1);
  for (int x = 0; x < 4; ++x) gray.at<unsigned char>(0, x) = static_cast<unsigned char>(249 + x);
  const auto free_space = free_space_of_picture(gray);
  ASSERT_TRUE(free_space);
  EXPECT_EQ(cv::countNonZero(*free_space), 2);
  EXPECT_FALSE(free_space_of_picture(cv::Mat()));
  EXPECT_FALSE(free_space_of_picture(cv::Mat(2, 2, CV_32FC1)));
}

TEST(RegionOutline, GoesRoundTheRegion) {
  std::mt19937_64 random(10);
  const test::PlanPicture plan = test::office_plan(random);
  const auto result = segment(plan.free_space);
  ASSERT_TRUE(result);
  for (const Region& region : result->regions) {
    const Polygon outline = region_outline(*result, region.label);
    EXPECT_GE(outline.size(), 4u);
    EXPECT_TRUE(contains(outline, region.anchor_px));
    EXPECT_NEAR(std::abs(signed_area(outline)) / region.area_px, 1, 0.12);
  }
  EXPECT_TRUE(region_outline(*result, 999).empty());
}

}  // namespace
}  // namespace smokemap
