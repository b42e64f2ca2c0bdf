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

/// Neither noise nor clutter is left out: the graph has the exact shape of free space.
VoronoiParams everything() { return {.clutter_ratio = 0, .narrow_ratio = 0, .part_ratio = 0, .min_clearance_px = 0.5}; }

/// Walls that are eaten away, and grow, by up to two pixels.
cv::Mat roughened(const cv::Mat& map, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  cv::Mat rough = map.clone();
  for (int round = 0; round < 2; ++round) {
    cv::Mat grown, shrunk;
    cv::dilate(rough, grown, cv::Mat());
    cv::erode(rough, shrunk, cv::Mat());
    for (int y = 0; y < map.rows; ++y)
      for (int x = 0; x < map.cols; ++x) {
        if (grown.at<uchar>(y, x) != rough.at<uchar>(y, x) && uniform01(random) < 0.2) rough.at<uchar>(y, x) = 255;
        if (shrunk.at<uchar>(y, x) != rough.at<uchar>(y, x) && uniform01(random) < 0.2) rough.at<uchar>(y, x) = 0;
      }
  }
  return rough;
}

/// A corridor with a room at either side of it, and one at its end.
cv::Mat small_floor() {
  cv::Mat map = solid(260, 420);
  map(cv::Rect(20, 110, 260, 40)).setTo(255);
  map(cv::Rect(60, 14, 90, 90)).setTo(255), map(cv::Rect(96, 104, 18, 6)).setTo(255);
  map(cv::Rect(160, 156, 90, 90)).setTo(255), map(cv::Rect(196, 150, 18, 6)).setTo(255);
  map(cv::Rect(290, 80, 110, 100)).setTo(255), map(cv::Rect(280, 120, 10, 20)).setTo(255);
  return map;
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
  EXPECT_NEAR(graph->edges[0].length_px, 179, 3);  // ends half a width before the walls
  EXPECT_NEAR(graph->edges[0].mean_clearance_px, 11, 1.5);
}

TEST(VoronoiGraph, OfACrossHasOneJunctionAndFourEnds) {
  cv::Mat map = solid(200, 200);
  map(cv::Rect(90, 10, 20, 180)).setTo(255);
  map(cv::Rect(10, 90, 180, 20)).setTo(255);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  EXPECT_EQ(count_kind(*graph, VoronoiNodeKind::kDeadEnd), 4);
  ASSERT_EQ(count_kind(*graph, VoronoiNodeKind::kJunction), 1);
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
    const auto graph = voronoi_graph(map, everything());
    ASSERT_TRUE(graph);
    const auto [parts, holes] = parts_and_holes(map);
    EXPECT_EQ(count_parts(*graph), parts) << "seed " << seed;
    const int rings =
        static_cast<int>(graph->edges.size()) - static_cast<int>(graph->nodes.size()) + count_parts(*graph);
    EXPECT_EQ(rings, holes) << "seed " << seed;
  }
}

TEST(VoronoiGraph, OfATeeHasOneJunctionAndThreeEnds) {
  cv::Mat map = solid(160, 240);
  map(cv::Rect(20, 20, 200, 24)).setTo(255);
  map(cv::Rect(108, 44, 24, 100)).setTo(255);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  ASSERT_EQ(graph->edges.size(), 3u);
  EXPECT_EQ(count_kind(*graph, VoronoiNodeKind::kDeadEnd), 3);
  for (const VoronoiNode& node : graph->nodes) {
    if (node.kind == VoronoiNodeKind::kJunction) {
      EXPECT_LT((node.p_px - Point2(119.5, 32)).norm(), 5);
    }
  }
}

TEST(VoronoiGraph, OfALoopOfCorridorsIsARing) {
  cv::Mat map = solid(200, 260);
  map(cv::Rect(20, 20, 220, 160)).setTo(255);
  map(cv::Rect(50, 50, 160, 100)).setTo(0);
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  ASSERT_EQ(graph->nodes.size(), 1u);
  EXPECT_EQ(graph->nodes[0].kind, VoronoiNodeKind::kLoop);
  ASSERT_EQ(graph->edges.size(), 1u);
  EXPECT_NEAR(graph->edges[0].length_px, 2 * (190 + 130), 60);
  EXPECT_NEAR(graph->edges[0].min_clearance_px, 15, 1.1);
}

