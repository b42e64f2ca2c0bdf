// The simulated sensors against the laws that their headers state, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "core/random.hpp"
#include "maps/radar_image.hpp"
#include "simulation/building.hpp"
#include "simulation/lidar.hpp"
#include "simulation/radar.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A wall across the x axis, wide enough for every beam of these tests.
SegmentWorld wall_at(double x_m, Material material = Material::kBrick) {
  return SegmentWorld({{{{x_m, -500}, {x_m, 500}}, material}});
}

/// Many beams that all look along +x, without any noise but the one a test asks for.
LidarParams stare(int beams) {
  LidarParams params;
  params.beams = beams;
  params.angle_min_rad = -0.005;
  params.field_of_view_rad = 0.01;
  params.range_max_m = 500;
  params.sigma_range_m = params.dropout = params.beam_width_rad = params.sigma_margin_db = 0;
  return params;
}

double share_of_fate(const SimulatedScan& scan, BeamFate fate) {
  return static_cast<double>(std::count(scan.fate.begin(), scan.fate.end(), fate)) /
         static_cast<double>(scan.fate.size());
}

double normal_below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

TEST(LidarLaw, SeesAWallAsOftenAsItsPowerMarginSays) {
  // Square on, brick: 40 dB - 20 log10 r + 10 log10(0.4 / 0.1); half of the beams come back where that is zero: 200 m.
  LidarParams params = stare(20'000);
  params.sigma_margin_db = 1.5;
  for (const double wall_m : {150.0, 180.0, 200.0, 220.0, 260.0}) {
    auto random = random_stream(31, static_cast<std::uint64_t>(wall_m));
    const auto scan = simulate_scan(wall_at(wall_m), {}, {}, {}, 0, params, random);
    const double margin_db = 40 - 20 * std::log10(wall_m) + 10 * std::log10(4.0);
    EXPECT_NEAR(share_of_fate(scan, BeamFate::kWall), normal_below(margin_db / 1.5), 0.012) << wall_m;
  }
}

TEST(LidarLaw, DrawsFalseEchoesFromTheDensityOfItsHeader) {
  const SegmentWorld world({{{{-30, -30}, {30, -30}}}, {{{-30, 30}, {30, 30}}}});
  SmokeField smoke(world, {});
  constexpr double kPerM = 0.5;
  for (int y = 0; y < smoke.frame().height_cells; ++y)
    for (int x = 0; x < smoke.frame().width_cells; ++x) smoke.set_extinction(smoke.frame().center_of({x, y}), kPerM);
  LidarParams params = stare(20'000);
  params.range_max_m = 20;
  std::vector<double> echoes;
  for (std::uint64_t round = 0; round < 2; ++round) {
    auto random = random_stream(32, round);
    const auto out = simulate_scan(world, smoke, {}, {}, 0, params, random);
    for (std::size_t i = 0; i < out.fate.size(); ++i)
      if (out.fate[i] == BeamFate::kSmoke) echoes.push_back(out.scan.ranges_m[i]);
  }
  // The density, blurred by the 0.1 m that an echo of a cloud is off.
  const auto beyond = [&](double range_m) {
    double sum = 0;
    for (double s = 0.005; s < 20; s += 0.01)
      sum += kPerM * std::exp(-2 * kPerM * s) / std::pow(std::max(s, 0.5), 2) * normal_below((s - range_m) / 0.1);
    return sum;
  };
  const auto drawn_beyond = [&](double range_m) {
    return static_cast<double>(std::count_if(echoes.begin(), echoes.end(), [&](double r) { return r > range_m; }));
  };
  for (const double range_m : {0.6, 1.0, 1.5, 2.0, 2.5})
    EXPECT_NEAR(drawn_beyond(range_m) / drawn_beyond(0.4), beyond(range_m) / beyond(0.4), 0.018) << range_m;
}

TEST(LidarLaw, LosesNothingOfAWallToSmokeBehindIt) {
  const SegmentWorld world({{{{5, -30}, {5, 30}}}, {{{-30, 0}, {-29, 0}}}, {{{30, 0}, {31, 0}}}});
  SmokeField smoke(world, {});
  for (int y = 0; y < smoke.frame().height_cells; ++y)
    for (double x = 5.5; x < 29; x += 0.5) {
      const Point2 p(x + 0.25, smoke.frame().center_of({0, y}).y());
      if (smoke.frame().contains(smoke.frame().cell_of(p))) smoke.set_extinction(p, 9);
    }
  auto random = random_stream(33, 1);
  const auto scan = simulate_scan(world, smoke, {}, {}, 0, stare(2000), random);
  EXPECT_EQ(share_of_fate(scan, BeamFate::kWall), 1);
}

TEST(LidarLaw, LooksFromWhereItIsMounted) {
  const SegmentWorld world = build_world(one_room_building());
  auto random = random_stream(34, 1);
  for (int i = 0; i < 20; ++i) {
    LidarParams params;
    params.sigma_range_m = params.dropout = params.beam_width_rad = params.sigma_margin_db = 0;
    params.beams = 36;
    params.T_robot_laser = Pose2(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3), uniform(random, -3, 3));
    const Pose2 T_world_robot(uniform(random, 1, 5), uniform(random, 1, 3), uniform(random, -3, 3));
    const auto out = simulate_scan(world, {}, T_world_robot, T_world_robot, 7, params, random);
    EXPECT_EQ(out.scan.stamp, 7);
    for (const Point2& p_laser : hit_points(out.scan, {}))  // every echo lies on a wall, put through both poses
      EXPECT_LT(world.clearance_m(T_world_robot * (out.scan.T_robot_laser * p_laser), 1), 1e-5);
  }
}

TEST(LidarLaw, IsTheSameForASeedInSmokeAndNoise) {
  const SegmentWorld world = build_world(corridor_building());
  SmokeField smoke(world, {}, {SmokeSource{{7, 6}}});
  smoke.advance(30);
  const auto ranges = [&](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    return simulate_scan(world, smoke, {5, 6, 0.2}, {5.1, 6, 0.3}, 0, {}, random).scan.ranges_m;
  };
  const auto one = ranges(5), other = ranges(5), another = ranges(6);
  for (std::size_t i = 0; i < one.size(); ++i)
    ASSERT_TRUE(one[i] == other[i] || (one[i] != one[i] && other[i] != other[i]));
  EXPECT_NE(one, another);
}

TEST(LidarLaw, NamesEveryParameterOutOfRange) {
  const double nan = std::nan("");
  const std::vector<std::function<void(LidarParams&)>> faults{
      [](LidarParams& p) { p.beams = 20'001; },         [&](LidarParams& p) { p.angle_min_rad = nan; },
      [](LidarParams& p) { p.field_of_view_rad = 7; },  [](LidarParams& p) { p.field_of_view_rad = 0; },
      [](LidarParams& p) { p.range_min_m = -1; },       [](LidarParams& p) { p.range_max_m = p.range_min_m; },
      [&](LidarParams& p) { p.range_min_m = nan; },     [](LidarParams& p) { p.turn_s = -1; },
      [](LidarParams& p) { p.sigma_range_m = -0.1; },   [](LidarParams& p) { p.dropout = 1.1; },
      [](LidarParams& p) { p.beam_width_rad = 0.2; },   [](LidarParams& p) { p.margin_db = 121; },
      [&](LidarParams& p) { p.sigma_margin_db = nan; }, [](LidarParams& p) { p.smoke_echo = -1; }};
  ASSERT_THAT(LidarParams{}.validate(), test::IsOk());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    LidarParams params;
    faults[i](params);
    EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument)) << i;
  }
}

