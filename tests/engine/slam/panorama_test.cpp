#include "slam/panorama.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/engine/slam/toy_world.hpp"

namespace smokemap {
namespace {

using Sight = Panorama::Sight;

/// A wall at x = 4 from y = -2 to 2, facing the origin.
Panorama wall_ahead(double margin_m = 0.3) {
  Panorama panorama({0, 0}, margin_m);
  for (double y = -2; y <= 2; y += 0.02) panorama.add({4, y}, {-1, 0});
  return panorama;
}

Sight sight_of(const Panorama& panorama, const Point2& p) {
  Point2 normal;
  return panorama.look(p, normal);
}

TEST(Panorama, TellsOnThroughBeforeAndOpen) {
  const Panorama panorama = wall_ahead();
  EXPECT_EQ(sight_of(panorama, {4, 0.5}), Sight::kAgrees);
  EXPECT_EQ(sight_of(panorama, {4.25, 0.5}), Sight::kAgrees);
  EXPECT_EQ(sight_of(panorama, {6, 0.5}), Sight::kThrough);
  EXPECT_EQ(sight_of(panorama, {2, 0.2}), Sight::kBefore);
  EXPECT_EQ(sight_of(panorama, {-4, 0}), Sight::kOpen);
  EXPECT_EQ(sight_of(panorama, {0, 5}), Sight::kOpen);
}

TEST(Panorama, SaysNothingBesideAnEdge) {
  const Panorama panorama = wall_ahead();
  const double edge = std::atan2(2, 4);
  EXPECT_EQ(sight_of(panorama, 8 * Point2(std::cos(edge), std::sin(edge))), Sight::kOpen);
}

TEST(Panorama, KeepsTheNearestOfTwoWalls) {
  Panorama panorama({0, 0}, 0.3);
  for (double y = -3; y <= 3; y += 0.02) {
    panorama.add({6, y}, {-1, 0});
    panorama.add({3, y}, {-1, 0});
  }
  EXPECT_EQ(sight_of(panorama, {6, 0}), Sight::kThrough);
  EXPECT_EQ(sight_of(panorama, {3, 0}), Sight::kAgrees);
}

TEST(Panorama, DoesNotSeeTheBackOfAWallOrItsEdge) {
  Panorama panorama({0, 0}, 0.3);
  for (double y = -2; y <= 2; y += 0.02) panorama.add({4, y}, {1, 0});
  for (double x = 1; x <= 9; x += 0.02) panorama.add({x, 0.01}, {0, -1});
  EXPECT_EQ(sight_of(panorama, {6, 0.5}), Sight::kOpen);
  EXPECT_EQ(sight_of(panorama, {6, 0.01}), Sight::kOpen);
}

TEST(Panorama, NamesTheDirectionOfTheSurfaceThatAgrees) {
  Point2 normal = Point2::Zero();
  ASSERT_EQ(wall_ahead().look({4, 0}, normal), Sight::kAgrees);
  EXPECT_EQ(normal, Point2(-1, 0));
}

/// Rays of a scan among the walls they came from: the brute-force truth is that none passes through.
TEST(Panorama, IsContradictedByNoTrueScanAndByMostThatAreMoved) {
  std::mt19937_64 random(3);
  const auto walls = test::ring_of_corridors();
  const auto sights = [&](const Pose2& at, const Pose2& believed) {
    Panorama panorama(believed.translation(), 0.3);
    for (const Segment2& wall : walls) {
      const Point2 along = wall.b - wall.a;
      const Point2 side = Point2(-along.y(), along.x()).normalized();
      for (double s = 0.005; s < 1; s += 0.02 / along.norm()) {
        const Point2 p = wall.a + s * along;
        panorama.add(p, side.dot(believed.translation() - p) > 0 ? side : Point2(-side));
      }
    }
    const LaserScan scan = test::scan_at(walls, at, 0, random);
    int through = 0, agree = 0;
    for (const Point2& hit : hit_points(scan, {})) {
      const Sight sight = sight_of(panorama, believed * hit);
      through += sight == Sight::kThrough;
      agree += sight == Sight::kAgrees;
    }
    return std::pair(through, agree);
  };
  for (int i = 0; i < 40; ++i) {
    const Pose2 at(uniform(random, 0.5, 13.5), uniform(random, 0.5, 1.5), uniform(random, -kPi, kPi));
    const auto [through, agree] = sights(at, at);
    EXPECT_LE(through, 1);
    EXPECT_GT(agree, 100);
  }
  const Pose2 at(2, 1, 0.3);
  EXPECT_GT(sights(at, Pose2(8, 1, 0.3)).first, 10);
}

}  // namespace
}  // namespace smokemap
