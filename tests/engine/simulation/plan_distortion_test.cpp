#include "simulation/plan_distortion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

FloorPlan building_of(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  auto plan = random_building({}, random);
  EXPECT_TRUE(plan.ok());
  return *plan;
}

TEST(PlanDistortion, PutsEveryCornerWhereTheWarpSaysWhenThereIsNoJitter) {
  const FloorPlan building = building_of(1);
  std::mt19937_64 random(2);
  PlanDistortionParams params;
  params.sigma_corner_m = 0;
  params.missing_walls = 3;
  params.phantom_walls = 2;
  params.turn_rad = 0.3;
  params.scale = 1.7;
  const auto plan = distort(building, params, random);
  ASSERT_THAT(plan, test::IsOk());
  ASSERT_EQ(plan->corner_world.size(), plan->drawn.corners.size());
  for (std::size_t i = 0; i < plan->drawn.corners.size(); ++i)
    EXPECT_THAT(plan->drawn.corners[i], test::IsNearPoint(plan->warp(plan->corner_world[i]), 1e-9));
}

TEST(PlanDistortion, WarpIsUndoneExactly) {
  const FloorPlan building = building_of(3);
  std::mt19937_64 random(4);
  PlanDistortionParams params;
  params.turn_rad = -1.1;
  params.scale = 0.6;
  const auto plan = distort(building, params, random);
  ASSERT_THAT(plan, test::IsOk());
  for (int i = 0; i < 500; ++i) {
    const Point2 p(uniform(random, -10, 40), uniform(random, -10, 30));
    EXPECT_THAT(plan->warp.inverse(plan->warp(p)), test::IsNearPoint(p, 1e-9));
  }
}

TEST(PlanDistortion, StretchesLocallyByAboutTheAskedShare) {
  const FloorPlan building = building_of(5);
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    const auto plan = distort(building, {}, random);
    ASSERT_THAT(plan, test::IsOk());
    for (double x = 0.5; x < 29; x += 1) {
      const double local = (plan->warp(Point2(x + 0.01, 5)) - plan->warp(Point2(x, 5))).x() / 0.01;
      EXPECT_GE(local, 1 - 0.25 - 1e-6);
      EXPECT_LE(local, 1 + 0.25 + 1e-6);
      squares += (local - 1) * (local - 1);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.10, 0.01);
}

TEST(PlanDistortion, KnowsTheTrueWallBehindEveryDrawnOne) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const FloorPlan building = building_of(seed);
    std::mt19937_64 random(seed + 100);
    PlanDistortionParams params;
    params.missing_walls = 2;
    params.phantom_walls = 2;
    const auto plan = distort(building, params, random);
    ASSERT_THAT(plan, test::IsOk());
    EXPECT_EQ(plan->missing.size(), 2u);
    ASSERT_EQ(plan->wall_source.size(), plan->drawn.walls.size());
    int phantoms = 0;
    std::vector<double> drawn_length(building.walls.size(), 0.0);
    for (std::size_t i = 0; i < plan->wall_source.size(); ++i) {
      const PlanWall& wall = plan->drawn.walls[i];
      const Segment2 truth{plan->corner_world[static_cast<std::size_t>(wall.corner_a)],
                           plan->corner_world[static_cast<std::size_t>(wall.corner_b)]};
      if (plan->wall_source[i] < 0) {
        ++phantoms;
        EXPECT_GE(truth.length(), params.min_wall_m - 0.01);
        continue;
      }
      const Segment2 source = building.wall_line(plan->wall_source[i]);
      EXPECT_LT(distance(source, truth.a), 1e-9);
      EXPECT_LT(distance(source, truth.b), 1e-9);
      drawn_length[static_cast<std::size_t>(plan->wall_source[i])] += truth.length();
    }
    EXPECT_EQ(phantoms, 2);
    for (std::size_t i = 0; i < building.walls.size(); ++i) {
      const bool missing = std::count(plan->missing.begin(), plan->missing.end(), static_cast<int>(i)) > 0;
      EXPECT_NEAR(drawn_length[i], missing ? 0 : building.wall_line(static_cast<int>(i)).length(), 1e-9);
    }
  }
}

TEST(PlanDistortion, DividesAndJoinsRoomsAsDrawn) {
  const FloorPlan building = building_of(7);
  std::mt19937_64 random(8);
  PlanDistortionParams params;
  params.sigma_stretch = 0;
  params.sigma_corner_m = 0;
  params.missing_walls = 3;
  params.phantom_walls = 1;
  const auto plan = distort(building, params, random);
  ASSERT_THAT(plan, test::IsOk());
  EXPECT_EQ(plan->drawn.rooms.size(), building.rooms.size() - 3 + 1);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) before += signed_area(building.outline(static_cast<int>(i)));
  for (std::size_t i = 0; i < plan->drawn.rooms.size(); ++i)
    after += signed_area(plan->drawn.outline(static_cast<int>(i)));
  EXPECT_NEAR(after, before, 1e-6);
}

TEST(PlanDistortion, KeepsDoorsInTheirWalls) {
  const FloorPlan building = building_of(9);
  std::mt19937_64 random(10);
  PlanDistortionParams params;
  params.sigma_corner_m = 0;
  params.phantom_walls = 3;
  const auto plan = distort(building, params, random);
  ASSERT_THAT(plan, test::IsOk());
  EXPECT_EQ(plan->drawn.doors.size(), building.doors.size());
  for (const PlanDoor& door : plan->drawn.doors) {
    EXPECT_GT(door.from, 0);
    EXPECT_GT(door.to, door.from);
    EXPECT_LT(door.to, 1);
  }
  const int phantom = static_cast<int>(plan->drawn.walls.size()) - 1;
  EXPECT_TRUE(std::none_of(plan->drawn.doors.begin(), plan->drawn.doors.end(),
                           [&](const PlanDoor& door) { return door.wall == phantom; }));
}

TEST(PlanDistortion, IsTheSameForASeed) {
  const FloorPlan building = building_of(11);
  std::mt19937_64 one(12), other(12);
  PlanDistortionParams params;
  params.missing_walls = params.phantom_walls = 2;
  EXPECT_EQ(distort(building, params, one)->drawn.corners, distort(building, params, other)->drawn.corners);
}

TEST(PlanDistortion, RefusesNonsense) {
  std::mt19937_64 random(1);
  PlanDistortionParams params;
  params.sigma_stretch = 0.9;
  EXPECT_THAT(distort(two_room_building(), params, random), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(distort(FloorPlan{}, {}, random), test::Fails(Errc::kDegenerate));
}

}  // namespace
}  // namespace smokemap
