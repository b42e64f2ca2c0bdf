#include "matching/published.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "core/random.hpp"
#include "matching/match.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Segmentation rooms_of_plan(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return *segmentation_from_labels(test::office_plan(random).rooms);
}

/// Four rooms in a row: one huge, the others equal.
Segmentation huge_and_small() {
  cv::Mat rooms(120, 320, CV_16UC1, cv::Scalar(0));
  rooms(cv::Rect(10, 10, 150, 100)).setTo(1);
  for (int i = 0; i < 3; ++i) rooms(cv::Rect(160 + 40 * i, 40, 40, 40)).setTo(i + 2);
  return *segmentation_from_labels(rooms);
}

TEST(Ursim, CallsTheHugeRoomUniqueAndTheEqualOnesNot) {
  const UrsimRegions regions = ursim_regions(huge_and_small());
  EXPECT_EQ(regions.unique, std::vector<int>{0});
  EXPECT_NEAR(regions.size.sum(), 0, 1e-9);
  EXPECT_NEAR(regions.size.squaredNorm(), 4, 1e-9);  // four regions, population variance one
  EXPECT_NEAR(regions.elongation(1), 0, 1e-9);       // a square
  EXPECT_NEAR(regions.elongation(0), 1 - (100. * 100 - 1) / (150. * 150 - 1), 1e-9);
}

TEST(Ursim, KeepsHeatThatStartsAtTheAnchorAndSpreadsWithTheHops) {
  const Eigen::MatrixXd heat = anchor_heat(huge_and_small(), {0});
  EXPECT_EQ(heat.cols(), 16);
  EXPECT_NEAR(heat(0, 0), 1, 1e-9);
  EXPECT_NEAR(heat.col(0).tail(3).norm(), 0, 1e-9);
  std::vector<double> last(heat.col(15).data(), heat.col(15).data() + 4);
  EXPECT_TRUE(std::is_sorted(last.rbegin(), last.rend()));
  for (Eigen::Index k = 1; k < heat.cols(); ++k) EXPECT_LT(heat(0, k), heat(0, k - 1));
}

TEST(Ursim, FindsAMapInItself) {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const Segmentation map = rooms_of_plan(seed);
    const std::vector<RegionPair> pairs = match_ursim(map, map);
    EXPECT_EQ(pairs.size(), map.regions.size());
    EXPECT_EQ(pairs.front().label_a, pairs.front().label_b);
  }
}

TEST(Voronoi, PairsRegionsOneOfAAtMostOnce) {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const Segmentation map = rooms_of_plan(seed);
    const std::vector<RegionPair> pairs = match_voronoi(map, map);
    std::set<int> seen;
    int right = 0;
    for (const RegionPair& pair : pairs) {
      EXPECT_TRUE(seen.insert(pair.label_a).second);
      right += pair.label_a == pair.label_b;
    }
    EXPECT_GE(2 * right, static_cast<int>(pairs.size()));
  }
}

TEST(PublishedMethods, AreReachedThroughMatchAndKeepTaps) {
  const Segmentation map = rooms_of_plan(5);
  for (const MatchMethod method : {MatchMethod::kUrsim, MatchMethod::kVoronoi}) {
    MatchParams params;
    params.method = method;
    const Pin pin{map.regions[2].anchor_px, map.regions[4].anchor_px};
    const auto matching = match(map, map, {pin}, {{1, 1, 0, Verdict::kRejected}}, params);
    ASSERT_THAT(matching, test::IsOk());
    EXPECT_TRUE(matching->doubtful);  // they cannot tell
    int tapped = 0, proposed_again = 0;
    for (const RegionPair& pair : matching->pairs) {
      tapped += pair.label_a == 3 && pair.label_b == 5;
      proposed_again += pair.label_a == 1 && pair.label_b == 1 && pair.verdict == Verdict::kProposed;
    }
    EXPECT_EQ(tapped, 1);
    EXPECT_EQ(proposed_again, 0);
  }
}

}  // namespace
}  // namespace smokemap
