// What real scanners and their clocks do wrong: the log goes on, the map is not spoilt, and it is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "slam/slam.hpp"
#include "slam/trajectory_error.hpp"
#include "tests/engine/slam/toy_world.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using test::IsNear;

struct FaultyLog {
  std::vector<LaserScan> scans;
  std::vector<Odometry> odometry;
  Trajectory truth;
};

/// One round through the ring of corridors, in the world frame moved by `T_moved_world`.
FaultyLog one_round(std::uint64_t seed, double step_m = 0.35) {
  std::mt19937_64 random(seed);
  test::Wheels wheels(0.98, 0.004, 0.05, seed);
  FaultyLog log;
  double seconds = 10;
  for (const Pose2& at : test::rounds(1, step_m)) {
    log.odometry.push_back(wheels.read(at, seconds));
    log.scans.push_back(test::scan_at(test::ring_of_corridors(), at, seconds, random, 120));
    log.truth.push_back({from_seconds(seconds), at, Eigen::Matrix3d::Zero()});
    seconds += 0.4;
  }
  return log;
}

struct Driven {
  SlamCounters counters;
  double ate_m = 1e9;
  std::size_t poses = 0;
};

Driven run(const FaultyLog& log, bool with_odometry = true) {
  Slam slam;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    if (with_odometry) slam.add_odometry(log.odometry[i]);
    (void)slam.add_scan(log.scans[i]).ok();
  }
  slam.optimize();
  const auto error = absolute_error(slam.trajectory(), log.truth);
  return {slam.counters(), error ? error->rmse_m : 1e9, slam.trajectory().size()};
}

struct Convention {
  const char* name;
  float value;
};

class NoReturn : public testing::TestWithParam<Convention> {};

TEST_P(NoReturn, IsNeitherAWallNorTheEndOfTheLog) {
  FaultyLog log = one_round(1);
  std::mt19937_64 random(9);
  for (LaserScan& scan : log.scans)
    for (float& range : scan.ranges_m)
      if (uniform01(random) < 0.25) range = GetParam().value;
  const Driven driven = run(log);
  EXPECT_LT(driven.ate_m, 0.05);
  EXPECT_EQ(driven.poses, log.scans.size());
  EXPECT_EQ(driven.counters.malformed, 0);
}

INSTANTIATE_TEST_SUITE_P(Conventions, NoReturn,
                         testing::Values(Convention{"Infinity", std::numeric_limits<float>::infinity()},
                                         Convention{"MinusInfinity", -std::numeric_limits<float>::infinity()},
                                         Convention{"Zero", 0.0F},
                                         Convention{"NotANumber", std::numeric_limits<float>::quiet_NaN()},
                                         Convention{"Maximum", 12.0F}, Convention{"MaximumPlusOne", 13.0F},
                                         Convention{"Huge", 65.533F}, Convention{"Negative", -1.0F}),
                         [](const auto& test_case) { return test_case.param.name; });

TEST(ScanFaults, IrregularStampsDoNotMatterWithoutSkew) {
  FaultyLog log = one_round(2);
  std::mt19937_64 random(3);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const Stamp off = from_seconds(uniform(random, -0.15, 0.15));
    log.scans[i].stamp += off;
    log.odometry[i].stamp += off;
    log.truth[i].stamp += off;
  }
  EXPECT_LT(run(log).ate_m, 0.04);
}

TEST(ScanFaults, AClockThatJumpsAnHourIsCountedAndDrivenThrough) {
  for (const double hour : {3600.0, -3600.0}) {
    FaultyLog log = one_round(3);
    for (std::size_t i = 40; i < log.scans.size(); ++i) {
      log.scans[i].stamp += from_seconds(hour);
      log.odometry[i].stamp += from_seconds(hour);
      log.truth[i].stamp += from_seconds(hour);
    }
    const Driven driven = run(log);
    EXPECT_EQ(driven.counters.stamps_back, hour < 0 ? 1 : 0);
    EXPECT_LT(driven.ate_m, 0.05);
  }
}

