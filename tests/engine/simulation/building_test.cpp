#include "simulation/building.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "simulation/path_driver.hpp"
#include "simulation/random_building.hpp"
#include "simulation/wall_solids.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

TEST(WallIn, DrawsASharedWallOnce) {
  const FloorPlan plan = two_room_building();
  EXPECT_EQ(plan.walls.size(), 7u);
  EXPECT_EQ(plan.corners.size(), 6u);
  int inner = 0;
  for (std::size_t i = 0; i < plan.walls.size(); ++i) {
    if (plan.walls[i].outer) continue;
    ++inner;
    const auto [left, right] = plan.rooms_beside(static_cast<int>(i));
    EXPECT_EQ(std::min(left, right), 0);
    EXPECT_EQ(std::max(left, right), 1);
    EXPECT_DOUBLE_EQ(plan.wall_line(static_cast<int>(i)).length(), 4);
  }
  EXPECT_EQ(inner, 1);
}

TEST(WallIn, CutsWallsAtJunctions) {
  const FloorPlan plan = corridor_building();
  for (std::size_t i = 0; i < plan.walls.size(); ++i)
    for (std::size_t k = 0; k < plan.corners.size(); ++k) {
      const PlanWall& wall = plan.walls[i];
      if (static_cast<int>(k) == wall.corner_a || static_cast<int>(k) == wall.corner_b) continue;
      EXPECT_GT(distance(plan.wall_line(static_cast<int>(i)), plan.corners[k]), 1e-3) << "corner inside a wall";
    }
}

TEST(WallIn, RefusesARoomWithoutArea) {
  EXPECT_THAT(wall_in({{"Line", {{0, 0}, {1, 0}}}}), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(wall_in({{"Clockwise", {{0, 0}, {0, 1}, {1, 1}, {1, 0}}}}), test::Fails(Errc::kInvalidArgument));
}

TEST(FloorPlan, FindsTheRoomAroundAPoint) {
  const FloorPlan plan = corridor_building();
  EXPECT_EQ(plan.rooms[static_cast<std::size_t>(plan.room_at({7, 6}))].name, "Corridor");
  EXPECT_EQ(plan.rooms[static_cast<std::size_t>(plan.room_at({8, 9}))].name, "N2");
  EXPECT_EQ(plan.room_at({-1, 6}), -1);
}

TEST(AddDoor, KeepsTheGapClearOfTheCorners) {
  FloorPlan plan = two_room_building();
  ASSERT_THAT(add_door(plan, {4, 3.99}, 0.9, 0.1), test::IsOk());
  const Segment2 gap = plan.door_gap(static_cast<int>(plan.doors.size()) - 1);
  EXPECT_NEAR(gap.length(), 0.9, 1e-9);
  EXPECT_NEAR(std::max(gap.a.y(), gap.b.y()), 4 - 0.15 - 0.1, 1e-9) << "half an outer wall and the jamb";
  EXPECT_THAT(add_door(plan, {4, 3.3}, 0.9), test::Fails(Errc::kConflict));
  EXPECT_THAT(add_door(plan, {2, 2}, 0.9), test::Fails(Errc::kNotFound));
  EXPECT_THAT(add_door(plan, {0, 2}, 5.0), test::Fails(Errc::kDegenerate));
}

TEST(BuildWorld, HasFacesHalfAThicknessFromTheCentreLine) {
  const SegmentWorld world = build_world(one_room_building());
  const auto inside = world.cast({3, 2}, 0.0, 50);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->range_m, 3 - 0.15, 1e-9);
  const auto outside = world.cast({20, 2}, kPi, 50);
  ASSERT_TRUE(outside);
  EXPECT_NEAR(outside->range_m, 20 - 6.15, 1e-9);
}

TEST(BuildWorld, HasNoFaceInsideAWall) {
  std::mt19937_64 random(4);
  const auto plan = random_building({}, random);
  ASSERT_TRUE(plan.ok());
  const SegmentWorld world = build_world(*plan);
  for (std::size_t i = 0; i < plan->corners.size(); ++i)
    EXPECT_GT(world.clearance_m(plan->corners[i], 0.1), 0.06) << "corners are solid";
}

TEST(BuildWorld, OpensTheWallAtADoor) {
  const SegmentWorld world = build_world(two_room_building());
  const auto hit = world.cast({2, 1.5}, 0.0, 50);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 6 - 0.15, 1e-9);
}