/// Mean power over many sweeps from the origin, azimuths x bins.
std::vector<double> mean_sweep(const SegmentWorld& world, const RadarSimParams& params, int sweeps,
                               const Pose2& T_world_robot = {}) {
  std::vector<double> mean(static_cast<std::size_t>(params.azimuths * params.bins), 0.0);
  for (int i = 0; i < sweeps; ++i) {
    auto random = random_stream(78, static_cast<std::uint64_t>(i));
    const RadarSweep sweep = simulate_sweep(world, T_world_robot, T_world_robot, 0, params, random);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += sweep.power[k] / static_cast<double>(sweeps);
  }
  return mean;
}

/// Echo of one azimuth above the noise, over all bins: the point spread shares it out among them.
double echo_of(const std::vector<double>& mean, const RadarSimParams& params, int azimuth) {
  const auto row = mean.begin() + static_cast<std::ptrdiff_t>(azimuth) * params.bins;
  return std::accumulate(row, row + params.bins, 0.0) - params.bins;
}

RadarSimParams radar_without_ghosts(int azimuths) {
  RadarSimParams params;
  params.azimuths = azimuths;
  params.ghost_share = 0;
  params.saturation_db = 100;
  return params;
}

TEST(RadarLaw, PutsAWallIntoTheBinOfItsRange) {
  const RadarSimParams params = radar_without_ghosts(4);
  for (const double wall_m : {1.0, 2.33, 5.017, 9.9, 14.2}) {
    const auto mean = mean_sweep(wall_at(wall_m), params, 60);
    const auto row = mean.begin() + 2 * params.bins;  // azimuth 2 of 4 looks along +x
    const auto peak = static_cast<double>(std::max_element(row, row + params.bins) - row);
    EXPECT_NEAR(peak * params.bin_m, wall_m, 0.75 * params.bin_m) << wall_m;
  }
}