TEST(ScanFaults, ManyDuplicatesAreCountedAndKeepTheTrajectorysLength) {
  FaultyLog log = one_round(4);
  Slam slam;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    slam.add_odometry(log.odometry[i]);
    for (int copy = 0; copy < 3; ++copy) ASSERT_TRUE(slam.add_scan(log.scans[i]));
  }
  EXPECT_EQ(slam.counters().duplicates, 2 * static_cast<std::int64_t>(log.scans.size()));
  EXPECT_EQ(slam.trajectory().size(), 3 * log.scans.size());
}

TEST(ScanFaults, OdometryThatStopsHalfWayIsReplacedByTheLastVelocity) {
  const FaultyLog log = one_round(5, 0.2);
  Slam slam;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    if (i < 30) slam.add_odometry(log.odometry[i]);
    ASSERT_TRUE(slam.add_scan(log.scans[i]));
  }
  const auto error = absolute_error(slam.trajectory(), log.truth);
  ASSERT_TRUE(error);
  EXPECT_LT(error->rmse_m, 0.08);
}

TEST(ScanFaults, OdometryThatIsNotANumberIsIgnored) {
  FaultyLog log = one_round(6);
  for (std::size_t i = 5; i < log.odometry.size(); i += 7) {
    Eigen::Vector2d nowhere(std::nan(""), 0);
    log.odometry[i].T_odom_robot = Pose2(nowhere, 0);
  }
  EXPECT_LT(run(log).ate_m, 0.05);
}