TEST(VoronoiGraph, OfARoomWithAPillarGoesRoundItAndOfOneWithAChairDoesNot) {
  for (const int side : {60, 8}) {
    cv::Mat map = solid(240, 240);
    map(cv::Rect(20, 20, 200, 200)).setTo(255);
    map(cv::Rect(120 - side / 2, 120 - side / 2, side, side)).setTo(0);
    const auto graph = voronoi_graph(map);
    ASSERT_TRUE(graph);
    const int rings = static_cast<int>(graph->edges.size()) - static_cast<int>(graph->nodes.size()) + 1;
    EXPECT_EQ(rings, side == 60 ? 1 : 0);
  }
}

TEST(VoronoiGraph, EndsInTheMiddleOfARoomAndNotInItsCorner) {
  const auto graph = voronoi_graph(small_floor());
  ASSERT_TRUE(graph);
  for (const Point2& middle : {Point2(104.5, 58.5), Point2(204.5, 200.5), Point2(344.5, 129.5)}) {
    const bool is_there = std::any_of(graph->nodes.begin(), graph->nodes.end(), [&](const VoronoiNode& node) {
      return node.kind == VoronoiNodeKind::kDeadEnd && (node.p_px - middle).norm() < 12;
    });
    EXPECT_TRUE(is_there) << middle.transpose();
  }
  EXPECT_EQ(graph->edges.size() + 1, graph->nodes.size());
}

TEST(VoronoiGraph, OfNoisyWallsIsThatOfCleanOnes) {
  const auto clean = voronoi_graph(small_floor());
  ASSERT_TRUE(clean);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const auto noisy = voronoi_graph(roughened(small_floor(), seed));
    ASSERT_TRUE(noisy);
    EXPECT_EQ(noisy->nodes.size(), clean->nodes.size()) << "seed " << seed;
    EXPECT_EQ(noisy->edges.size(), clean->edges.size()) << "seed " << seed;
  }
}

TEST(VoronoiGraph, TurnsWithThePicture) {
  cv::Mat turned;
  cv::rotate(small_floor(), turned, cv::ROTATE_90_CLOCKWISE);
  const auto upright = voronoi_graph(small_floor()), sideways = voronoi_graph(turned);
  ASSERT_TRUE(upright && sideways);
  EXPECT_EQ(upright->edges.size(), sideways->edges.size());
  ASSERT_EQ(upright->nodes.size(), sideways->nodes.size());
  for (const VoronoiNode& node : upright->nodes) {
    const Point2 there(turned.cols - 1 - node.p_px.y(), node.p_px.x());
    double nearest = 1e9;
    for (const VoronoiNode& other : sideways->nodes)
      if (other.kind == node.kind) nearest = std::min(nearest, (other.p_px - there).norm());
    EXPECT_LT(nearest, 4);
  }
}

TEST(VoronoiGraph, GrowsWithThePicture) {
  cv::Mat tripled;
  cv::resize(small_floor(), tripled, {}, 3, 3, cv::INTER_NEAREST);
  const auto small = voronoi_graph(small_floor()), large = voronoi_graph(tripled);
  ASSERT_TRUE(small && large);
  ASSERT_EQ(small->edges.size(), large->edges.size());
  double small_sum = 0, large_sum = 0;
  for (const VoronoiEdge& edge : small->edges) small_sum += edge.length_px;
  for (const VoronoiEdge& edge : large->edges) large_sum += edge.length_px;
  EXPECT_NEAR(large_sum / small_sum, 3, 0.15);
}

TEST(VoronoiGraph, DoesNotCareForALargeHallElsewhere) {
  cv::Mat with_hall = solid(900, 900);
  small_floor().copyTo(with_hall(cv::Rect(0, 0, 420, 260)));
  with_hall(cv::Rect(20, 300, 860, 580)).setTo(255);
  const auto alone = voronoi_graph(small_floor()), beside = voronoi_graph(with_hall);
  ASSERT_TRUE(alone && beside);
  const auto above = std::count_if(beside->nodes.begin(), beside->nodes.end(),
                                   [](const VoronoiNode& node) { return node.p_px.y() < 280; });
  EXPECT_EQ(static_cast<size_t>(above), alone->nodes.size());
}

TEST(VoronoiGraph, LeavesOutRaysAndSpecksOfALaserMap) {
  cv::Mat map = small_floor();
  cv::line(map, {280, 130}, {419, 10}, cv::Scalar(255), 1);
  for (int x = 10; x < 400; x += 20) map(cv::Rect(x, 2, 2, 2)).setTo(255);
  const auto clean = voronoi_graph(small_floor()), noisy = voronoi_graph(map);
  ASSERT_TRUE(clean && noisy);
  EXPECT_EQ(clean->nodes.size(), noisy->nodes.size());
}

