#include "maps/radar_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

RadarSweep random_sweep(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  RadarSweep sweep;
  sweep.azimuths = 2 + static_cast<int>(uniform_index(random, 400));
  sweep.bins = 1 + static_cast<int>(uniform_index(random, 300));
  sweep.duration_s = uniform(random, 0, 1);
  sweep.azimuth_min_rad = uniform(random, -kPi, kPi);
  sweep.azimuth_increment_rad = (uniform01(random) < 0.5 ? -2 : 2) * kPi / sweep.azimuths;
  sweep.range_min_m = uniform(random, 0, 2);
  sweep.range_resolution_m = uniform(random, 0.01, 0.5);
  for (int i = 0; i < sweep.azimuths * sweep.bins; ++i) sweep.power.push_back(static_cast<float>(exponential(random)));
  return sweep;
}

class RadarImage : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RadarImage, KeepsASweepToFloatPrecision) {
  const RadarSweep sent = random_sweep(GetParam());
  const auto got = from_radar_rows(to_radar_rows(sent), sent.azimuths, sent.bins + kRadarRowHeader);
  ASSERT_THAT(got, test::IsOk());
  EXPECT_EQ(got->power, sent.power);
  EXPECT_EQ(got->bins, sent.bins);
  EXPECT_NEAR(got->azimuth_min_rad, sent.azimuth_min_rad, 1e-6);
  EXPECT_NEAR(got->azimuth_increment_rad, sent.azimuth_increment_rad, 1e-6);
  EXPECT_NEAR(got->duration_s, sent.duration_s, 1e-6);
  EXPECT_NEAR(got->range_min_m, sent.range_min_m, 1e-6);
  EXPECT_NEAR(got->range_resolution_m, sent.range_resolution_m, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RadarImage, testing::Range<std::uint64_t>(1, 20));

TEST(RadarImageFaults, AreRefused) {
  const RadarSweep sent = random_sweep(3);
  const int width = sent.bins + kRadarRowHeader;
  const std::vector<float> sound = to_radar_rows(sent);
  const auto spoilt = [&](std::size_t row, std::size_t column, float value) {
    std::vector<float> rows = sound;
    rows[row * static_cast<std::size_t>(width) + column] = value;
    return from_radar_rows(rows, sent.azimuths, width);
  };
  EXPECT_THAT(from_radar_rows(sound, sent.azimuths, width), test::IsOk());
  EXPECT_THAT(from_radar_rows(sound, sent.azimuths + 1, width), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(from_radar_rows(sound, -1, width), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(from_radar_rows(sound, sent.azimuths, kRadarRowHeader), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(spoilt(1, 0, 3), test::Fails(Errc::kCorrupt)) << "uneven azimuth";
  EXPECT_THAT(spoilt(1, 0, std::nanf("")), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(spoilt(1, 1, 9), test::Fails(Errc::kCorrupt)) << "time runs backwards after it";
  EXPECT_THAT(spoilt(1, 2, 9), test::Fails(Errc::kCorrupt)) << "another range scale";
  EXPECT_THAT(spoilt(0, 3, -1), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(spoilt(1, 4, std::numeric_limits<float>::infinity()), test::Fails(Errc::kCorrupt));
  EXPECT_THAT(from_radar_rows(std::vector<float>(200 * 100, 1.f), 200, 100), test::Fails(Errc::kCorrupt))
      << "a depth picture";
}

TEST(RadarImageFaults, AreRefusedInEveryNumberOfEveryHead) {
  const RadarSweep sent = random_sweep(4);
  const auto width = static_cast<std::size_t>(sent.bins + kRadarRowHeader);
  const std::vector<float> sound = to_radar_rows(sent);
  for (const float bad :
       {std::nanf(""), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()})
    for (std::size_t row = 0; row < static_cast<std::size_t>(sent.azimuths); row += 7)
      for (std::size_t column = 0; column < 4; ++column) {
        std::vector<float> rows = sound;
        rows[row * width + column] = bad;
        EXPECT_THAT(from_radar_rows(rows, sent.azimuths, static_cast<int>(width)), test::Fails(Errc::kCorrupt))
            << row << " " << column << " = " << bad;
      }
}

TEST(RadarImageFaults, SizesBeyondAnyRadarAreRefusedBeforeTheirBytesAreLookedAt) {
  const std::vector<float> few(100, 1.f);
  for (const auto& [height, width] : {std::pair(kMostRadarAzimuths + 1, 10), std::pair(2, kMostRadarBins + 5),
                                      std::pair(1, 100), std::pair(0, 0), std::pair(2, 4), std::pair(2, -50),
                                      std::pair(std::numeric_limits<int>::max(), std::numeric_limits<int>::max())})
    EXPECT_THAT(from_radar_rows(few, height, width), test::Fails(Errc::kCorrupt)) << height << " x " << width;
}

TEST(RadarImage, IsTheSamePictureAfterAnotherRound) {
  for (std::uint64_t seed = 30; seed < 40; ++seed) {
    const RadarSweep sent = random_sweep(seed);
    const std::vector<float> rows = to_radar_rows(sent);
    const auto got = from_radar_rows(rows, sent.azimuths, sent.bins + kRadarRowHeader);
    ASSERT_THAT(got, test::IsOk());
    const std::vector<float> again = to_radar_rows(*got);
    ASSERT_EQ(again.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_NEAR(again[i], rows[i], 2e-6) << i;
  }
}

TEST(CheckSweep, RefusesEveryFieldOutOfRange) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const RadarSweep sound = random_sweep(5);
  ASSERT_THAT(check(sound), test::IsOk());
  const std::vector<std::function<void(RadarSweep&)>> faults{
      [](RadarSweep& s) { s.azimuths = 0; },
      [](RadarSweep& s) { s.azimuths = -s.azimuths; },
      [](RadarSweep& s) { s.azimuths = kMostRadarAzimuths + 1; },
      [](RadarSweep& s) { s.bins = 0; },
      [](RadarSweep& s) { s.bins = kMostRadarBins + 1; },
      [](RadarSweep& s) { ++s.bins; },
      [](RadarSweep& s) { s.power.pop_back(); },
      [](RadarSweep& s) { s.power.push_back(1); },
      [](RadarSweep& s) { s.power.back() = std::nanf(""); },
      [](RadarSweep& s) { s.power.front() = std::numeric_limits<float>::infinity(); },
      [](RadarSweep& s) { s.range_resolution_m = 0; },
      [](RadarSweep& s) { s.range_resolution_m = -0.1; },
      [&](RadarSweep& s) { s.range_resolution_m = inf; },
      [&](RadarSweep& s) { s.range_resolution_m = nan; },
      [&](RadarSweep& s) { s.range_min_m = nan; },
      [&](RadarSweep& s) { s.azimuth_min_rad = inf; },
      [](RadarSweep& s) { s.azimuth_increment_rad = 0; },
      [&](RadarSweep& s) { s.azimuth_increment_rad = nan; },
      [](RadarSweep& s) { s.duration_s = -0.1; },
      [&](RadarSweep& s) { s.duration_s = inf; },
      [&](RadarSweep& s) { s.duration_s = nan; },
      [&](RadarSweep& s) { s.T_robot_radar = Pose2(nan, 0, 0); },
      [&](RadarSweep& s) { s.T_robot_radar = Pose2(0, 0, inf); }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    RadarSweep sweep = sound;
    faults[i](sweep);
    const auto refused = check(sweep);
    ASSERT_THAT(refused, test::Fails(Errc::kCorrupt)) << "fault " << i;
    EXPECT_NE(refused.error().message.find("radar sweep"), std::string::npos);
  }
}

}  // namespace
}  // namespace smokemap