TEST(ScanFaults, EachMalformedScanIsRefusedWithAReasonAndTheRestIsUsed) {
  const FaultyLog log = one_round(7);
  using Spoil = std::function<void(LaserScan&)>;
  const std::vector<Spoil> spoils{
      [](LaserScan& s) { s.ranges_m.clear(); },
      [](LaserScan& s) { s.ranges_m.resize(30'000, 1.0F); },
      [](LaserScan& s) { s.angle_increment_rad = 0; },
      [](LaserScan& s) { s.angle_increment_rad = std::nan(""); },
      [](LaserScan& s) { s.angle_min_rad = std::numeric_limits<double>::infinity(); },
      [](LaserScan& s) { s.range_max_m = -1; },
      [](LaserScan& s) { s.range_min_m = std::nan(""); },
      [](LaserScan& s) { s.time_increment_s = std::nan(""); },
      [](LaserScan& s) {
        s.intensities = {1, 2};
      },
  };
  Slam slam;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    slam.add_odometry(log.odometry[i]);
    LaserScan scan = log.scans[i];
    const bool spoilt = i > 0 && i <= spoils.size();
    if (spoilt) spoils[i - 1](scan);
    const auto outcome = slam.add_scan(scan);
    EXPECT_EQ(outcome.ok(), !spoilt) << i;
    if (!outcome) {
      EXPECT_FALSE(outcome.error().message.empty());
    }
  }
  EXPECT_EQ(slam.counters().malformed, static_cast<std::int64_t>(spoils.size()));
  EXPECT_EQ(slam.trajectory().size(), log.scans.size() - spoils.size());
}

/// Ten scans a second of a moving scanner without odometry; ranges of 3 cm noise.
TEST(ScanFaults, AScannerWithoutOdometryIsNotSwungByItsOwnStraightening) {
  const auto walls = test::ring_of_corridors();
  std::mt19937_64 random(8);
  const auto at = [](double t) { return Pose2(1 + 0.4 * t, 1 + 0.1 * std::sin(t), 0.1 * std::sin(0.7 * t)); };
  Slam slam;
  Trajectory truth;
  constexpr int kBeams = 180;
  for (int k = 0; k < 200; ++k) {
    const double begin = 0.1 * k;
    LaserScan scan = test::scan_at(walls, at(begin), begin, random, kBeams);
    scan.time_increment_s = 0.1 / kBeams;
    for (int i = 0; i < kBeams; ++i) {
      const Pose2 T = at(begin + i * scan.time_increment_s);
      const double range = test::cast(walls, T.translation(), T.heading() - kPi + i * scan.angle_increment_rad, 11) +
                           normal(random, 0.03);
      scan.ranges_m[static_cast<std::size_t>(i)] = static_cast<float>(range);
    }
    ASSERT_TRUE(slam.add_scan(scan));
    truth.push_back({scan.stamp, at(begin), Eigen::Matrix3d::Zero()});
  }
  EXPECT_EQ(slam.counters().lost, 0);
  const auto error = absolute_error(slam.trajectory(), truth);
  ASSERT_TRUE(error);
  EXPECT_LT(error->rmse_m, 0.05);
}

TEST(Invariance, ARigidMoveOfTheWorldMovesNothingInTheMap) {
  // The same ranges and the same odometry increments: the map frame begins at the first scan whatever odom says.
  const FaultyLog here = one_round(10);
  FaultyLog there = here;
  const Pose2 T(31.7, -12.3, 2.1);
  for (Odometry& reading : there.odometry) reading.T_odom_robot = T * reading.T_odom_robot;
  Slam a, b;
  for (std::size_t i = 0; i < here.scans.size(); ++i) {
    a.add_odometry(here.odometry[i]);
    b.add_odometry(there.odometry[i]);
    ASSERT_TRUE(a.add_scan(here.scans[i]));
    ASSERT_TRUE(b.add_scan(there.scans[i]));
  }
  a.polish();
  b.polish();
  const Trajectory ta = a.trajectory(), tb = b.trajectory();
  for (std::size_t i = 0; i < ta.size(); ++i) EXPECT_THAT(ta[i].T_map_robot, IsNear(tb[i].T_map_robot, 1e-3, 1e-3));
}

TEST(SmoothedTwist, ForgetsWithTheTimeBetweenSteps) {
  const Twist2 still, fast{{1, 0}, 2};
  EXPECT_EQ(smoothed(std::nullopt, fast, 0.1).velocity_mps.x(), 1);
  const Twist2 soon = smoothed(still, fast, 0.1), late = smoothed(still, fast, 5);
  EXPECT_NEAR(soon.velocity_mps.x(), 1 - std::exp(-0.25), 1e-9);
  EXPECT_NEAR(late.velocity_mps.x(), 0.7, 1e-9);
  EXPECT_NEAR(soon.turn_radps, 2 * soon.velocity_mps.x(), 1e-9);
}

/// The loop 'straighten, match, measure' with an error of one step in it: it must die away.
TEST(SmoothedTwist, DampsTheErrorThatStraighteningFeedsBack) {
  double before_m = 0.05, error_mps = 0;
  std::optional<Twist2> twist = Twist2{};
  for (int k = 0; k < 60; ++k) {
    const double now_m = -0.5 * 0.1 * error_mps;  // a scan bent by the error sits half its length off
    twist = smoothed(twist, Twist2{{(now_m - before_m) / 0.1, 0}, 0}, 0.1);
    error_mps = twist->velocity_mps.x();
    before_m = now_m;
  }
  EXPECT_LT(std::abs(error_mps), 1e-3);
}

TEST(WheelError, IsLearntFromMatchedStepsAndForgotten) {
  const Twist2 truth{{0.5, 0}, 1}, slipping{{0.7, 0.2}, 0.6};
  WheelError error;
  EXPECT_NEAR(error.corrected(slipping, truth).turn_radps, 0.6, 1e-9) << "nothing is known yet";
  for (int k = 0; k < 20; ++k) error.learn(Pose2(0.07, 0.02, 0.06), Pose2(0.05, 0, 0.1), 0.1);
  const Twist2 now = error.corrected(slipping, truth);
  EXPECT_NEAR(now.velocity_mps.x(), 0.5, 0.02);
  EXPECT_NEAR(now.velocity_mps.y(), 0.0, 0.02);
  EXPECT_NEAR(now.turn_radps, 1.0, 0.02);
  for (int k = 0; k < 20; ++k) error.learn(Pose2(0.05, 0, 0.1), Pose2(0.05, 0, 0.1), 0.1);
  EXPECT_NEAR(error.corrected(truth, {}).velocity_mps.x(), 0.5, 0.01);
  EXPECT_NEAR(error.corrected(truth, {}).turn_radps, 1, 0.02);
}

// Wheels that turned a tenth and then twice as far as the robot bent a scan by ten times its turn; the map broke.
TEST(WheelError, BendsNoScanMoreThanTheWheelsAlone) {
  std::mt19937_64 random(8);
  for (int i = 0; i < 200; ++i) {
    WheelError error;
    Twist2 truth{{uniform(random, 0, 0.7), 0}, uniform(random, -1, 1)};
    for (int k = 0; k < 40; ++k) {
      const double share = uniform(random, 0.05, 1.95);
      const Twist2 wheels{share * truth.velocity_mps, share * truth.turn_radps};
      const Twist2 now = error.corrected(wheels, truth);
      EXPECT_LE((now.velocity_mps - truth.velocity_mps).norm(),
                (wheels.velocity_mps - truth.velocity_mps).norm() + 1e-9);
      EXPECT_LE(std::abs(now.turn_radps - truth.turn_radps), std::abs(wheels.turn_radps - truth.turn_radps) + 1e-9);
      error.learn(wheels.after(0.1), truth.after(0.1), 0.1);
    }
  }
}

TEST(WheelError, HardlyTouchesWheelsThatAreRight) {
  std::mt19937_64 random(6);
  WheelError error;
  std::optional<Twist2> last = Twist2{};
  for (int k = 0; k < 500; ++k) {
    const double speed = uniform(random, 0, 0.7), turn = uniform(random, -1, 1);
    const Pose2 step(0.1 * speed, 0, 0.1 * turn);
    const Pose2 matched = step * Pose2(normal(random, 0.003), normal(random, 0.003), normal(random, 0.002));
    error.learn(step, matched, 0.1);
    last = smoothed(last, twist_of(matched, 0.1), 0.1);
    const Twist2 now = error.corrected({{speed, 0}, turn}, *last);
    EXPECT_LT((now.velocity_mps - Point2(speed, 0)).norm() * 0.1, 0.012);  // over a scan
    EXPECT_LT(std::abs(now.turn_radps - turn) * 0.1, 0.008);
  }
}

/// A robot that turns to and fro beside a wall; its lidar takes a tenth of a second to turn.
double heading_error_rad(double wheels_turn) {
  std::mt19937_64 random(7);
  const auto walls = test::ring_of_corridors();
  constexpr double kScan_s = 0.1;
  const auto heading = [](double s) { return 1.2 * (1 - std::cos(0.8 * s)); };
  Slam slam;
  double square = 0;
  constexpr int kScans = 150;
  for (int k = 0; k < kScans; ++k) {
    const double begin_s = k * kScan_s;
    LaserScan scan = test::scan_at(walls, {13, 1, heading(begin_s)}, begin_s, random);
    scan.time_increment_s = kScan_s / 180;
    for (std::size_t i = 0; i < 180; ++i) {
      const double at_s = begin_s + static_cast<double>(i) * scan.time_increment_s;
      scan.ranges_m[i] = static_cast<float>(
          test::cast(walls, {13, 1}, heading(at_s) - kPi + static_cast<double>(i) * 2 * kPi / 180, 12));
    }
    for (const double s : {begin_s, begin_s + 0.5 * kScan_s}) {
      Odometry reading;
      reading.stamp = from_seconds(s);
      reading.T_odom_robot = Pose2(0, 0, wheels_turn * heading(s));
      slam.add_odometry(reading);
    }
    const auto outcome = slam.add_scan(scan);
    EXPECT_TRUE(outcome);
    if (outcome) square += std::pow(wrap_angle(outcome->pose.T_map_robot.heading() - heading(begin_s)), 2);
  }
  return std::sqrt(square / kScans);
}

// Scans were straightened by the wheels alone: with wheels 40 % off these headings were off by 0.016 rad, with
// 90 % by 0.031.
TEST(WheelError, LeavesNoBendInScansOfARobotThatTurns) {
  for (const double wheels_turn : {1.0, 0.6, 1.4, 1.9}) EXPECT_LT(heading_error_rad(wheels_turn), 0.011) << wheels_turn;
}

}  // namespace
}  // namespace smokemap