TEST(BuildWorld, ClosesAMitredCornerOfSlantedWalls) {
  const FloorPlan plan = slanted_building();
  const SegmentWorld world = build_world(plan);
  for (std::size_t room = 0; room < plan.rooms.size(); ++room)
    for (int i = 0; i < 3600; ++i)
      ASSERT_TRUE(world.cast(centroid(plan.outline(static_cast<int>(room))), i * 2 * kPi / 3600, 100));
}

TEST(BuildWorld, PutsUpLeavesAndFurniture) {
  FloorPlan plan = two_room_building();
  plan.doors[0].has_leaf = true;
  plan.furniture.push_back({{1, 1}, {2, 1}, {2, 2}, {1, 2}});
  SegmentWorld world = build_world(plan);
  ASSERT_EQ(world.doors().size(), 1u);
  EXPECT_FALSE(world.sees({3, 1.5}, {6, 1.5}));
  world.set_door(0, kPi / 2);
  EXPECT_TRUE(world.sees({3, 1.6}, {6, 1.6}));
  EXPECT_FALSE(world.sees({0.5, 1.5}, {2.5, 1.5}));
}

TEST(RandomBuilding, IsTheSameForASeedAndAnotherForTheNext) {
  auto corners = [](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto plan = random_building({}, random);
    return plan.ok() ? plan->corners : std::vector<Point2>{};
  };
  EXPECT_EQ(corners(5), corners(5));
  EXPECT_NE(corners(5), corners(6));
}

TEST(RandomBuilding, GivesARobotAWayIntoEveryRoom) {
  PathDriverParams wide;
  wide.radius_m = 0.30;
  wide.cell_m = 0.08;
  wide.margin_m = 0.02;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    std::mt19937_64 random(seed);
    RandomBuildingParams params;
    params.furniture = seed % 2 ? 8 : 0;
    const auto plan = random_building(params, random);
    ASSERT_THAT(plan, test::IsOk());
    EXPECT_GE(plan->rooms.size(), 15u);
    EXPECT_LE(plan->rooms.size(), 26u);
    const PathDriver driver(build_world(*plan), wide);
    const Point2 start = centroid(plan->outline(0));
    for (std::size_t room = 0; room < plan->rooms.size(); ++room)
      EXPECT_THAT(driver.plan(start, centroid(plan->outline(static_cast<int>(room)))), test::IsOk())
          << "seed " << seed << " room " << plan->rooms[room].name;
  }
}

TEST(RandomBuilding, HasRoomsThatFillItsOutlineWithoutOverlap) {
  for (std::uint64_t seed = 20; seed < 30; ++seed) {
    std::mt19937_64 random(seed);
    const auto plan = random_building({}, random);
    ASSERT_THAT(plan, test::IsOk());
    double outline = 0;  // shoelace over the outer walls: each has its room on one side
    double rooms = 0;
    for (std::size_t i = 0; i < plan->walls.size(); ++i) {
      if (!plan->walls[i].outer) continue;
      Segment2 line = plan->wall_line(static_cast<int>(i));
      if (plan->rooms_beside(static_cast<int>(i)).first < 0) std::swap(line.a, line.b);
      outline += 0.5 * (line.a.x() * line.b.y() - line.a.y() * line.b.x());
    }
    for (std::size_t i = 0; i < plan->rooms.size(); ++i) rooms += signed_area(plan->outline(static_cast<int>(i)));
    EXPECT_NEAR(rooms, outline, 1e-6);
  }
}

TEST(RandomBuilding, RefusesABuildingThatCannotBe) {
  std::mt19937_64 random(1);
  RandomBuildingParams params;
  params.depth_m = 5;
  EXPECT_THAT(random_building(params, random), test::Fails(Errc::kInvalidArgument));
}

/// Nearest border of any thick wall along the ray: what a world made of their union must show from a free place.
double nearest_solid(const std::vector<WallSolid>& solids, const Point2& origin, const Point2& direction) {
  double nearest = 1e9;
  for (const WallSolid& solid : solids) {
    const Polygon quad = solid.quad();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto hit = intersection({origin, origin + 200 * direction}, {quad[k], quad[(k + 1) % 4]});
      if (hit) nearest = std::min(nearest, (*hit - origin).norm());
    }
  }
  return nearest;
}

