#include "simulation/lidar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "simulation/building.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

SmokeField even_smoke(const SegmentWorld& world, double per_m) {
  SmokeField smoke(world, {});
  for (int y = 0; y < smoke.frame().height_cells; ++y)
    for (int x = 0; x < smoke.frame().width_cells; ++x) smoke.set_extinction(smoke.frame().center_of({x, y}), per_m);
  return smoke;
}

/// A hall of 40 x 40 m with the lidar in the middle.
SegmentWorld hall() {
  auto plan = wall_in({{"Hall", {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}}});
  EXPECT_TRUE(plan.ok());
  return build_world(*plan);
}

double share_of(const SimulatedScan& scan, BeamFate fate) {
  return static_cast<double>(std::count(scan.fate.begin(), scan.fate.end(), fate)) /
         static_cast<double>(scan.fate.size());
}

LidarParams exact_lidar() {
  LidarParams params;
  params.sigma_range_m = params.dropout = params.beam_width_rad = params.sigma_margin_db = 0;
  return params;
}

TEST(Lidar, MeasuresTrueRangesWithoutNoise) {
  const SegmentWorld world = build_world(one_room_building());
  std::mt19937_64 random(1);
  const Pose2 pose(2, 1.5, 0.7);
  const auto out = simulate_scan(world, {}, pose, pose, 0, exact_lidar(), random);
  ASSERT_THAT(check(out.scan), test::IsOk());
  for (std::size_t i = 0; i < out.scan.ranges_m.size(); ++i) {
    const double angle =
        pose.heading() + out.scan.angle_min_rad + static_cast<double>(i) * out.scan.angle_increment_rad;
    const auto truth = cast_by_force(world, pose.translation(), Point2(std::cos(angle), std::sin(angle)), 100);
    ASSERT_TRUE(truth);
    EXPECT_NEAR(out.scan.ranges_m[i], truth->range_m, 1e-5);
  }
}

TEST(Lidar, HasTheAskedRangeNoiseAndDropouts) {
  const SegmentWorld world = build_world(one_room_building());
  std::mt19937_64 random(2);
  LidarParams params = exact_lidar();
  params.sigma_range_m = 0.03;
  params.dropout = 0.05;
  params.beams = 20000;
  const Pose2 pose(3, 2, 0);
  const auto out = simulate_scan(world, {}, pose, pose, 0, params, random);
  double squares = 0;
  int hits = 0;
  for (std::size_t i = 0; i < out.fate.size(); ++i) {
    if (out.fate[i] != BeamFate::kWall) continue;
    const double angle = out.scan.angle_min_rad + static_cast<double>(i) * out.scan.angle_increment_rad;
    const double off = out.scan.ranges_m[i] - world.cast(pose.translation(), angle, 100)->range_m;
    squares += off * off;
    ++hits;
  }
  EXPECT_NEAR(std::sqrt(squares / hits), 0.03, 0.001);
  EXPECT_NEAR(share_of(out, BeamFate::kLost), 0.05, 0.006);
}

TEST(Lidar, WritesNoEchoAsAsked) {
  const SegmentWorld world({{{{0, 100}, {1, 100}}}});
  std::mt19937_64 random(3);
  LidarParams params;
  params.range_max_m = 12;
  const auto first = [&](NoEcho convention) {
    params.no_echo = convention;
    return simulate_scan(world, {}, {}, {}, 0, params, random).scan.ranges_m.front();
  };
  EXPECT_TRUE(std::isinf(first(NoEcho::kInfinity)));
  EXPECT_TRUE(std::isnan(first(NoEcho::kNan)));
  EXPECT_EQ(first(NoEcho::kZero), 0.0F);
  EXPECT_EQ(first(NoEcho::kMaxPlusOne), 13.0F);
}

