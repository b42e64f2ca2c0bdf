#include "simulation/smoke.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

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

/// Nothing but four posts: smoke spreads over 40 x 40 m.
SegmentWorld four_posts() {
  std::vector<WorldSegment> posts;
  for (const Point2& p : {Point2(-20, -20), Point2(20, -20), Point2(20, 20), Point2(-20, 20)})
    posts.push_back({{p, p + Point2(0.01, 0)}});
  return SegmentWorld(posts);
}

TEST(SmokeField, SpreadsLikeHeatFromAPoint) {
  SmokeParams params;
  params.decay_per_s = 0;
  SmokeField smoke(four_posts(), params);
  smoke.set_extinction({0.1, 0.1}, 8);
  const Point2 center = smoke.frame().center_of(smoke.frame().cell_of({0.1, 0.1}));
  for (const double seconds : {2.0, 5.0, 11.0}) {  // 2, 7, 18 s in all
    smoke.advance(seconds);
    Point2 squares = Point2::Zero(), mean = Point2::Zero();
    for (int y = 0; y < smoke.frame().height_cells; ++y)
      for (int x = 0; x < smoke.frame().width_cells; ++x) {
        const Point2 off = smoke.frame().center_of({x, y}) - center;
        const double share = smoke.extinction()[smoke.frame().index({x, y})] / 8;
        mean += share * off;
        squares += share * off.cwiseProduct(off);
      }
    EXPECT_NEAR(mean.norm(), 0, 1e-6);
    const double total_s = seconds == 2.0 ? 2 : seconds == 5.0 ? 7 : 18;
    EXPECT_NEAR(squares.x(), 2 * params.diffusion_m2ps * total_s, 1e-3) << "variance 2 D t along each axis";
    EXPECT_NEAR(squares.y(), squares.x(), 1e-5);
  }
}

TEST(SmokeField, SettlesExponentiallyAndFillsAtItsSourcesRate) {
  SmokeParams params;
  params.diffusion_m2ps = 0;
  params.decay_per_s = 0.02;
  SmokeField smoke(four_posts(), params);
  smoke.set_extinction({0, 0}, 3);
  smoke.advance(50);
  EXPECT_NEAR(smoke.extinction_at({0, 0}), 3 * std::exp(-1.0), 1e-9);
  params.decay_per_s = 0;
  SmokeSource source{{5, 5}, 1.0, 0.25, 2.0};
  SmokeField fire(four_posts(), params, {source});
  fire.advance(4);
  EXPECT_NEAR(fire.extinction_at({5, 5}), 1.0, 1e-9);
  fire.advance(40);
  EXPECT_NEAR(fire.extinction_at({5, 5}), 2.0, 1e-9) << "its ceiling";
  EXPECT_EQ(fire.extinction_at({8, 5}), 0);
}

TEST(SmokeField, ManySmallStepsAreOneLargeOne) {
  const auto burn = [](int steps) {
    SmokeField smoke(build_world(corridor_building()), {}, {SmokeSource{{2, 2}}});
    for (int i = 0; i < steps; ++i) smoke.advance(40.0 / steps);
    return smoke;
  };
  const SmokeField once = burn(1), often = burn(400);
  for (std::size_t i = 0; i < once.extinction().size(); ++i)
    EXPECT_NEAR(once.extinction()[i], often.extinction()[i], 0.02 + 0.03 * often.extinction()[i]);
}

TEST(SmokeField, IsAsThickThereAsBackAndInPiecesAsInOne) {
  std::mt19937_64 random(8);
  SmokeField smoke(build_world(corridor_building()), {});
  for (int y = 0; y < smoke.frame().height_cells; ++y)
    for (int x = 0; x < smoke.frame().width_cells; ++x)
      smoke.set_extinction(smoke.frame().center_of({x, y}), uniform01(random) < 0.3 ? 0 : uniform(random, 0, 3));
  std::vector<SmokePiece> pieces;
  for (int i = 0; i < 300; ++i) {
    const Point2 a(uniform(random, -3, 17), uniform(random, -3, 14)),
        b(uniform(random, -3, 17), uniform(random, -3, 14));
    const double way = (b - a).norm(), part = uniform(random, 0, way);
    const Point2 u = (b - a) / way;
    const double whole = smoke.optical_depth(a, u, way);
    EXPECT_NEAR(smoke.optical_depth(b, -u, way), whole, 1e-9);
    EXPECT_NEAR(smoke.optical_depth(a, u, part) + smoke.optical_depth(a + part * u, u, way - part), whole, 1e-9);
    smoke.trace(a, u, way, pieces);
    double before = 0;
    for (const SmokePiece& piece : pieces) {
      EXPECT_GE(piece.from_m, before - 1e-12) << "near to far, none over another";
      EXPECT_GT(piece.to_m, piece.from_m);
      EXPECT_LE(piece.to_m, way + 1e-12);
      EXPECT_EQ(piece.extinction_per_m, smoke.extinction_at(a + 0.5 * (piece.from_m + piece.to_m) * u));
      before = piece.to_m;
    }
  }
}

}  // namespace
}  // namespace smokemap
