#include "simulation/path_driver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A field of 20 x 20 m with a fence around it.
SegmentWorld field() {
  return SegmentWorld({{{{0, 0}, {20, 0}}}, {{{20, 0}, {20, 20}}}, {{{20, 20}, {0, 20}}}, {{{0, 20}, {0, 0}}}});
}

double length_of(const std::vector<Point2>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

TEST(PathDriver, TakesTheShortestWayOfAKingInTheOpen) {
  const PathDriver driver(field());
  auto random = random_stream(41, 1);
  for (int i = 0; i < 60; ++i) {
    // Cell centres of 0.1 m, so that the way over the grid is the whole way: diagonal steps, then straight ones.
    const auto place = [&] { return 0.05 + 0.1 * (20.0 + static_cast<double>(uniform_index(random, 160))); };
    const Point2 from(place(), place()), to(place(), place());
    const auto path = driver.plan(from, to);
    ASSERT_THAT(path, test::IsOk());
    const Point2 way = (to - from).cwiseAbs();
    EXPECT_NEAR(length_of(*path), way.maxCoeff() + (std::sqrt(2.0) - 1) * way.minCoeff(), 1e-6);
    EXPECT_EQ(path->front(), from);
    EXPECT_EQ(path->back(), to);
  }
}

TEST(PathDriver, GoesAsFarThereAsBackAndNeverThroughAWall) {
  for (std::uint64_t seed = 50; seed < 53; ++seed) {
    std::mt19937_64 random(seed);
    const auto plan = random_building({}, random);
    ASSERT_THAT(plan, test::IsOk());
    const SegmentWorld world = build_world(*plan);
    const PathDriver driver(world);
    for (int i = 0; i < 6; ++i) {
      const auto room = [&] {
        return centroid(plan->outline(static_cast<int>(uniform_index(random, plan->rooms.size()))));
      };
      const Point2 from = room(), to = room();
      const auto there = driver.plan(from, to), back = driver.plan(to, from);
      if (!there) continue;
      ASSERT_THAT(back, test::IsOk());
      EXPECT_NEAR(length_of(*there), length_of(*back), 0.06 * length_of(*there) + 0.2);
      EXPECT_GE(length_of(*there), (to - from).norm() - 1e-9);
      for (std::size_t k = 1; k < there->size(); ++k) {
        EXPECT_TRUE(world.sees((*there)[k - 1], (*there)[k]));
        EXPECT_GT(world.clearance_m((*there)[k], 1), 0.25);
      }
    }
  }
}

TEST(PathDriver, HasNoWayThroughAShutDoorOrOutOfTheWorld) {
  FloorPlan plan = two_room_building();
  plan.doors[0].has_leaf = true;
  SegmentWorld world = build_world(plan);
  EXPECT_THAT(PathDriver(world).plan({2, 2}, {6, 2}), test::Fails(Errc::kDegenerate));
  world.set_door(0, kPi / 2);
  const PathDriver driver(world);
  EXPECT_THAT(driver.plan({2, 2}, {6, 2}), test::IsOk());
  for (const Point2& nowhere : {Point2(100, 2), Point2(-100, 2), Point2(4, 3.5), Point2(0.05, 0.05)})
    EXPECT_THAT(driver.plan({2, 2}, nowhere), test::Fails(Errc::kDegenerate)) << nowhere.transpose();
  EXPECT_THAT(driver.plan({100, 2}, {2, 2}), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(driver.plan({2, 0.3}, {6, 2}), test::IsOk()) << "a robot too near to a wall may leave it";
}

TEST(PathDriver, VisitsWhatItCanReachAndLeavesOutTheRest) {
  PathDriver driver(build_world(two_room_building()));
  EXPECT_TRUE(driver.done());
  EXPECT_EQ(driver.visit({2, 2}, {{6, 2}, {50, 50}, {1, 1}}), 2u);
  EXPECT_FALSE(driver.done());
  EXPECT_EQ(driver.visit({2, 2}, {{50, 50}}), 0u);
  EXPECT_TRUE(driver.done()) << "a new order forgets the old one";
  const VelocityCommand still = driver.drive({2, 2, 0});
  EXPECT_EQ(still.speed_mps, 0);
  EXPECT_EQ(still.turn_rate_radps, 0);
}

TEST(PathDriver, SteersARobotWithoutInertiaToEveryPlaceWithinItsLimits) {
  const PathDriverParams params;
  auto random = random_stream(42, 1);
  for (int round = 0; round < 20; ++round) {
    PathDriver driver(field(), params);
    const auto place = [&] { return Point2(uniform(random, 2, 18), uniform(random, 2, 18)); };
    const Point2 goal = place();
    Pose2 pose(place(), uniform(random, -kPi, kPi));
    ASSERT_EQ(driver.visit(pose.translation(), {goal}), 1u);
    int steps = 0;
    for (; steps < 20'000 && !driver.done(); ++steps) {
      const VelocityCommand command = driver.drive(pose);
      ASSERT_LE(std::abs(command.turn_rate_radps), params.turn_rate_radps);
      ASSERT_GE(command.speed_mps, 0) << "it never drives backwards";
      ASSERT_LE(command.speed_mps, params.speed_mps);
      pose = pose * Pose2(command.speed_mps * 0.02, 0, command.turn_rate_radps * 0.02);
    }
    EXPECT_LT((pose.translation() - goal).norm(), params.arrive_m + 0.02);
  }
}

TEST(PathDriver, TurnsOnTheSpotTowardsWhatLiesBehind) {
  PathDriver driver(field());
  ASSERT_EQ(driver.visit({10, 10}, {{5, 10.5}}), 1u);
  const VelocityCommand command = driver.drive({10, 10, 0});
  EXPECT_EQ(command.speed_mps, 0);
  EXPECT_GT(std::abs(command.turn_rate_radps), 0.9);
}

TEST(PathDriverParams, NameWhatIsOutOfRange) {
  const std::vector<std::function<void(PathDriverParams&)>> faults{
      [](PathDriverParams& p) { p.radius_m = 0; },        [](PathDriverParams& p) { p.margin_m = -0.1; },
      [](PathDriverParams& p) { p.cell_m = 0; },          [](PathDriverParams& p) { p.speed_mps = std::nan(""); },
      [](PathDriverParams& p) { p.turn_rate_radps = 9; }, [](PathDriverParams& p) { p.look_ahead_m = 0; },
      [](PathDriverParams& p) { p.arrive_m = 5; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    PathDriverParams params;
    faults[i](params);
    EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument)) << i;
  }
}

TEST(RoomTour, GoesToTheNearestPlaceThatIsLeft) {
  for (std::uint64_t seed = 60; seed < 64; ++seed) {
    std::mt19937_64 random(seed);
    const auto plan = random_building({}, random);
    ASSERT_THAT(plan, test::IsOk());
    const Point2 start = centroid(plan->outline(0));
    const std::vector<Point2> tour = room_tour(*plan, start);
    const auto corridors =
        std::count_if(plan->rooms.begin(), plan->rooms.end(), [](const PlanRoom& r) { return r.corridor; });
    EXPECT_EQ(tour.size(), plan->rooms.size() + static_cast<std::size_t>(corridors)) << "both ends of a corridor";
    Point2 here = start;
    for (std::size_t i = 0; i < tour.size(); ++i) {
      for (std::size_t later = i + 1; later < tour.size(); ++later)
        EXPECT_LE((tour[i] - here).norm(), (tour[later] - here).norm() + 1e-12);
      here = tour[i];
      EXPECT_GE(plan->room_at(here), 0) << here.transpose();
    }
  }
}

TEST(RoomTour, OfNobodyIsEmpty) { EXPECT_TRUE(room_tours(corridor_building(), {}).empty()); }

}  // namespace
}  // namespace smokemap
