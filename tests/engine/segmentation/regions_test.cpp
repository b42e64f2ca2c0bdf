#include "segmentation/regions.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "core/random.hpp"
#include "segmentation/zones.hpp"

namespace smokemap {
namespace {

cv::Mat random_labels(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  cv::Mat labels(24, 30, CV_32SC1, cv::Scalar(0));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      labels.at<int>(y, x) = static_cast<int>(uniform_index(random, static_cast<std::uint64_t>(count + 1)));
  return labels;
}

TEST(ZoneGraph, KeepsAreasAndContactsRightThroughAnyMerging) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    cv::Mat labels = random_labels(seed, 9);
    ZoneGraph graph(labels);
    std::mt19937_64 random(seed);
    for (int step = 0; step < 5; ++step) {
      const int from = graph.zones().begin()->first;
      const auto& contacts = graph.zones().at(from).contacts;
      if (contacts.empty()) break;
      graph.merge(from, contacts.begin()->first);
    }
    graph.relabel(labels);
    const ZoneGraph fresh(labels);
    ASSERT_EQ(graph.zones().size(), fresh.zones().size());
    for (const auto& [id, zone] : fresh.zones()) {
      EXPECT_EQ(graph.zones().at(id).area, zone.area);
      ASSERT_EQ(graph.zones().at(id).contacts.size(), zone.contacts.size());
      for (const auto& [other, contact] : zone.contacts)
        EXPECT_EQ(graph.zones().at(id).contacts.at(other).length, contact.length);
    }
  }
}

TEST(ConnectedRegions, GivesEveryPieceItsOwnNumber) {
  cv::Mat labels(5, 9, CV_32SC1, cv::Scalar(0));
  labels(cv::Rect(0, 0, 3, 5)).setTo(4);
  labels(cv::Rect(6, 0, 3, 5)).setTo(4);
  labels(cv::Rect(3, 2, 3, 1)).setTo(7);
  const cv::Mat pieces = connected_regions(labels);
  EXPECT_NE(pieces.at<int>(0, 0), pieces.at<int>(0, 8));
  EXPECT_NE(pieces.at<int>(2, 4), pieces.at<int>(2, 2));
  EXPECT_EQ(cv::countNonZero((pieces != 0) != (labels != 0)), 0);
}

TEST(SweepCrumbs, GivesCrumbsToTheNearestRegion) {
  cv::Mat labels(20, 40, CV_32SC1, cv::Scalar(0));
  labels(cv::Rect(0, 0, 15, 20)).setTo(1);
  labels(cv::Rect(25, 0, 15, 20)).setTo(2);
  labels(cv::Rect(18, 5, 2, 2)).setTo(3);
  sweep_crumbs(labels, 10);
  EXPECT_EQ(labels.at<int>(5, 18), 1);
}

TEST(SweepCrumbs, KeepsCrumbsWhereThereIsNothingElse) {
  cv::Mat labels(4, 4, CV_32SC1, cv::Scalar(0));
  labels.at<int>(1, 1) = 5;
  sweep_crumbs(labels, 100);
  EXPECT_EQ(labels.at<int>(1, 1), 5);
}

TEST(GrowLabels, ReachesWhatIsConnectedAndLeavesTheRest) {
  cv::Mat free_space(7, 12, CV_8UC1, cv::Scalar(255)), labels(7, 12, CV_32SC1, cv::Scalar(0));
  free_space(cv::Rect(6, 0, 1, 7)).setTo(0);
  labels.at<int>(3, 1) = 9;
  grow_labels(free_space, labels);
  EXPECT_EQ(cv::countNonZero(labels == 9), 42);
  label_rest(free_space, 9, labels);
  EXPECT_EQ(cv::countNonZero(labels == 0), 7);
  EXPECT_GT(labels.at<int>(0, 11), 9);
}

TEST(FindContacts, TellsTwoOpeningsBetweenTheSameRoomsApart) {
  cv::Mat labels(20, 20, CV_32SC1, cv::Scalar(1));
  labels(cv::Rect(10, 0, 10, 20)).setTo(2);
  labels(cv::Rect(9, 6, 2, 8)).setTo(0);
  const std::vector<Contact> contacts = find_contacts(labels);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_EQ(contacts[0].pixels.size(), 12u);
  EXPECT_EQ(contacts[1].pixels.size(), 12u);
}

TEST(DescribeRegions, HandlesAreaCentroidAndKind) {
  cv::Mat labels(40, 120, CV_32SC1, cv::Scalar(0));
  labels(cv::Rect(0, 0, 120, 10)).setTo(3);
  labels(cv::Rect(0, 12, 25, 25)).setTo(8);
  const Segmentation result = describe_regions(labels);
  ASSERT_EQ(result.regions.size(), 2u);
  EXPECT_EQ(result.regions[0].area_px, 1200);
  EXPECT_EQ(result.regions[0].kind, RegionKind::kCorridor);
  EXPECT_EQ(result.regions[1].kind, RegionKind::kRoom);
  EXPECT_NEAR(result.regions[0].centroid_px.x(), 59.5, 1e-9);
  EXPECT_NEAR(result.regions[1].clearance_px, 13, 1.1);
}

}  // namespace
}  // namespace smokemap