TEST(BuildWorld, ShowsTheNearestThickWallFromEveryFreePlace) {
  for (std::uint64_t seed = 70; seed < 74; ++seed) {
    std::mt19937_64 random(seed);
    auto plan = random_building({}, random);
    ASSERT_THAT(plan, test::IsOk());
    for (PlanDoor& door : plan->doors) door.has_leaf = false;
    const std::vector<WallSolid> solids = wall_solids(*plan);
    const SegmentWorld world = build_world(*plan);
    for (int i = 0; i < 400; ++i) {
      const auto room = static_cast<int>(uniform_index(random, plan->rooms.size()));
      const Point2 origin = centroid(plan->outline(room));
      const double angle = uniform(random, -kPi, kPi);
      const Point2 direction(std::cos(angle), std::sin(angle));
      const double expected = nearest_solid(solids, origin, direction);
      const auto hit = world.cast(origin, direction, 150);
      if (expected > 150) {
        EXPECT_FALSE(hit) << "out through two doors";
      } else {
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->range_m, expected, 1e-4);
      }
    }
  }
}

TEST(FloorPlan, KnowsTheRoomsOnBothSidesOfEveryWall) {
  for (std::uint64_t seed = 80; seed < 84; ++seed) {
    std::mt19937_64 random(seed);
    const auto plan = random_building({}, random);
    ASSERT_THAT(plan, test::IsOk());
    for (std::size_t i = 0; i < plan->walls.size(); ++i) {
      const auto wall = static_cast<int>(i);
      const Segment2 line = plan->wall_line(wall);
      const auto [left, right] = plan->rooms_beside(wall);
      EXPECT_EQ(plan->room_at(line.midpoint() + 0.05 * line.normal()), left);
      EXPECT_EQ(plan->room_at(line.midpoint() - 0.05 * line.normal()), right);
      EXPECT_EQ(plan->walls[i].outer, std::min(left, right) < 0);
      EXPECT_NE(left, right);
    }
  }
}

TEST(AddDoor, FitsWhereverThereIsRoomAndNowhereElse) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 300; ++i) {
    FloorPlan plan = corridor_building();
    plan.doors.clear();
    const auto wall = static_cast<int>(uniform_index(random, plan.walls.size()));
    const Segment2 line = plan.wall_line(wall);
    const double width = uniform(random, 0.6, 4.5), jamb = uniform(random, 0, 0.3);
    const auto added = add_door(plan, line.a + uniform(random, 0.05, 0.95) * (line.b - line.a), width, jamb);
    if (!added) {
      EXPECT_THAT(added, test::Fails(Errc::kDegenerate));
      EXPECT_GT(width + 2 * jamb + 0.30, line.length()) << "it would have fitted";
      EXPECT_TRUE(plan.doors.empty());
      continue;
    }
    const Segment2 gap = plan.door_gap(0);
    EXPECT_EQ(plan.doors[0].wall, wall);
    EXPECT_NEAR(gap.length(), width, 1e-9);
    EXPECT_GE((gap.a - line.a).norm(), jamb + 0.07 - 1e-9);
    EXPECT_GE((gap.b - line.b).norm(), jamb + 0.07 - 1e-9);
    EXPECT_LT(distance(line, gap.a) + distance(line, gap.b), 1e-9);
  }
}

TEST(RandomBuilding, StandsForEveryParameterThatItAccepts) {
  int built = 0;
  for (std::uint64_t seed = 0; built < 40; ++seed) {
    std::mt19937_64 random(seed);
    RandomBuildingParams params;
    params.length_m = uniform(random, 12, 50);
    params.depth_m = uniform(random, 8, 40);
    params.corridor_m = uniform(random, 1.8, 4);
    params.room_depth_m = uniform(random, 2.5, 8);
    params.min_room_m = uniform(random, 2.2, 5);
    params.max_room_m = params.min_room_m * uniform(random, 1.5, 3);
    params.min_door_m = uniform(random, 0.7, 1.2);
    params.max_door_m = uniform(random, params.min_door_m, 1.6);
    params.split_share = uniform01(random);
    if (!params.validate()) continue;
    ++built;
    const auto plan = random_building(params, random);
    ASSERT_THAT(plan, test::IsOk()) << seed;
    std::vector<bool> reached(plan->rooms.size(), false);  // over doors, from corridor A
    reached[0] = true;
    for (bool more = true; more;) {
      more = false;
      for (const PlanDoor& door : plan->doors) {
        const auto [left, right] = plan->rooms_beside(door.wall);
        if (left < 0 || right < 0) continue;
        const auto one = static_cast<std::size_t>(left), other = static_cast<std::size_t>(right);
        if (reached[one] == reached[other]) continue;
        reached[one] = reached[other] = more = true;
      }
    }
    EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0) << "a room without a way in, seed " << seed;
    for (std::size_t i = 0; i < plan->rooms.size(); ++i) EXPECT_GT(signed_area(plan->outline(static_cast<int>(i))), 1);
  }
}

}  // namespace
}  // namespace smokemap