TEST(VoronoiGraph, ClearanceIsTheDistanceToTheNearestWall) {
  const cv::Mat map = small_floor();
  const auto graph = voronoi_graph(map, everything());
  ASSERT_TRUE(graph);
  for (const VoronoiNode& node : graph->nodes) {
    double nearest = 1e9;
    for (int y = 0; y < map.rows; ++y)
      for (int x = 0; x < map.cols; ++x)
        if (map.at<uchar>(y, x) == 0) nearest = std::min(nearest, (Point2(x, y) - node.p_px).norm());
    EXPECT_NEAR(node.clearance_px, nearest, 1e-3);
  }
}

TEST(VoronoiGraph, EdgesAreUnbrokenPathsThroughFreeSpaceBetweenTheirNodes) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const cv::Mat map = roughened(small_floor(), seed);
    const auto graph = voronoi_graph(map, everything());
    ASSERT_TRUE(graph);
    for (const VoronoiEdge& edge : graph->edges) {
      EXPECT_EQ(edge.path_px.front(), graph->nodes[static_cast<size_t>(edge.from)].p_px);
      EXPECT_EQ(edge.path_px.back(), graph->nodes[static_cast<size_t>(edge.to)].p_px);
      EXPECT_LE(edge.min_clearance_px, edge.mean_clearance_px);
      double length = 0;
      for (size_t i = 0; i < edge.path_px.size(); ++i) {
        const Point2& p = edge.path_px[i];
        EXPECT_EQ(map.at<uchar>(static_cast<int>(p.y()), static_cast<int>(p.x())), 255);
        if (i > 0) length += (p - edge.path_px[i - 1]).norm();
      }
      EXPECT_NEAR(edge.length_px, length, 1e-9);
    }
  }
}

TEST(VoronoiGraph, GivesTheSameGraphTwice) {
  const cv::Mat map = roughened(small_floor(), 5);
  const auto one = voronoi_graph(map), two = voronoi_graph(map);
  ASSERT_EQ(one->edges.size(), two->edges.size());
  for (size_t e = 0; e < one->edges.size(); ++e) EXPECT_EQ(one->edges[e].path_px, two->edges[e].path_px);
}

TEST(VoronoiGraph, OfSpeckleIsFoundInTime) {
  std::mt19937_64 random(4);
  cv::Mat map = solid(400, 400);
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x)
      if (uniform01(random) < 0.7) map.at<uchar>(y, x) = 255;
  EXPECT_TRUE(voronoi_graph(map));
  const auto all = voronoi_graph(map, everything());  // a ring for each speck once took time with the square of them
  ASSERT_TRUE(all);
  EXPECT_GT(all->edges.size(), 1000u);
}

TEST(VoronoiGraph, IsDrawnOverTheMap) {
  const cv::Mat map = small_floor();
  const auto graph = voronoi_graph(map);
  ASSERT_TRUE(graph);
  const cv::Mat picture = draw_voronoi_graph(*graph, map);
  EXPECT_EQ(picture.size(), map.size());
  EXPECT_EQ(picture.type(), CV_8UC3);
  for (const VoronoiNode& node : graph->nodes)
    EXPECT_NE(picture.at<cv::Vec3b>(static_cast<int>(node.p_px.y()), static_cast<int>(node.p_px.x())),
              cv::Vec3b(236, 236, 236));
}

TEST(VoronoiGraph, TrimsMoreWhenAskedTo) {
  std::mt19937_64 random(3);
  cv::Mat map = solid(150, 300);
  map(cv::Rect(10, 50, 280, 40)).setTo(255);
  for (int x = 20; x < 280; x += 30) map(cv::Rect(x, 50 - static_cast<int>(uniform(random, 5, 45)), 12, 60)).setTo(255);
  const auto bushy = voronoi_graph(map, {.trim_ratio = 0.05});
  const auto tidy = voronoi_graph(map, {.trim_ratio = 1.5});
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
  EXPECT_EQ(voronoi_graph(cv::Mat(9000, 9000, CV_8UC1)).error().code, Errc::kTooLarge);
  EXPECT_EQ(voronoi_graph(solid(4, 4), {.trim_ratio = -1}).error().code, Errc::kInvalidArgument);
  cv::Mat one = solid(9, 9);
  one.at<unsigned char>(4, 4) = 255;
  const auto graph = voronoi_graph(one);
  ASSERT_TRUE(graph);
  ASSERT_EQ(graph->nodes.size(), 1u);
  EXPECT_EQ(graph->nodes[0].kind, VoronoiNodeKind::kIsolated);
}

}  // namespace
}  // namespace smokemap
