#include "simulation/segment_world.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "simulation/building.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

Point2 random_direction(std::mt19937_64& random) {
  const double angle = uniform(random, -kPi, kPi);
  return {std::cos(angle), std::sin(angle)};
}

SegmentWorld scattered_segments(int count, double size_m, std::mt19937_64& random) {
  std::vector<WorldSegment> segments;
  for (int i = 0; i < count; ++i) {
    const Point2 a(uniform(random, 0, size_m), uniform(random, 0, size_m));
    segments.push_back({{a, a + uniform(random, 0.01, 3) * random_direction(random)}});
  }
  return SegmentWorld(segments);
}

void expect_same_as_force(const SegmentWorld& world, const Point2& origin, const Point2& direction, double limit_m) {
  const auto fast = world.cast(origin, direction, limit_m), slow = cast_by_force(world, origin, direction, limit_m);
  ASSERT_EQ(fast.has_value(), slow.has_value()) << origin.transpose() << " -> " << direction.transpose();
  if (fast) {
    ASSERT_NEAR(fast->range_m, slow->range_m, 1e-9) << origin.transpose() << " -> " << direction.transpose();
  }
}

TEST(SegmentWorld, AgreesWithBruteForceOverAHundredThousandRays) {
  std::mt19937_64 random(1);
  const auto plan = random_building({}, random);
  ASSERT_TRUE(plan.ok());
  const SegmentWorld worlds[] = {build_world(*plan), scattered_segments(600, 30, random),
                                 build_world(slanted_building())};
  for (int ray = 0; ray < 100'000; ++ray) {
    const SegmentWorld& world = worlds[ray % 3];
    const Point2 origin(uniform(random, -5, 35), uniform(random, -5, 25));
    expect_same_as_force(world, origin, random_direction(random), ray % 7 == 0 ? 3.0 : 60.0);
  }
}

TEST(SegmentWorld, AgreesWithBruteForceAlongTheAxesAndFromBucketBorders) {
  std::mt19937_64 random(2);
  const SegmentWorld world = build_world(corridor_building());
  for (int i = 0; i < 4000; ++i) {
    const Point2 origin = 0.05 * Point2(std::round(uniform(random, -20, 300)), std::round(uniform(random, -20, 240)));
    const int way = i % 4;
    expect_same_as_force(world, origin, Point2(way == 0 ? 1 : way == 1 ? -1 : 0, way == 2 ? 1 : way == 3 ? -1 : 0), 40);
  }
}

TEST(SegmentWorld, HitsAWallSquareOnAtItsDistance) {
  const SegmentWorld world({{{{2, -1}, {2, 1}}, Material::kMetal}});
  const auto hit = world.cast({0, 0}, 0.0, 10);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range_m, 2);
  EXPECT_DOUBLE_EQ(hit->cos_incidence, 1);
  EXPECT_EQ(hit->segment, 0);
  const auto slanted = world.cast({0, 0}, kPi / 8, 10);
  ASSERT_TRUE(slanted);
  EXPECT_NEAR(slanted->cos_incidence, std::cos(kPi / 8), 1e-12);
  EXPECT_FALSE(world.cast({0, 0}, 0.0, 1.999));
  EXPECT_FALSE(world.cast({0, 0}, kPi, 10));
  EXPECT_TRUE(world.cast({0, 0}, 0.0, 2.0)) << "the limit itself counts";
}

