#include "topology/thinning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "topology/graph_trace.hpp"
#include "topology/walkable.hpp"

namespace smokemap {
namespace {

cv::Mat random_blobs(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  cv::Mat map(70, 90, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < 8; ++i)
    cv::ellipse(map, {static_cast<int>(uniform(random, 8, 80)), static_cast<int>(uniform(random, 8, 60))},
                {static_cast<int>(uniform(random, 3, 22)), static_cast<int>(uniform(random, 3, 16))},
                uniform(random, 0, 180), 0, 360, cv::Scalar(255), cv::FILLED);
  return map;
}

int parts_of(const cv::Mat& mask, int connectivity) {
  cv::Mat labels;
  return cv::connectedComponents(mask, labels, connectivity) - 1;
}

TEST(FreeClearance, IsTheDistanceToTheNearestObstacleAndTheRimIsOne) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const cv::Mat map = random_blobs(seed), clearance = free_clearance(map);
    for (int y = 0; y < map.rows; y += 7)
      for (int x = 0; x < map.cols; x += 5) {
        double nearest = std::min({x + 1, y + 1, map.cols - x, map.rows - y});
        for (int v = 0; v < map.rows; ++v)
          for (int u = 0; u < map.cols; ++u)
            if (map.at<uchar>(v, u) == 0) nearest = std::min(nearest, std::hypot(u - x, v - y));
        EXPECT_NEAR(clearance.at<float>(y, x), map.at<uchar>(y, x) == 0 ? 0 : nearest, 1e-3);
      }
  }
}

TEST(ThinByClearance, KeepsPartsAndHolesAndIsOnePixelWide) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const cv::Mat map = random_blobs(seed), line = thin_by_clearance(free_clearance(map));
    EXPECT_EQ(cv::countNonZero(line & (map == 0)), 0);
    EXPECT_EQ(parts_of(line, 8), parts_of(map, 8)) << seed;
    cv::Mat outside_line, outside_map;
    cv::copyMakeBorder(line == 0, outside_line, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
    cv::copyMakeBorder(map == 0, outside_map, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
    EXPECT_EQ(parts_of(outside_line, 4), parts_of(outside_map, 4)) << seed;
    for (int y = 0; y + 1 < line.rows; ++y)
      for (int x = 0; x + 1 < line.cols; ++x)
        EXPECT_LT(cv::countNonZero(line(cv::Rect(x, y, 2, 2))), 4) << "a block of four is no line";
  }
}

TEST(TraceLines, WalksNoPixelOfALineTwiceAndNothingElse) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const cv::Mat clearance = free_clearance(random_blobs(seed)), line = thin_by_clearance(clearance);
    const VoronoiGraph graph = trace_lines(line, clearance);
    cv::Mat covered(line.size(), CV_8UC1, cv::Scalar(0));
    for (const VoronoiNode& node : graph.nodes)
      covered.at<uchar>(static_cast<int>(node.p_px.y()), static_cast<int>(node.p_px.x())) = 255;
    for (const VoronoiEdge& edge : graph.edges)
      for (size_t i = 1; i + 1 < edge.path_px.size(); ++i) {
        uchar& pixel = covered.at<uchar>(static_cast<int>(edge.path_px[i].y()), static_cast<int>(edge.path_px[i].x()));
        EXPECT_EQ(pixel, 0) << "walked twice";
        pixel = 255;
      }
    EXPECT_EQ(cv::countNonZero(covered & (line == 0)), 0);
  }
}

TEST(TraceLines, ReadsLengthAndClearanceOffAStraightLine) {
  cv::Mat line(21, 60, CV_8UC1, cv::Scalar(0)), clearance(line.size(), CV_32FC1, cv::Scalar(0));
  for (int x = 5; x <= 45; ++x) {
    line.at<uchar>(10, x) = 255;
    clearance.at<float>(10, x) = x == 20 ? 2.0f : 6.0f;
  }
  const VoronoiGraph graph = trace_lines(line, clearance);
  ASSERT_EQ(graph.nodes.size(), 2u);
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_NEAR(graph.edges[0].length_px, 40, 1e-9);
  EXPECT_EQ(graph.edges[0].min_clearance_px, 2);
  EXPECT_NEAR(graph.edges[0].mean_clearance_px, 6, 0.2);
}

TEST(UsualClearance, IsHalfTheWidthOfCorridorsWhateverTheHall) {
  cv::Mat map(500, 500, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 400, 21)).setTo(255);
  map(cv::Rect(10, 40, 400, 21)).setTo(255);
  EXPECT_NEAR(usual_clearance(free_clearance(map)), 11, 1);
  map(cv::Rect(20, 100, 380, 380)).setTo(255);
  EXPECT_NEAR(usual_clearance(free_clearance(map)), 11, 1);
  EXPECT_EQ(usual_clearance(cv::Mat(9, 9, CV_32FC1, cv::Scalar(0))), 0);
}

TEST(WalkableClearance, LooksThroughChairsAlsoBesideTheWall) {
  cv::Mat empty(220, 260, CV_8UC1, cv::Scalar(0));
  empty(cv::Rect(10, 10, 240, 200)).setTo(255);
  cv::Mat map = empty.clone();
  for (int x = 20; x < 240; x += 20)
    for (const int y : {16, 60, 110, 196}) map(cv::Rect(x, y, 6, 6)).setTo(0);
  EXPECT_LT(cv::norm(walkable_clearance(map, {}), walkable_clearance(empty, {}), cv::NORM_INF), 1e-3);
  const cv::Mat all = walkable_clearance(map, {.clutter_ratio = 0});
  EXPECT_EQ(cv::countNonZero((all > 0) != (map == 255)), 0);
}

}  // namespace
}  // namespace smokemap
