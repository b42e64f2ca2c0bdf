#include "simulation/radar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.hpp"
#include "simulation/building.hpp"
#include "simulation/random_building.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// Mean power of an azimuth's bin over many sweeps.
double mean_power(const SegmentWorld& world, const RadarSimParams& params, int azimuth, int bin, int sweeps) {
  double sum = 0;
  for (int i = 0; i < sweeps; ++i) {
    auto random = random_stream(77, static_cast<std::uint64_t>(i));
    sum += simulate_sweep(world, {}, {}, 0, params, random)
               .power[static_cast<std::size_t>(azimuth) * static_cast<std::size_t>(params.bins) +
                      static_cast<std::size_t>(bin)];
  }
  return sum / sweeps;
}

RadarSimParams small_radar() {
  RadarSimParams params;
  params.azimuths = 8;
  params.ghost_share = 0;
  return params;
}

TEST(Radar, HasUnitNoiseWhereNothingIs) {
  const SegmentWorld world({{{{100, 0}, {101, 0}}}});
  std::mt19937_64 random(1);
  const RadarSweep sweep = simulate_sweep(world, {}, {}, 0, {}, random);
  ASSERT_EQ(sweep.power.size(), 200u * 400u);
  const double mean = std::accumulate(sweep.power.begin(), sweep.power.end(), 0.0) / 80000;
  EXPECT_NEAR(mean, 1, 0.02);
  const auto loud = std::count_if(sweep.power.begin(), sweep.power.end(), [](float p) { return p > 3; });
  EXPECT_NEAR(static_cast<double>(loud) / 80000, std::exp(-3.0), 0.003) << "exponential";
}

TEST(Radar, ShowsABrickWallAtFiveMetresAtItsSignalToNoiseRatio) {
  const SegmentWorld world({{{{5, -20}, {5, 20}}, Material::kBrick}});
  RadarSimParams params = small_radar();
  params.bin_m = 0.05;                                          // the wall at a bin's centre
  const double power = mean_power(world, params, 4, 100, 400);  // azimuth 4 looks along +x
  EXPECT_NEAR(10 * std::log10(power), 25, 1.0);
}

TEST(Radar, FallsWithTheCubeOfTheRange) {
  const SegmentWorld near({{{{2.5, -20}, {2.5, 20}}}}), far({{{{10, -20}, {10, 20}}}});
  RadarSimParams params = small_radar();
  params.bin_m = 0.05;
  params.saturation_db = 90;
  const double ratio = mean_power(near, params, 4, 50, 300) / mean_power(far, params, 4, 200, 300);
  EXPECT_NEAR(10 * std::log10(ratio), 30 * std::log10(4.0), 1.5);
}

TEST(Radar, LooksThroughPlasterboardButNotThroughBrick) {
  RadarSimParams params = small_radar();
  params.bin_m = 0.05;
  for (const Material material : {Material::kWood, Material::kBrick}) {
    const SegmentWorld world({{{{2, -20}, {2, 20}}, material}, {{{4, -20}, {4, 20}}, Material::kMetal}});
    const double behind = mean_power(world, params, 4, 80, 200);
    if (material == Material::kWood)
      EXPECT_GT(behind, 50);
    else
      EXPECT_LT(behind, 2);
  }
}

TEST(Radar, MakesGhostsBehindMirrorsOnly) {
  // A metal wall at 45 degrees ahead sends the beam up to a second one: its image lies behind the first.
  const SegmentWorld world({{{{1, -1}, {5, 3}}, Material::kMetal}, {{{-10, 4}, {10, 4}}, Material::kMetal}});
  RadarSimParams params = small_radar();
  params.bin_m = 0.05;
  const int image = static_cast<int>(std::lround((2 + 4) / 0.05));
  EXPECT_LT(mean_power(world, params, 4, image, 200), 2);
  params.ghost_share = 1;
  EXPECT_GT(mean_power(world, params, 4, image, 200), 10);
}

TEST(Radar, SmearsAPoleAcrossItsBeam) {
  const SegmentWorld world({{{{7.9, -0.05}, {7.9, 0.05}}, Material::kMetal}});
  RadarSimParams params;
  params.ghost_share = 0;
  std::mt19937_64 random(2);
  int seen = 0;
  const RadarSweep sweep = simulate_sweep(world, {}, {}, 0, params, random);
  const LaserScan strongest = strongest_returns(sweep, 13);
  for (std::size_t i = 0; i < strongest.ranges_m.size(); ++i) seen += std::abs(strongest.ranges_m[i] - 7.9F) < 0.1F;
  EXPECT_GE(seen, 1);
  EXPECT_LE(seen, 6) << "side lobes reach a little further than the beam";
}

TEST(Radar, StrongestReturnsLieNearWalls) {
  std::mt19937_64 random(3);
  const auto plan = random_building({}, random);
  ASSERT_THAT(plan, test::IsOk());
  const SegmentWorld world = build_world(*plan);
  int near = 0, behind = 0, all = 0;
  for (std::size_t room = 2; room < plan->rooms.size(); ++room) {
    const Pose2 pose(centroid(plan->outline(static_cast<int>(room))), 0.3);
    const LaserScan scan = strongest_returns(simulate_sweep(world, pose, pose, 0, {}, random));
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      if (!std::isfinite(scan.ranges_m[i])) continue;
      const double angle = pose.heading() + scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
      const auto truth = world.cast(pose.translation(), angle, 30);
      ++all;
      near += truth && std::abs(scan.ranges_m[i] - truth->range_m) < 0.25;
      behind += truth && scan.ranges_m[i] > truth->range_m + 0.3;
    }
  }
  ASSERT_GT(all, 1000);
  EXPECT_GT(static_cast<double>(near) / all, 0.7);
  EXPECT_LT(static_cast<double>(behind) / all, 0.25) << "what a spinning radar indoors was seen to do: 10 to 15 %";
}

TEST(Radar, IsTheSameForASeed) {
  const SegmentWorld world = build_world(corridor_building());
  const auto sweep = [&] {
    std::mt19937_64 random(4);
    return simulate_sweep(world, {7, 6, 0}, {7.1, 6, 0.1}, 0, {}, random).power;
  };
  EXPECT_EQ(sweep(), sweep());
}

TEST(Radar, RefusesNonsense) {
  RadarSimParams params;
  params.bins = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
