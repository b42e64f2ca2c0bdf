#include "topology/voronoi_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"

namespace smokemap {
namespace {

cv::Mat solid(int rows, int cols) { return cv::Mat(rows, cols, CV_8UC1, cv::Scalar(0)); }

int count_kind(const VoronoiGraph& graph, VoronoiNodeKind kind) {
  return static_cast<int>(
      std::count_if(graph.nodes.begin(), graph.nodes.end(), [&](const VoronoiNode& n) { return n.kind == kind; }));
}

int count_parts(const VoronoiGraph& graph) {
  std::vector<int> part(graph.nodes.size());
  std::iota(part.begin(), part.end(), 0);
  for (size_t round = 0; round < graph.nodes.size(); ++round)
    for (const VoronoiEdge& edge : graph.edges) {
      int &one = part[static_cast<size_t>(edge.from)], &two = part[static_cast<size_t>(edge.to)];
      one = two = std::min(one, two);
    }
  int parts = 0;
  for (size_t n = 0; n < part.size(); ++n) parts += part[n] == static_cast<int>(n);
  return parts;
}

/// Free parts (4 neighbours) and the holes in them (8 neighbours).
std::pair<int, int> parts_and_holes(const cv::Mat& free_space) {
  cv::Mat labels, padded;
  const int parts = cv::connectedComponents(free_space, labels, 4) - 1;
  cv::copyMakeBorder(255 - free_space, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  const int solids = cv::connectedComponents(padded, labels, 8) - 1;
  return {parts, solids - 1};
}

TEST(VoronoiGraph, OfACorridorIsOneLineDownItsMiddle) {
  cv::Mat map = solid(60, 220);
  map(cv::Rect(10, 20, 200, 21)).setTo(255);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  ASSERT_EQ(graph->edges.size(), 1u);
  EXPECT_EQ(count_kind(*graph, VoronoiNodeKind::kDeadEnd), 2);
  for (const Point2& p : graph->edges[0].path_px)
    if (p.x() > 30 && p.x() < 190) {
      EXPECT_NEAR(p.y(), 30, 1);
    }
  EXPECT_GT(graph->edges[0].length_px, 170);
  EXPECT_NEAR(graph->edges[0].mean_clearance_px, 11, 1.5);
}

TEST(VoronoiGraph, OfACrossHasOneJunctionAndFourEnds) {
  cv::Mat map = solid(200, 200);
  map(cv::Rect(90, 10, 20, 180)).setTo(255);
  map(cv::Rect(10, 90, 180, 20)).setTo(255);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  EXPECT_EQ(count_kind(*graph, VoronoiNodeKind::kDeadEnd), 4);
  ASSERT_GE(count_kind(*graph, VoronoiNodeKind::kJunction), 1);
  for (const VoronoiNode& node : graph->nodes)
    if (node.kind == VoronoiNodeKind::kJunction) {
      EXPECT_LT((node.p_px - Point2(99.5, 99.5)).norm(), 4);
    }
}

TEST(VoronoiGraph, MeasuresTheDoorOnTheWayBetweenTwoRooms) {
  cv::Mat map = solid(100, 200);
  map(cv::Rect(10, 10, 80, 80)).setTo(255);
  map(cv::Rect(100, 10, 80, 80)).setTo(255);
  map(cv::Rect(90, 40, 10, 15)).setTo(255);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  double narrowest = 1e9;
  for (const VoronoiEdge& edge : graph->edges) narrowest = std::min(narrowest, edge.min_clearance_px);
  EXPECT_LE(narrowest, 8.1);
  EXPECT_EQ(count_parts(*graph), 1);
}

TEST(VoronoiGraph, RunsRoundAnObstacle) {
  cv::Mat map = solid(120, 120);
  cv::circle(map, {60, 60}, 50, cv::Scalar(255), cv::FILLED);
  cv::circle(map, {60, 60}, 20, cv::Scalar(0), cv::FILLED);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->edges.size(), graph->nodes.size());
  EXPECT_EQ(count_kind(*graph, VoronoiNodeKind::kDeadEnd), 0);
}

TEST(VoronoiGraph, HasAPartForEveryPartOfFreeSpaceAndARingForEveryObstacle) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    std::mt19937_64 random(seed);
    cv::Mat map = solid(110, 140);
    for (int i = 0; i < 9; ++i)
      map(cv::Rect(static_cast<int>(uniform(random, 2, 100)), static_cast<int>(uniform(random, 2, 70)),
                   static_cast<int>(uniform(random, 9, 36)), static_cast<int>(uniform(random, 9, 36))))
          .setTo(255);
    const auto graph = voronoi_graph(map, {.trim_ratio = 0.5, .min_clearance_px = 0.5});
    ASSERT_TRUE(graph);
    const auto [parts, holes] = parts_and_holes(map);
    EXPECT_EQ(count_parts(*graph), parts) << "seed " << seed;
    const int rings =
        static_cast<int>(graph->edges.size()) - static_cast<int>(graph->nodes.size()) + count_parts(*graph);
    EXPECT_EQ(rings, holes) << "seed " << seed;
  }
}

TEST(VoronoiGraph, TrimsMoreWhenAskedTo) {
  std::mt19937_64 random(3);
  cv::Mat map = solid(150, 300);
  map(cv::Rect(10, 50, 280, 40)).setTo(255);
  for (int x = 20; x < 280; x += 30) map(cv::Rect(x, 50 - static_cast<int>(uniform(random, 2, 30)), 12, 40)).setTo(255);
  const auto bushy = voronoi_graph(map, {.trim_ratio = 0.05, .min_clearance_px = 1});
  const auto tidy = voronoi_graph(map, {.trim_ratio = 0.8, .min_clearance_px = 1});
  ASSERT_TRUE(bushy && tidy);
  EXPECT_GT(bushy->edges.size(), tidy->edges.size());
  EXPECT_EQ(count_parts(*tidy), 1);
}

TEST(VoronoiGraph, ListsTheEdgesOfEveryNode) {
  cv::Mat map = solid(200, 200);
  map(cv::Rect(90, 10, 20, 180)).setTo(255);
  map(cv::Rect(10, 90, 180, 20)).setTo(255);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  for (size_t n = 0; n < graph->nodes.size(); ++n)
    for (const int e : graph->nodes[n].edges) {
      const VoronoiEdge& edge = graph->edges[static_cast<size_t>(e)];
      EXPECT_TRUE(edge.from == static_cast<int>(n) || edge.to == static_cast<int>(n));
      EXPECT_LE(edge.from, edge.to);
    }
}

TEST(VoronoiGraph, AnswersBadInputWithOneClearError) {
  EXPECT_EQ(voronoi_graph(cv::Mat()).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(voronoi_graph(solid(20, 20)).error().code, Errc::kDegenerate);
  EXPECT_EQ(voronoi_graph(solid(4, 4), {.trim_ratio = -1, .min_clearance_px = 1}).error().code, Errc::kInvalidArgument);
  cv::Mat one = solid(9, 9);
  one.at<unsigned char>(4, 4) = 255;
  const auto graph = voronoi_graph(one);
  ASSERT_TRUE(graph);
  ASSERT_EQ(graph->nodes.size(), 1u);
  EXPECT_EQ(graph->nodes[0].kind, VoronoiNodeKind::kIsolated);
}

}  // namespace
}  // namespace smokemap
