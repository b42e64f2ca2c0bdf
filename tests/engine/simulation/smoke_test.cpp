#include "simulation/smoke.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/random.hpp"
#include "simulation/building.hpp"

namespace smokemap {
namespace {

SmokeField uniform_smoke(const SegmentWorld& world, double per_m) {
  SmokeField smoke(world, {});
  for (int y = 0; y < smoke.frame().height_cells; ++y)
    for (int x = 0; x < smoke.frame().width_cells; ++x) smoke.set_extinction(smoke.frame().center_of({x, y}), per_m);
  return smoke;
}

double total_of(const SmokeField& smoke) {
  return std::accumulate(smoke.extinction().begin(), smoke.extinction().end(), 0.0);
}

TEST(SmokeField, FollowsBeerAndLambertInUniformSmoke) {
  const SmokeField smoke = uniform_smoke(build_world(one_room_building()), 0.8);
  EXPECT_NEAR(smoke.optical_depth({1, 1}, {1, 0}, 2.5), 2.0, 1e-12);  // 0.8 / m over 2.5 m: exp(-2) gets through
  EXPECT_NEAR(smoke.optical_depth({1, 1}, Point2(0.6, 0.8), 2.0), 1.6, 1e-12);
}

TEST(SmokeField, AddsUpTheCellsARayCrosses) {
  SmokeField smoke(build_world(one_room_building()), {});
  smoke.set_extinction({1.25, 1.25}, 2.0);  // one cell of 0.5 m: x in 1..1.5, y in 1..1.5
  smoke.set_extinction({2.25, 1.25}, 1.0);
  EXPECT_NEAR(smoke.optical_depth({0.1, 1.2}, {1, 0}, 5), 0.5 * 2 + 0.5 * 1, 1e-12);
  EXPECT_NEAR(smoke.optical_depth({0.1, 1.2}, {1, 0}, 1.0), 0.1 * 2, 1e-12);
  EXPECT_NEAR(smoke.optical_depth({1.2, 1.2}, {-1, 0}, 1.0), 0.2 * 2, 1e-12);
  EXPECT_EQ(smoke.optical_depth({0.1, 3.2}, {1, 0}, 5), 0);
  EXPECT_EQ(smoke.optical_depth({-50, 1.2}, {-1, 0}, 5), 0) << "outside";
}

TEST(SmokeField, AgreesWithSamplingAlongRandomRays) {
  std::mt19937_64 random(1);
  SmokeField smoke(build_world(corridor_building()), {});
  for (int y = 0; y < smoke.frame().height_cells; ++y)
    for (int x = 0; x < smoke.frame().width_cells; ++x)
      smoke.set_extinction(smoke.frame().center_of({x, y}), uniform(random, 0, 3));
  for (int i = 0; i < 100; ++i) {
    const Point2 origin(uniform(random, -2, 16), uniform(random, -2, 13));
    const double angle = uniform(random, -kPi, kPi), range = uniform(random, 0.1, 20);
    const Point2 direction(std::cos(angle), std::sin(angle));
    double sum = 0;
    constexpr int kSamples = 20000;
    for (int k = 0; k < kSamples; ++k)
      sum += smoke.extinction_at(origin + (k + 0.5) * range / kSamples * direction) * range / kSamples;
    EXPECT_NEAR(smoke.optical_depth(origin, direction, range), sum, 0.01);
  }
}

TEST(SmokeField, SpreadsThroughDoorsOnly) {
  FloorPlan plan = two_room_building();
  plan.doors[0].has_leaf = true;
  SegmentWorld world = build_world(plan);
  SmokeField smoke(world, {}, {SmokeSource{{1.5, 2}}});
  smoke.advance(60);
  EXPECT_GT(smoke.extinction_at({3, 3}), 0.5);
  EXPECT_EQ(smoke.extinction_at({6, 2}), 0) << "the door is shut";
  world.set_door(0, kPi / 2);
  smoke.read_walls(world);
  smoke.advance(60);
  EXPECT_GT(smoke.extinction_at({6, 2}), 0.05);
  EXPECT_EQ(smoke.extinction_at({9.4, 2}), 0) << "none outside";
}

TEST(SmokeField, LosesNothingByMixing) {
  SmokeParams params;
  params.decay_per_s = 0;
  SmokeField smoke(build_world(two_room_building()), params);
  smoke.set_extinction({2.25, 2.25}, 4.0);
  smoke.advance(30);
  EXPECT_NEAR(total_of(smoke), 4.0, 1e-9);
  for (const double value : smoke.extinction()) EXPECT_GE(value, 0);
}

TEST(SmokeField, NeverGoesOverItsSourcesCeiling) {
  SmokeSource source{{3, 2}};
  source.ceiling_per_m = 2.5;
  SmokeField smoke(build_world(one_room_building()), {}, {source});
  smoke.advance(600);
  for (const double value : smoke.extinction()) EXPECT_LE(value, 2.5 + 1e-9);
  EXPECT_NEAR(smoke.extinction_at({3, 2}), 2.5, 0.3);
}

TEST(SmokeField, IsTheSameEveryTime) {
  const auto burn = [] {
    SmokeField smoke(build_world(corridor_building()), {}, {SmokeSource{{2, 2}}});
    for (int i = 0; i < 50; ++i) smoke.advance(1.3);
    return smoke.extinction();
  };
  EXPECT_EQ(burn(), burn());
}

TEST(SmokeField, IsClearAirWithoutAWorld) {
  const SmokeField smoke;
  EXPECT_TRUE(smoke.empty());
  EXPECT_EQ(smoke.optical_depth({0, 0}, {1, 0}, 10), 0);
  EXPECT_EQ(smoke.extinction_at({0, 0}), 0);
}

}  // namespace
}  // namespace smokemap
