#include "matching/group_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <set>

#include "core/random.hpp"
#include "matching/region_groups.hpp"

namespace smokemap {
namespace {

/// Rooms 1 and 2 above each other, room 3 beside.
cv::Mat three_rooms() {
  cv::Mat labels(100, 160, CV_16UC1, cv::Scalar(0));
  labels(cv::Rect(10, 10, 60, 30)).setTo(1);
  labels(cv::Rect(10, 45, 60, 40)).setTo(2);
  labels(cv::Rect(90, 20, 50, 60)).setTo(3);
  return labels;
}

TEST(GroupSides, HaveTheAreaTheBoxAndTheRimOfTheirRooms) {
  const auto sides = make_sides(three_rooms(), {-1, 0, 0, 1}, 2, Eigen::Matrix2d::Identity());
  EXPECT_EQ(sides[0].area_px, 60 * 30 + 60 * 40);
  EXPECT_EQ(sides[1].area_px, 50 * 60);
  EXPECT_EQ(sides[0].low, Point2(10, 10));
  EXPECT_EQ(sides[0].high, Point2(69, 84));
  EXPECT_EQ(sides[1].rim.size(), 2u * (50 + 60) - 4);
}

TEST(GroupSides, LieInTheFrameOfTheWalls) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.5).toRotationMatrix();
  const auto straight = make_sides(three_rooms(), {-1, -1, -1, 0}, 1, Eigen::Matrix2d::Identity());
  const auto turned = make_sides(three_rooms(), {-1, -1, -1, 0}, 1, turn);
  EXPECT_GT(turned[0].diagonal(), straight[0].diagonal());
  for (const cv::Point& p : turned[0].rim) {
    const Point2 q = turn * Point2(p.x, p.y);
    EXPECT_TRUE((q.array() >= turned[0].low.array() - 1e-9).all() &&
                (q.array() <= turned[0].high.array() + 1e-9).all());
  }
}

TEST(GroupMap, KeepsThePlaceInTheBoxWithoutHandles) {
  const auto sides = make_sides(three_rooms(), {-1, 0, -1, 1}, 2, Eigen::Matrix2d::Identity());
  const GroupMap map(sides[0], sides[1], {});
  EXPECT_LT((map(Point2(10, 10)) - Point2(90, 20)).norm(), 1e-9);
  EXPECT_LT((map(Point2(69, 39)) - Point2(139, 79)).norm(), 1e-9);
  EXPECT_LT((map(Point2(39.5, 24.5)) - Point2(114.5, 49.5)).norm(), 1e-9);
}

TEST(GroupMap, IsExactAtHandlesAndContinuousAroundThem) {
  const auto sides = make_sides(three_rooms(), {-1, 0, -1, 1}, 2, Eigen::Matrix2d::Identity());
  std::mt19937_64 random(1);
  std::vector<Handle> handles;
  for (int k = 0; k < 4; ++k)
    handles.push_back({Point2(uniform(random, 10, 69), uniform(random, 10, 39)),
                       Point2(uniform(random, 90, 139), uniform(random, 20, 79)), k == 0});
  const GroupMap map(sides[0], sides[1], handles);
  for (const Handle& handle : handles) {
    EXPECT_LT((map(handle.p_from) - handle.p_to).norm(), 1e-9);
    EXPECT_LT((map(handle.p_from + Point2(1e-4, 0)) - handle.p_to).norm(), 1e-2);
  }
}

TEST(GroupMap, IsSurestAtAPinAndNeverSure) {
  const auto sides = make_sides(three_rooms(), {-1, 0, -1, 1}, 2, Eigen::Matrix2d::Identity());
  const Handle pin{Point2(30, 20), Point2(100, 40), true}, door{Point2(60, 20), Point2(130, 40), false};
  const GroupMap map(sides[0], sides[1], {pin, door}), plain(sides[0], sides[1], {door});
  EXPECT_GT(map.sigma(pin.p_from), 0);
  for (double x = 30; x < 69; x += 3) {
    EXPECT_LE(map.sigma(Point2(x, 20)), map.sigma(Point2(x + 3, 20)) + 1e-12);
    EXPECT_LE(map.sigma(Point2(x, 20)), plain.sigma(Point2(x, 20)));
  }
}

/// Groups by repainting until nothing changes.
std::vector<std::pair<std::set<int>, std::set<int>>> painted_groups(const std::vector<RegionPair>& pairs) {
  std::vector<int> colour;
  for (size_t k = 0; k < pairs.size(); ++k) colour.push_back(static_cast<int>(k));
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t k = 0; k < pairs.size(); ++k)
      for (size_t l = 0; l < pairs.size(); ++l)
        if ((pairs[k].label_a == pairs[l].label_a || pairs[k].label_b == pairs[l].label_b) && colour[l] > colour[k])
          colour[l] = colour[k], changed = true;
  }
  std::vector<std::pair<std::set<int>, std::set<int>>> groups;
  for (const int one : std::set<int>(colour.begin(), colour.end())) {
    auto& group = groups.emplace_back();
    for (size_t k = 0; k < pairs.size(); ++k)
      if (colour[k] == one) group.first.insert(pairs[k].label_a), group.second.insert(pairs[k].label_b);
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

TEST(RegionGroups, AreTheConnectedPartsOfThePairs) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<RegionPair> pairs;
    for (int k = 0; k < 8; ++k)
      pairs.push_back({1 + static_cast<int>(uniform_index(random, 9)), 1 + static_cast<int>(uniform_index(random, 9)),
                       uniform01(random), Verdict::kProposed});
    const auto wanted = painted_groups(pairs);
    std::vector<RegionPair> with_rejected = pairs;
    with_rejected.push_back({1, 9, 0.5, Verdict::kRejected});
    const std::vector<RegionGroup> groups = group_pairs(with_rejected);
    ASSERT_EQ(groups.size(), wanted.size());
    for (size_t g = 0; g < groups.size(); ++g) {
      EXPECT_TRUE(std::equal(groups[g].labels_a.begin(), groups[g].labels_a.end(), wanted[g].first.begin()));
      EXPECT_TRUE(std::equal(groups[g].labels_b.begin(), groups[g].labels_b.end(), wanted[g].second.begin()));
      double least = 1;
      for (const RegionPair& pair : pairs)
        if (wanted[g].first.contains(pair.label_a)) least = std::min(least, pair.confidence);
      EXPECT_EQ(groups[g].confidence, least);
    }
  }
}

}  // namespace
}  // namespace smokemap
