#include "segmentation/cut_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "segmentation/wall_rings.hpp"

namespace smokemap {
namespace {

CutChoice choice_for(const cv::Mat& map, const SegmentationParams& params = {}) {
  CutSearch search;
  search.longest_px = 200;
  search.tolerance_px = 1.5;
  return choose_cuts(candidate_cuts(map, trace_wall_rings(map, 1.5), search), map, 20, params);
}

/// A row of `count` rooms above a corridor, each behind a door of 14.
cv::Mat row_of_rooms(int count, int room_width = 50) {
  cv::Mat map(130, 20 + count * (room_width + 6), CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 80, map.cols - 20, 30)).setTo(255);
  for (int i = 0; i < count; ++i) {
    const int x = 10 + i * (room_width + 6);
    map(cv::Rect(x, 10, room_width, 64)).setTo(255);
    map(cv::Rect(x + 18, 74, 14, 6)).setTo(255);
  }
  return map;
}

TEST(ChooseCuts, ClosesEveryDoorOnce) {
  const cv::Mat map = row_of_rooms(5);
  const CutChoice choice = choice_for(map);
  EXPECT_TRUE(choice.has_doors);
  EXPECT_EQ(choice.cuts.size(), 5u);
  cv::Mat parted = map.clone(), pieces;
  for (const ChosenCut& chosen : choice.cuts) {
    EXPECT_FALSE(chosen.is_mouth);
    EXPECT_NEAR(chosen.cut.length_px, 14, 4);
    EXPECT_LT(chosen.cost, 0.7);
    draw_cut(chosen.cut, parted);
  }
  EXPECT_EQ(cv::connectedComponents(parted, pieces, 4), 1 + 6);
}

TEST(ChooseCuts, TakesBackTheLineAcrossACorridorThatOpenDoorsMadeLookLikeADoor) {
  cv::Mat map = row_of_rooms(4, 40);
  map(cv::Rect(66, 74, 20, 6)).setTo(255);
  for (const ChosenCut& chosen : choice_for(map).cuts) {
    const bool is_across = std::abs(chosen.cut.a.x - chosen.cut.b.x) < 8 && chosen.cut.length_px > 25;
    EXPECT_FALSE(is_across) << chosen.cut.a << chosen.cut.b;
  }
}

TEST(ChooseCuts, SeesNoDoorsWhereThereAreNone) {
  cv::Mat map(160, 260, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 120, 140)).setTo(255);
  map(cv::Rect(130, 60, 120, 30)).setTo(255);
  const CutChoice choice = choice_for(map);
  EXPECT_FALSE(choice.has_doors);
  const bool is_at_mouth = std::any_of(choice.cuts.begin(), choice.cuts.end(), [](const ChosenCut& chosen) {
    return chosen.is_mouth && std::abs(chosen.cut.a.x - 130) < 5 && std::abs(chosen.cut.b.x - 130) < 5;
  });
  EXPECT_TRUE(is_at_mouth);
}

TEST(ChooseCuts, LeavesNichesToTheirRoom) {
  cv::Mat map(100, 120, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 80, 80)).setTo(255);
  map(cv::Rect(90, 30, 5, 30)).setTo(255);
  EXPECT_TRUE(choice_for(map).cuts.empty());
}

TEST(ChooseCuts, ChoosesCutsThatDoNotCross) {
  const CutChoice choice = choice_for(row_of_rooms(6, 34));
  for (size_t i = 0; i < choice.cuts.size(); ++i)
    for (size_t j = i + 1; j < choice.cuts.size(); ++j) {
      cv::Mat one(130, 300, CV_8UC1, cv::Scalar(255)), two = one.clone();
      draw_cut(choice.cuts[i].cut, one);
      draw_cut(choice.cuts[j].cut, two);
      EXPECT_LE(cv::countNonZero((one == 0) & (two == 0)), 2);
    }
}

}  // namespace
}  // namespace smokemap