TEST(RadarLaw, FindsAPoleAtItsBearingWhereverTheRadarIsMounted) {
  auto random = random_stream(79, 1);
  for (int i = 0; i < 8; ++i) {
    RadarSimParams params = radar_without_ghosts(120);
    params.bins = 220;
    params.T_robot_radar = Pose2(0.2, -0.1, uniform(random, -3, 3));
    const Pose2 T_world_robot(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -3, 3));
    const Pose2 T_world_radar = T_world_robot * params.T_robot_radar;
    const double bearing = uniform(random, -3, 3);
    const Point2 pole = T_world_radar * Point2(6 * std::cos(bearing), 6 * std::sin(bearing));
    const Point2 side =
        0.2 * Point2(-std::sin(T_world_radar.heading() + bearing), std::cos(T_world_radar.heading() + bearing));
    const auto mean =
        mean_sweep(SegmentWorld({{{pole - side, pole + side}, Material::kMetal}}), params, 12, T_world_robot);
    int loudest = 0;
    for (int row = 1; row < params.azimuths; ++row)
      if (echo_of(mean, params, row) > echo_of(mean, params, loudest)) loudest = row;
    EXPECT_LT(std::abs(wrap_angle(-kPi + loudest * 2 * kPi / params.azimuths - bearing)), 2 * kPi / params.azimuths);
  }
}

TEST(RadarLaw, GetsLessFromAWallThatItMeetsAtAnAngle) {
  // Brick: cos^4 of the incidence and 0.02 that does not care. 45 degrees: (0.25 + 0.02) / 1.02 at the same range.
  const RadarSimParams params = radar_without_ghosts(4);
  const SegmentWorld slanted({{{{5 - 20, -20}, {5 + 20, 20}}}});
  const double square = echo_of(mean_sweep(wall_at(5), params, 400), params, 2);
  const double oblique = echo_of(mean_sweep(slanted, params, 400), params, 2);
  EXPECT_NEAR(oblique / square, 0.27 / 1.02, 0.05);
}

TEST(RadarLaw, LosesAFaceOfPlasterboardOnTheWayThroughIt) {
  RadarSimParams params = radar_without_ghosts(4);
  const auto behind = [&](bool with_board) {
    std::vector<WorldSegment> segments{{{{4, -50}, {4, 50}}, Material::kMetal}};
    if (with_board) segments.push_back({{{2, -50}, {2, 50}}, Material::kWood});
    const auto mean = mean_sweep(SegmentWorld(segments), params, 400);
    double sum = 0;  // around 4 m only
    for (int bin = 100; bin < 114; ++bin) sum += mean[static_cast<std::size_t>(2 * params.bins + bin)] - 1;
    return sum;
  };
  EXPECT_NEAR(behind(true) / behind(false), std::sqrt(params.transmission), 0.06);
}

