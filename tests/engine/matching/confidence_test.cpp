#include "matching/confidence.hpp"

#include <gtest/gtest.h>

#include <random>

#include "matching/region_graph.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"

namespace smokemap {
namespace {

std::vector<Hypothesis> hypotheses_of_itself(const Segmentation& map) {
  const auto n = static_cast<Eigen::Index>(map.regions.size());
  return HypothesisFinder(map, map, {}).find({}, {Eigen::MatrixXi::Zero(n, n), Eigen::MatrixXi::Zero(n, n)});
}

TEST(Confidence, RisesWithEveryKindOfEvidenceAndIsNeverQuiteSure) {
  const PairEvidence none;
  for (double PairEvidence::*kind : {&PairEvidence::certainty, &PairEvidence::likeness, &PairEvidence::agreement}) {
    PairEvidence some;
    some.*kind = 1;
    EXPECT_GT(confidence_of(some), confidence_of(none));
  }
  EXPECT_LT(confidence_of({1, 1, 1}), 0.98);
  EXPECT_GT(confidence_of(none), 0);
}

TEST(Confidence, OfWhatAllAnswersAgreeOnIsHighAndOfWhatMostDenyIsLow) {
  EXPECT_GT(confidence_of({1, 0.8, 1}), 0.9);
  EXPECT_LT(confidence_of({1, 0.8, 0.2}), 0.35);
  EXPECT_LT(confidence_of({0, 0, 0}), 0.05);
}

TEST(Confidence, IsHigherForTheTrueRoomThanForAnother) {
  std::mt19937_64 random(1);
  const Segmentation map = *segmentation_from_labels(test::office_plan(random).rooms);
  const std::vector<Hypothesis> all = hypotheses_of_itself(map);
  for (const Region& region : map.regions) {
    const int other = region.label == 1 ? 2 : 1;
    EXPECT_GT(confidence_of(weigh_pair({region.label, region.label}, all)),
              confidence_of(weigh_pair({region.label, other}, all)));
  }
}

TEST(Hypotheses, AreOrderedAndDifferFromEachOther) {
  std::mt19937_64 random(2);
  const Segmentation map = *segmentation_from_labels(test::hall_plan(random).rooms);
  const std::vector<Hypothesis> all = hypotheses_of_itself(map);
  ASSERT_GE(all.size(), 2u);
  for (size_t i = 1; i < all.size(); ++i) EXPECT_GE(all[i - 1].score, all[i].score);
  EXPECT_LT((all.front().turn_b_a - Eigen::Matrix2d::Identity()).norm(), 0.2);
}

TEST(RegionGraph, KnowsHopsAndWaysOfRoomsInARow) {
  cv::Mat rooms(40, 140, CV_16UC1, cv::Scalar(0));
  for (int i = 0; i < 3; ++i) rooms(cv::Rect(5 + 40 * i, 5, 40, 30)).setTo(i + 1);
  const Segmentation map = *segmentation_from_labels(rooms);
  const RegionGraph graph = make_region_graph(map);
  const auto at = [&](int x) { return map.labels.at<unsigned short>(20, x) - 1; };
  EXPECT_EQ(graph.hops(at(20), at(100)), 2);
  EXPECT_GE(graph.walk(at(20), at(100)), 39);  // from border to border through the room between
  EXPECT_LE(graph.walk(at(20), at(100)), 121);
  EXPECT_NEAR(graph.importance.sum(), 1, 1e-9);
  EXPECT_NEAR(graph.area.sum(), 1, 1e-9);
  EXPECT_EQ(graph.beside[static_cast<size_t>(at(60))].size(), 2u);
}

TEST(RegionGraph, GivesRoomsWithoutAWayTheStraightLineAndADetour) {
  cv::Mat rooms(40, 140, CV_16UC1, cv::Scalar(0));
  rooms(cv::Rect(5, 5, 31, 31)).setTo(1);
  rooms(cv::Rect(100, 5, 31, 31)).setTo(2);
  const RegionGraph graph = make_region_graph(*segmentation_from_labels(rooms));
  EXPECT_EQ(graph.hops(0, 1), 2);
  EXPECT_NEAR(graph.walk(0, 1), 1.5 * 95, 6);
}

}  // namespace
}  // namespace smokemap
