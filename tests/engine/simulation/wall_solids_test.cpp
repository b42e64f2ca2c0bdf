#include "simulation/wall_solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

bool solid_at(const std::vector<WallSolid>& solids, const Point2& p) {
  return std::any_of(solids.begin(), solids.end(), [&](const WallSolid& solid) { return contains(solid.quad(), p); });
}

TEST(WallSolids, FillTheCornersOfARoom) {
  const std::vector<WallSolid> solids = wall_solids(one_room_building());
  ASSERT_EQ(solids.size(), 4u);
  for (const Point2& corner : {Point2(-0.14, -0.14), Point2(6.14, -0.14), Point2(6.14, 4.14), Point2(-0.14, 4.14)})
    EXPECT_TRUE(solid_at(solids, corner)) << corner.transpose();
  EXPECT_FALSE(solid_at(solids, {0.16, 0.16}));
  EXPECT_FALSE(solid_at(solids, {-0.16, -0.16}));
}

TEST(WallSolids, LeaveTheDoorsOpen) {
  const FloorPlan plan = two_room_building();
  const std::vector<WallSolid> solids = wall_solids(plan);
  EXPECT_EQ(solids.size(), plan.walls.size() + 1) << "the door cuts its wall in two";
  EXPECT_FALSE(solid_at(solids, plan.door_gap(0).midpoint()));
  EXPECT_TRUE(solid_at(solids, {4, 3}));
}

TEST(WallSolids, AreCounterClockwiseAndOfTheAskedThickness) {
  const FloorPlan plan = corridor_building();
  const std::vector<double> wide(plan.walls.size(), 0.4);
  for (const WallSolid& solid : wall_solids(plan, wide)) {
    EXPECT_DOUBLE_EQ(solid.half_thickness_m, 0.2);
    EXPECT_NEAR(signed_area(solid.quad()), 0.4 * solid.line.length(), 1e-9);
  }
}

TEST(WallSolids, CoverEveryWallBetweenItsDoors) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    std::mt19937_64 random(seed);
    const auto plan = random_building({}, random);
    ASSERT_THAT(plan, test::IsOk());
    const std::vector<WallSolid> solids = wall_solids(*plan);
    for (std::size_t i = 0; i < plan->walls.size(); ++i)
      for (const Segment2& piece : plan->wall_pieces(static_cast<int>(i)))
        for (const double share : {0.02, 0.3, 0.5, 0.97})
          EXPECT_TRUE(solid_at(solids, piece.a + share * (piece.b - piece.a)));
    for (std::size_t d = 0; d < plan->doors.size(); ++d)
      EXPECT_FALSE(solid_at(solids, plan->door_gap(static_cast<int>(d)).midpoint()));
  }
}

TEST(WallSolids, AreWhereTheWorldIsSolid) {
  std::mt19937_64 random(9);
  auto plan = random_building({}, random);
  ASSERT_THAT(plan, test::IsOk());
  for (PlanDoor& door : plan->doors) door.has_leaf = false;  // the exits are shut
  const std::vector<WallSolid> solids = wall_solids(*plan);
  const SegmentWorld world = build_world(*plan);
  for (int i = 0; i < 3000; ++i) {  // a point in a room sees no face nearer than the solids allow
    const Point2 p(uniform(random, 0, 30), uniform(random, 0, 20));
    if (solid_at(solids, p)) continue;
    double nearest = 0.5;
    for (const WallSolid& solid : solids) {
      const Polygon quad = solid.quad();
      for (std::size_t k = 0; k < 4; ++k) nearest = std::min(nearest, distance({quad[k], quad[(k + 1) % 4]}, p));
    }
    EXPECT_NEAR(world.clearance_m(p, 0.5), nearest, 1e-5);
  }
}

TEST(FloorPlan, CutsWallPiecesAtDoors) {
  const FloorPlan plan = two_room_building();
  const int wall = plan.doors[0].wall;
  const auto pieces = plan.wall_pieces(wall);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_THAT(pieces[0].a, test::IsNearPoint(plan.wall_line(wall).a, 1e-12));
  EXPECT_THAT(pieces[0].b, test::IsNearPoint(plan.door_gap(0).a, 1e-12));
  EXPECT_THAT(pieces[1].a, test::IsNearPoint(plan.door_gap(0).b, 1e-12));
  EXPECT_NEAR(pieces[0].length() + pieces[1].length(), 4 - 1, 1e-12);
}

}  // namespace
}  // namespace smokemap