TEST(RadarLaw, IsBlindUpCloseAndDeafBeyondItsCeiling) {
  RadarSimParams params = radar_without_ghosts(4);
  params.saturation_db = 20;
  auto random = random_stream(80, 1);
  const RadarSweep sweep = simulate_sweep(wall_at(0.4), {}, {}, 0, params, random);
  double near = 0;
  const int blind = static_cast<int>(params.blind_m / params.bin_m);
  for (int bin = 0; bin < blind; ++bin)
    near = std::max(near, static_cast<double>(sweep.power[static_cast<std::size_t>(2 * params.bins + bin)]));
  EXPECT_LT(near, 15) << "noise alone";
  const RadarSweep loud = simulate_sweep(wall_at(1, Material::kMetal), {}, {}, 0, params, random);
  EXPECT_FLOAT_EQ(*std::max_element(loud.power.begin(), loud.power.end()), 100.0F);
  EXPECT_THAT(check(loud), test::IsOk());
}

TEST(RadarLaw, TheStrongestBinIsTheScan) {
  RadarSweep sweep;
  sweep.azimuths = 3, sweep.bins = 4;
  sweep.azimuth_min_rad = -1, sweep.azimuth_increment_rad = 0.5;
  sweep.range_min_m = 0.25, sweep.range_resolution_m = 0.5, sweep.duration_s = 0.3;
  sweep.stamp = 99, sweep.robot = "fox";
  sweep.power = {1, 1, 50, 2, /**/ 1, 15, 3, 1, /**/ 90, 40, 90, 1};
  const LaserScan scan = strongest_returns(sweep, 12);  // 12 dB: 15.85
  ASSERT_THAT(check(scan), test::IsOk());
  EXPECT_FLOAT_EQ(scan.ranges_m[0], 0.25F + 2 * 0.5F);
  EXPECT_TRUE(std::isinf(scan.ranges_m[1])) << "below the floor";
  EXPECT_FLOAT_EQ(scan.ranges_m[2], 0.25F) << "of two alike the nearer";
  EXPECT_EQ(scan.intensities, (std::vector<float>{50, 0, 90}));
  EXPECT_EQ(scan.stamp, 99);
  EXPECT_EQ(scan.robot, "fox");
  EXPECT_DOUBLE_EQ(scan.time_increment_s, 0.1);
  EXPECT_DOUBLE_EQ(scan.angle_increment_rad, 0.5);
  EXPECT_DOUBLE_EQ(scan.range_max_m, 2.25);
}

TEST(RadarLaw, NamesEveryParameterOutOfRange) {
  const double nan = std::nan("");
  const std::vector<std::function<void(RadarSimParams&)>> faults{
      [](RadarSimParams& p) { p.azimuths = 0; },      [](RadarSimParams& p) { p.azimuths = 4001; },
      [](RadarSimParams& p) { p.bins = 7; },          [&](RadarSimParams& p) { p.bin_m = nan; },
      [](RadarSimParams& p) { p.turn_s = 0; },        [](RadarSimParams& p) { p.beam_width_rad = 0; },
      [](RadarSimParams& p) { p.side_lobe_db = 1; },  [](RadarSimParams& p) { p.snr_db = -1; },
      [](RadarSimParams& p) { p.diffuse = 2; },       [](RadarSimParams& p) { p.transmission = -0.1; },
      [](RadarSimParams& p) { p.ghost_share = 1.5; }, [](RadarSimParams& p) { p.ghost_db = 3; },
      [](RadarSimParams& p) { p.saturation_db = 5; }, [&](RadarSimParams& p) { p.blind_m = nan; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    RadarSimParams params;
    faults[i](params);
    EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument)) << i;
  }
}

}  // namespace
}  // namespace smokemap