TEST(Lidar, LosesTheWallsWhereThePowerBudgetEnds) {
  // 40 dB - 20 log10 r - 8.686 alpha r + 10 log10(0.4 / 0.1) = 0 at alpha 0.5: r = 6.76 m square on.
  const SegmentWorld world = hall();
  std::mt19937_64 random(4);
  LidarParams params = exact_lidar();
  params.range_max_m = 25;
  params.smoke_echo = 0;
  for (const double wall_m : {6.6, 6.9}) {
    const SmokeField smoke = even_smoke(world, 0.5);
    const Pose2 pose(19.85 - wall_m, 0, 0);
    const auto out = simulate_scan(world, smoke, pose, pose, 0, params, random);
    const std::size_t ahead = out.fate.size() / 2;
    EXPECT_EQ(out.fate[ahead] == BeamFate::kWall, wall_m < 6.76) << wall_m;
  }
}

TEST(Lidar, SeesARaggedBallOfEchoesInDenseSmoke) {
  const SegmentWorld world = hall();
  const SmokeField smoke = even_smoke(world, 2.0);
  std::mt19937_64 random(5);
  LidarParams params;
  params.beams = 5000;
  params.range_max_m = 15;
  params.smoke_echo = 0.8;
  const auto out = simulate_scan(world, smoke, {}, {}, 0, params, random);
  EXPECT_EQ(share_of(out, BeamFate::kWall), 0);
  EXPECT_GT(share_of(out, BeamFate::kSmoke), 0.6) << "the others come from nearer than the lidar can measure";
  std::vector<float> echoes;
  for (std::size_t i = 0; i < out.fate.size(); ++i)
    if (out.fate[i] == BeamFate::kSmoke) echoes.push_back(out.scan.ranges_m[i]);
  std::nth_element(echoes.begin(), echoes.begin() + static_cast<std::ptrdiff_t>(echoes.size() / 2), echoes.end());
  EXPECT_LT(echoes[echoes.size() / 2], 0.6);
  EXPECT_LT(*std::max_element(echoes.begin(), echoes.end()), 4);
}

TEST(Lidar, EchoesFromSmokeAsOftenAsThePathIsThick) {
  const SegmentWorld world = build_world(one_room_building());
  const SmokeField smoke = even_smoke(world, 0.1);
  std::mt19937_64 random(6);
  LidarParams params = exact_lidar();
  params.beams = 20000;
  double expected = 0;
  const Pose2 pose(3, 2, 0);
  for (int i = 0; i < params.beams; ++i)
    expected += 1 - std::exp(-params.smoke_echo * 0.1 * world.cast({3, 2}, i * 2 * kPi / params.beams, 100)->range_m);
  const auto out = simulate_scan(world, smoke, pose, pose, 0, params, random);
  EXPECT_NEAR(1 - share_of(out, BeamFate::kWall), expected / params.beams, 0.01);
}

TEST(Lidar, IsSkewedByMotion) {
  const SegmentWorld world = build_world(one_room_building());
  std::mt19937_64 random(7);
  const Pose2 start(2, 2, 0), end(2.5, 2, 0);
  const auto out = simulate_scan(world, {}, start, end, 0, exact_lidar(), random);
  EXPECT_NEAR(out.scan.ranges_m.front(), 2 - 0.15, 1e-6) << "looks back from the start";
  EXPECT_NEAR(out.scan.ranges_m[180], 6 - 0.15 - 2.25, 1e-6) << "looks ahead from half way";
  EXPECT_NEAR(out.scan.time_increment_s * 360, 0.1, 1e-12);
}

TEST(Lidar, LooksThroughGlassMostly) {
  const SegmentWorld world({{{{2, -50}, {2, 50}}, Material::kGlass}, {{{4, -50}, {4, 50}}, Material::kBrick}});
  std::mt19937_64 random(8);
  LidarParams params = exact_lidar();
  params.angle_min_rad = 0.3;
  params.field_of_view_rad = 0.2;
  params.beams = 4000;
  const auto out = simulate_scan(world, {}, {}, {}, 0, params, random);
  const auto beyond = std::count_if(out.scan.ranges_m.begin(), out.scan.ranges_m.end(), [](float r) { return r > 4; });
  EXPECT_NEAR(static_cast<double>(beyond) / 4000, 0.85, 0.02);
}

TEST(Lidar, RefusesNonsense) {
  LidarParams params;
  params.beams = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.range_max_m = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
