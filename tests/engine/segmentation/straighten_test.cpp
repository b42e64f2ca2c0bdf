#include "segmentation/straighten.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "segmentation/regions.hpp"

namespace smokemap {
namespace {

/// Two rooms with an opening of 16 between them, parted along a ragged line.
cv::Mat ragged_rooms(cv::Mat& structure) {
  structure = cv::Mat(80, 160, CV_8UC1, cv::Scalar(0));
  structure(cv::Rect(8, 8, 68, 64)).setTo(255);
  structure(cv::Rect(84, 8, 68, 64)).setTo(255);
  structure(cv::Rect(76, 32, 8, 16)).setTo(255);
  cv::Mat labels(structure.size(), CV_32SC1, cv::Scalar(0));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (structure.at<uchar>(y, x) == 255) labels.at<int>(y, x) = x < 66 + (y * 7) % 9 ? 1 : 2;
  return labels;
}

TEST(StraightenBorders, PutsARaggedBorderIntoTheDoor) {
  cv::Mat structure;
  const cv::Mat ragged = ragged_rooms(structure), straight = straighten_borders(ragged, structure);
  EXPECT_EQ(cv::countNonZero((straight != 0) != (structure == 255)), 0);
  EXPECT_EQ(straight.at<int>(40, 20), 1);
  EXPECT_EQ(straight.at<int>(40, 140), 2);
  EXPECT_EQ(straight.at<int>(12, 74), 1) << "a corner of the left room";
  const auto borders = find_contacts(straight);
  ASSERT_EQ(borders.size(), 1u);
  EXPECT_LT(borders[0].pixels.size(), 2u * 24u);
}

TEST(StraightenBorders, LeavesWhatIsNotFreeAlone) {
  cv::Mat structure;
  const cv::Mat labels = ragged_rooms(structure);
  const cv::Mat straight = straighten_borders(labels, structure);
  EXPECT_EQ(cv::countNonZero((straight != 0) & (structure == 0)), 0);
  const cv::Mat one(9, 9, CV_32SC1, cv::Scalar(1)), open(9, 9, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(cv::countNonZero(straighten_borders(one, open) != one), 0);
}

constexpr int kRoom = 1, kCorridor = 2;

/// A room on the left and a long corridor on the right of a wall (columns 100 to 104) with a door (rows 40 to 59).
struct RoomAndCorridor {
  cv::Mat structure{cv::Mat(400, 160, CV_8UC1, cv::Scalar(0))};
  cv::Mat labels{cv::Mat(400, 160, CV_32SC1, cv::Scalar(0))};

  RoomAndCorridor() {
    const cv::Rect room(10, 10, 90, 90), corridor(105, 5, 35, 390), door(100, 40, 5, 20);
    for (const cv::Rect& part : {room, corridor, door}) structure(part).setTo(255);
    labels(room).setTo(kRoom);
    labels(corridor).setTo(kCorridor);
    labels(door).setTo(kCorridor);
  }
};

TEST(StraightenBorders, LeavesABorderThatNothingParts) {
  cv::Mat labels(60, 60, CV_32SC1, cv::Scalar(1));
  labels(cv::Rect(20, 20, 20, 20)).setTo(2);  // an island without a wall
  EXPECT_EQ(cv::countNonZero(straighten_borders(labels, cv::Mat(60, 60, CV_8UC1, cv::Scalar(255))) != labels), 0);
}

TEST(StraightenBorders, DoesNotGiveAwayWhatHappensToLieInTheWindow) {
  // A hook of wall in the door makes a pocket. The shortest cut closes the pocket and parts nothing else: within the
  // window there was more of the room, so that it got a square of the corridor.
  RoomAndCorridor map;
  cv::line(map.structure, {100, 53}, {104, 53}, 0);
  cv::line(map.structure, {104, 53}, {104, 59}, 0);
  map.labels.setTo(0, map.structure == 0);
  const cv::Mat straight = straighten_borders(map.labels, map.structure);
  for (int y = 5; y < 395; ++y)
    for (int x = 105; x < 140; ++x) ASSERT_EQ(straight.at<int>(y, x), kCorridor) << x << ' ' << y;
  for (int y = 10; y < 100; ++y)
    for (int x = 10; x < 98; ++x) ASSERT_EQ(straight.at<int>(y, x), kRoom) << x << ' ' << y;
}

}  // namespace
}  // namespace smokemap
