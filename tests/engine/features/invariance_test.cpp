#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random.hpp"
#include "features/corners.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// An L-shaped room, every face seen from inside.
std::vector<PosedHit> l_shaped_room(std::uint64_t seed) {
  auto random = random_stream(seed, 1);
  const std::vector<Point2> ring{{0, 0}, {6, 0}, {6, 3}, {3, 3}, {3, 6}, {0, 6}};
  std::vector<PosedHit> hits;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Segment2 wall{ring[i], ring[(i + 1) % ring.size()]};
    for (double s = 0; s < wall.length(); s += 0.04)
      hits.push_back({wall.a + s * wall.direction() + normal(random, 0.01) * wall.normal(), {1.5, 1.5}});
  }
  return hits;
}

std::vector<Corner> corners_of(const std::vector<PosedHit>& hits) { return find_corners(find_wall_lines(hits)); }

const Corner* at(const std::vector<Corner>& corners, const Point2& place) {
  const auto found =
      std::find_if(corners.begin(), corners.end(), [&](const Corner& c) { return (c.position - place).norm() < 0.1; });
  return found == corners.end() ? nullptr : &*found;
}

TEST(CornersOfAnLShapedRoom, AreSixOfWhichOneOpensByThreeQuarters) {
  const auto corners = corners_of(l_shaped_room(1));
  ASSERT_EQ(corners.size(), 6u);
  const Corner* edge = at(corners, {3, 3});
  ASSERT_NE(edge, nullptr);
  EXPECT_NEAR(edge->opening_rad, 1.5 * kPi, 0.1);
  EXPECT_NEAR(wrap_angle(edge->orientation_rad + 0.75 * kPi), 0, 0.1) << "it looks to where the robot stood";
  EXPECT_EQ(std::count_if(corners.begin(), corners.end(), [](const Corner& c) { return c.opening_rad < kPi; }), 5);
}

TEST(CornersOfAnLShapedRoom, MoveAndTurnWithTheWorld) {
  const auto hits = l_shaped_room(2);
  const auto here = corners_of(hits);
  auto random = random_stream(2, 2);
  for (int round = 0; round < 10; ++round) {
    const Pose2 T(uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -kPi, kPi));
    std::vector<PosedHit> there;
    for (const PosedHit& hit : hits) there.push_back({T * hit.point, T * hit.seen_from});
    const auto moved = corners_of(there);
    ASSERT_EQ(moved.size(), here.size());
    for (const Corner& c : here) {
      const Corner* same = at(moved, T * c.position);
      ASSERT_NE(same, nullptr);
      EXPECT_NEAR(same->opening_rad, c.opening_rad, 0.05);
      EXPECT_NEAR(wrap_angle(same->orientation_rad - c.orientation_rad - T.heading()), 0, 0.05);
      EXPECT_NEAR(same->covariance.trace(), c.covariance.trace(), 0.3 * c.covariance.trace());
    }
  }
}

TEST(CornersOfAnLShapedRoom, AreMirroredWithTheWorld) {
  const auto hits = l_shaped_room(3);
  std::vector<PosedHit> mirrored;
  for (const PosedHit& hit : hits)
    mirrored.push_back({{-hit.point.x(), hit.point.y()}, {-hit.seen_from.x(), hit.seen_from.y()}});
  const auto here = corners_of(hits), there = corners_of(mirrored);
  ASSERT_EQ(there.size(), here.size());
  for (const Corner& c : here) {
    const Corner* same = at(there, {-c.position.x(), c.position.y()});
    ASSERT_NE(same, nullptr);
    EXPECT_NEAR(same->opening_rad, c.opening_rad, 0.05);
    EXPECT_NEAR(wrap_angle(same->orientation_rad - (kPi - c.orientation_rad)), 0, 0.05);
  }
}

TEST(CornersOfAnLShapedRoom, DoNotDependOnTheOrderOfTheHits) {
  auto hits = l_shaped_room(4);
  const auto here = corners_of(hits);
  auto random = random_stream(4, 4);
  for (std::size_t i = hits.size(); i > 1; --i) std::swap(hits[i - 1], hits[uniform_index(random, i)]);
  const auto shuffled = corners_of(hits);
  ASSERT_EQ(shuffled.size(), here.size());
  for (const Corner& c : here) EXPECT_NE(at(shuffled, c.position), nullptr);
}

TEST(WallLines, LeaveOutHitsThatAreNowhere) {
  auto hits = l_shaped_room(5);
  const auto clean = find_wall_lines(hits);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Point2& nowhere :
       {Point2(nan, 1), Point2(1, inf), Point2(-inf, nan), Point2(1e300, 0), Point2(0, -1e12)}) {
    hits.insert(hits.begin() + 7, {nowhere, {1.5, 1.5}});
    hits.push_back({{1, 1}, nowhere});
  }
  const auto walls = find_wall_lines(hits);
  ASSERT_EQ(walls.size(), clean.size());
  for (std::size_t i = 0; i < walls.size(); ++i) {
    EXPECT_EQ(walls[i].segment.a, clean[i].segment.a);
    EXPECT_EQ(walls[i].support, clean[i].support);
  }
}

TEST(Corners, OfNoWallsOrOneAreNone) {
  EXPECT_TRUE(find_corners({}).empty());
  const auto walls = find_wall_lines(l_shaped_room(6));
  EXPECT_TRUE(find_corners({walls.front()}).empty());
  EXPECT_TRUE(find_corners({walls.front(), walls.front()}).empty()) << "the same wall twice";
}

}  // namespace
}  // namespace smokemap