TEST(SegmentWorld, LetsNothingOutThroughTheCornersOfAClosedRoom) {
  std::mt19937_64 random(3);
  for (int turn = 0; turn < 40; ++turn) {  // rooms that share corners to the bit, turned by any angle
    const Pose2 T(uniform(random, -5, 5), uniform(random, -5, 5), uniform(random, -kPi, kPi));
    const std::vector<Point2> ring{T * Point2(0, 0), T * Point2(4, 0), T * Point2(4, 3), T * Point2(2, 4),
                                   T * Point2(0, 3)};
    std::vector<WorldSegment> segments;
    for (std::size_t i = 0; i < ring.size(); ++i) segments.push_back({{ring[i], ring[(i + 1) % ring.size()]}});
    const SegmentWorld world(segments);
    for (int i = 0; i < 400; ++i) {
      const Point2 origin = T * Point2(uniform(random, 0.1, 3.9), uniform(random, 0.1, 2.9));
      const Point2 aim = ring[static_cast<std::size_t>(i) % ring.size()];
      ASSERT_TRUE(world.cast(origin, Point2((aim - origin).normalized()), 100)) << "at a corner";
      ASSERT_TRUE(world.cast(origin, random_direction(random), 100));
    }
  }
}

TEST(SegmentWorld, KeepsThickWalledBuildingsTight) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 5; ++i) {
    const auto plan = random_building({}, random);
    ASSERT_TRUE(plan.ok());
    const SegmentWorld world = build_world(*plan);
    for (int ray = 0; ray < 4000; ++ray) {
      const auto room = uniform_index(random, plan->rooms.size());
      const Point2 origin = centroid(plan->outline(static_cast<int>(room)));
      const Point2 aim = plan->corners[uniform_index(random, plan->corners.size())];
      const Point2 direction = ray % 2 ? random_direction(random) : Point2((aim - origin).normalized());
      ASSERT_TRUE(world.cast(origin, direction, 100)) << "room " << plan->rooms[room].name << " leaks";
    }
  }
}

TEST(SegmentWorld, SeesWhatNoWallHides) {
  const SegmentWorld world = build_world(two_room_building());
  EXPECT_TRUE(world.sees({2, 1.5}, {6, 1.5})) << "through the door";
  EXPECT_FALSE(world.sees({2, 3}, {6, 3}));
  EXPECT_TRUE(world.sees({2, 3}, {2, 3}));
}

TEST(SegmentWorld, MeasuresClearanceLikeBruteForce) {
  std::mt19937_64 random(5);
  const SegmentWorld world = scattered_segments(200, 20, random);
  for (int i = 0; i < 2000; ++i) {
    const Point2 p(uniform(random, -3, 23), uniform(random, -3, 23));
    double nearest = 0.8;
    for (const WorldSegment& segment : world.segments()) nearest = std::min(nearest, distance(segment.line, p));
    ASSERT_NEAR(world.clearance_m(p, 0.8), nearest, 1e-12);
  }
}

TEST(SegmentWorld, TurnsDoors) {
  SegmentWorld world({{{{0, -5}, {0, -0.5}}}, {{{0, 0.5}, {0, 5}}}}, {DoorLeaf{{0, -0.5}, {0, 0.5}}});
  EXPECT_FALSE(world.sees({-1, 0.2}, {1, 0.2})) << "shut";
  world.set_door(0, kPi / 2);
  EXPECT_TRUE(world.sees({-1, 0.2}, {1, 0.2})) << "open";
  EXPECT_THAT(world.segments().back().line.b, test::IsNearPoint(Point2(-1, -0.5), 1e-12));
  world.set_door(0, 0);
  EXPECT_FALSE(world.sees({-1, 0.2}, {1, 0.2}));
}

TEST(SegmentWorld, IsEmptyWithoutSegments) {
  const SegmentWorld world;
  EXPECT_FALSE(world.cast({0, 0}, 0.3, 100));
  EXPECT_EQ(world.clearance_m({1, 1}, 2), 2);
}

TEST(SegmentWorld, MeetsARayThatRunsAlongASegment) {
  const SegmentWorld world({{{{3, 0}, {5, 0}}}});
  const auto hit = world.cast({1, 0}, Point2(1, 0), 10);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range_m, 2);
  EXPECT_FALSE(world.cast({6, 0}, Point2(1, 0), 10));
}

}  // namespace
}  // namespace smokemap
