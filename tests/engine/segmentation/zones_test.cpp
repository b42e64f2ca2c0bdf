#include "segmentation/zones.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "core/random.hpp"
#include "segmentation/outline.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/segment.hpp"
#include "segmentation/thickness.hpp"

namespace smokemap {
namespace {

/// Blocks of random labels from 0 to 6; 0 is not free.
cv::Mat patchwork(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  cv::Mat labels(36, 48, CV_32SC1, cv::Scalar(0));
  for (int y = 0; y < labels.rows; y += 6)
    for (int x = 0; x < labels.cols; x += 6)
      labels(cv::Rect(x, y, 6, 6)).setTo(static_cast<int>(uniform_index(random, 7)));
  return labels;
}

TEST(ZoneGraph, KnowsAreasAndWhoTouchesWhom) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const cv::Mat labels = patchwork(seed);
    const ZoneGraph graph(labels);
    for (const auto& [id, zone] : graph.zones()) {
      EXPECT_EQ(zone.area, cv::countNonZero(labels == id));
      for (int other = 1; other <= 6; ++other) {
        if (other == id) continue;
        int touching = 0;  // sides, counted one by one
        for (int y = 0; y < labels.rows; ++y)
          for (int x = 0; x < labels.cols; ++x)
            for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
              const cv::Point n = cv::Point(x, y) + step;
              const bool is_inside = n.x >= 0 && n.y >= 0 && n.x < labels.cols && n.y < labels.rows;
              touching += is_inside && labels.at<int>(y, x) == id && labels.at<int>(n) == other;
            }
        const auto contact = zone.contacts.find(other);
        EXPECT_EQ(contact == zone.contacts.end() ? 0 : contact->second.length, touching) << id << ' ' << other;
      }
    }
  }
}

TEST(ZoneGraph, AfterMergingIsThatOfTheMergedLabels) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    cv::Mat labels = patchwork(seed);
    ZoneGraph graph(labels);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 3; ++i) {
      std::vector<int> left;
      for (const auto& [id, zone] : graph.zones()) left.push_back(id);
      const int from = left[uniform_index(random, left.size())], into = left[uniform_index(random, left.size())];
      if (from != into) graph.merge(from, into);
    }
    graph.relabel(labels);
    const ZoneGraph fresh(labels);
    ASSERT_EQ(graph.zones().size(), fresh.zones().size());
    for (const auto& [id, zone] : graph.zones()) {
      const Zone& other = fresh.zones().at(id);
      EXPECT_EQ(zone.area, other.area);
      ASSERT_EQ(zone.contacts.size(), other.contacts.size());
      for (const auto& [neighbour, contact] : zone.contacts) {
        EXPECT_EQ(contact.length, other.contacts.at(neighbour).length);
        EXPECT_EQ(contact.box, other.contacts.at(neighbour).box);
      }
    }
  }
}

TEST(ZoneContact, IsAsWideAsItsBoxButNoWiderThanItsPixels) {
  ZoneContact contact;
  contact.add(cv::Point(10, 10));
  EXPECT_EQ(contact.chord(), 1);
  contact.add(cv::Point(40, 10));
  EXPECT_EQ(contact.chord(), 2);
}

TEST(DrawSegmentation, GivesEachRegionOneColourAndEveryTimeTheSame) {
  cv::Mat map(60, 120, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(5, 5, 50, 50)).setTo(255);
  map(cv::Rect(65, 5, 50, 50)).setTo(255);
  map(cv::Rect(55, 24, 10, 10)).setTo(255);
  const auto result = segment(map);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->regions.size(), 2u);
  const cv::Mat picture = draw_segmentation(*result, map);
  EXPECT_EQ(picture.size(), map.size());
  EXPECT_EQ(cv::countNonZero(picture.reshape(1) != draw_segmentation(*result, map).reshape(1)), 0);
  EXPECT_NE(picture.at<cv::Vec3b>(8, 8), picture.at<cv::Vec3b>(8, 110));
  EXPECT_EQ(picture.at<cv::Vec3b>(8, 8), picture.at<cv::Vec3b>(52, 8));
  EXPECT_EQ(draw_segmentation(*result).size(), map.size());
}

TEST(RegionColour, TellsTheFirstRegionsApart) {
  std::set<std::tuple<int, int, int>> colours;
  for (int label = 1; label <= 40; ++label) {
    const cv::Vec3b colour = region_colour(label);
    colours.insert({colour[0], colour[1], colour[2]});
  }
  EXPECT_EQ(colours.size(), 40u);
}

}  // namespace
}  // namespace smokemap
