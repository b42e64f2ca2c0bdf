#include "simulation/robot_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "simulation/building.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

constexpr Stamp kTick = 10'000'000;

/// A robot in the open (one far wall) that is told the same at every tick.
struct Drill {
  explicit Drill(const DriveParams& params = {}, std::uint64_t seed = 1)
      : drive(params, {}, std::mt19937_64(seed)), world({{{{1e4, 0}, {1e4, 1}}}}) {}

  void go(double speed, double turn, double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += 0.01) {
      drive.command(speed, turn, now);
      now += kTick;
      drive.step(world, kTick, now);
    }
  }
  void leave_alone(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += 0.01) drive.step(world, kTick, now += kTick);
  }

  RobotDrive drive;
  SegmentWorld world;
  Stamp now = 0;
};

DriveParams perfect_wheels() {
  DriveParams params;
  params.sigma_turn_per_turn = params.sigma_turn_per_metre = params.sigma_way_per_metre = params.sigma_way_per_turn = 0;
  params.sigma_scale = params.sigma_turn_scale = params.sigma_bend_rad_per_m = 0;
  return params;
}

TEST(RobotDrive, StopsWhenNobodyCommandsForHalfASecond) {
  Drill drill;
  drill.go(0.5, 0, 3);
  EXPECT_DOUBLE_EQ(drill.drive.speed_mps(), 0.5);
  drill.leave_alone(0.48);
  EXPECT_FALSE(drill.drive.braking());
  EXPECT_DOUBLE_EQ(drill.drive.speed_mps(), 0.5);
  const double before = drill.drive.true_pose().x();
  drill.leave_alone(1.0);
  EXPECT_TRUE(drill.drive.braking());
  EXPECT_EQ(drill.drive.speed_mps(), 0);
  EXPECT_LT(drill.drive.true_pose().x() - before, 0.5 * 0.03 + 0.5 * 0.5 / (2 * 1.6) + 0.01) << "braking way";
  drill.go(0.5, 0, 2);
  EXPECT_DOUBLE_EQ(drill.drive.speed_mps(), 0.5) << "and goes on when told";
}

TEST(RobotDrive, StandsBeforeItsFirstCommand) {
  Drill drill;
  drill.leave_alone(2);
  EXPECT_THAT(drill.drive.true_pose(), test::IsNear(Pose2(), 0, 0));
}

TEST(RobotDrive, KeepsItsLimits) {
  Drill drill;
  drill.go(9, 9, 0.1);
  EXPECT_NEAR(drill.drive.speed_mps(), 0.08, 1e-9) << "0.8 m/s^2 for 0.1 s";
  EXPECT_NEAR(drill.drive.turn_rate_radps(), 0.4, 1e-9);
  drill.go(9, 9, 5);
  EXPECT_DOUBLE_EQ(drill.drive.speed_mps(), 0.7);
  EXPECT_DOUBLE_EQ(drill.drive.turn_rate_radps(), 1.5);
}

TEST(RobotDrive, DrivesACircleBackToItsStart) {
  Drill drill(perfect_wheels());
  drill.go(0.5, 0.5, 2);  // up to speed
  const Pose2 before = drill.drive.true_pose();
  drill.go(0.5, 0.5, 2 * kPi / 0.5);
  EXPECT_THAT(drill.drive.true_pose(), test::IsNear(before, 0.01, 0.01));
  EXPECT_THAT(drill.drive.odometry_pose(), test::IsNear(drill.drive.true_pose(), 1e-9, 1e-9)) << "perfect wheels";
}

TEST(RobotDrive, BumpsIntoAWallOnceAndBacksOff) {
  RobotDrive drive({}, {3, 2, 0}, std::mt19937_64(1));
  const SegmentWorld world = build_world(one_room_building());
  Stamp now = 0;
  const auto go = [&](double speed, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      drive.command(speed, 0, now);
      drive.step(world, kTick, now += kTick);
      EXPECT_GE(world.clearance_m(drive.true_pose().translation(), 1), 0.25 - 1e-9);
    }
  };
  go(0.5, 1000);
  EXPECT_EQ(drive.bumps(), 1);
  EXPECT_EQ(drive.speed_mps(), 0);
  EXPECT_NEAR(drive.true_pose().x(), 6 - 0.15 - 0.25, 0.02);
  go(-0.3, 100);
  EXPECT_LT(drive.true_pose().x(), 5.5);
  go(0.5, 300);
  EXPECT_EQ(drive.bumps(), 2);
}

TEST(RobotDrive, IgnoresCommandsThatAreNoNumbers) {
  Drill drill;
  drill.go(std::nan(""), 0, 1);
  EXPECT_THAT(drill.drive.true_pose(), test::IsNear(Pose2(), 0, 0));
}

TEST(RobotDrive, DriftsWithTheAskedNoise) {
  DriveParams params = perfect_wheels();
  params.sigma_way_per_metre = 0.02;
  params.sigma_turn_per_metre = 0.01;
  double way_squares = 0, turn_squares = 0;
  constexpr int kRuns = 250;
  for (int run = 0; run < kRuns; ++run) {
    Drill drill(params, static_cast<std::uint64_t>(run));
    drill.go(0.5, 0, 12);
    const double way = drill.drive.true_pose().x();
    way_squares += std::pow(drill.drive.odometry_pose().translation().norm() - way, 2) / way;
    turn_squares += std::pow(drill.drive.odometry_pose().heading(), 2) / way;
  }
  EXPECT_NEAR(std::sqrt(way_squares / kRuns), 0.02, 0.002);
  EXPECT_NEAR(std::sqrt(turn_squares / kRuns), 0.01, 0.001);
}

TEST(RobotDrive, HasABiasOfItsOwn) {
  DriveParams params = perfect_wheels();
  params.sigma_bend_rad_per_m = 0.01;
  params.sigma_scale = 0.02;
  double bend_squares = 0, scale_squares = 0;
  for (int run = 0; run < 400; ++run) {
    Drill drill(params, static_cast<std::uint64_t>(run));
    drill.go(0.5, 0, 8);
    const double way = drill.drive.true_pose().x();
    bend_squares += std::pow(drill.drive.odometry_pose().heading() / way, 2) / 400;
    drill.go(0, 0, 1);
    scale_squares +=
        std::pow(drill.drive.odometry_pose().translation().norm() / drill.drive.true_pose().x() - 1, 2) / 400;
  }
  EXPECT_NEAR(std::sqrt(bend_squares), 0.01, 0.0015);
  EXPECT_NEAR(std::sqrt(scale_squares), 0.02, 0.003);
}

TEST(RobotDrive, RefusesNonsense) {
  DriveParams params;
  params.radius_m = -1;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

TEST(RobotDrive, AStepLongerThanAWallIsThickCarriedItThroughTheWall) {
  DriveParams params;
  params.max_speed_mps = 2;
  params.acceleration_mps2 = 20;
  RobotDrive drive(params, {2, 2, 0}, std::mt19937_64(1));
  const SegmentWorld world = build_world(two_room_building());  // a wall of 0.14 m at x = 4
  Stamp now = 0;
  for (int i = 0; i < 40; ++i) {
    drive.command(2, 0, now);
    now += from_seconds(0.5);
    drive.step(world, from_seconds(0.5), now);  // a metre
  }
  EXPECT_LT(drive.true_pose().x(), 4);
  EXPECT_GE(drive.bumps(), 1);
}

TEST(RobotDrive, GainsSpeedEvenlyAndBrakesTwiceAsHard) {
  DriveParams params = perfect_wheels();
  params.max_speed_mps = 5;
  Drill drill(params);
  drill.go(5, 0, 3);
  EXPECT_NEAR(drill.drive.speed_mps(), 0.8 * 3, 1e-9);
  EXPECT_NEAR(drill.drive.true_pose().x(), 0.5 * 0.8 * 9, 0.02) << "a t^2 / 2";
  const double before = drill.drive.true_pose().x();
  drill.go(0, 0, 2.4 / 1.6);
  EXPECT_NEAR(drill.drive.speed_mps(), 0, 1e-9);
  EXPECT_NEAR(drill.drive.true_pose().x() - before, 2.4 * 2.4 / (2 * 1.6), 0.03) << "v^2 / (2 a)";
}

TEST(RobotDrive, DriftsOnTheSpotWithTheAskedNoise) {
  DriveParams params = perfect_wheels();
  params.sigma_turn_per_turn = 0.03;
  params.sigma_way_per_turn = 0.005;
  double turn_squares = 0, way_squares = 0;
  constexpr int kRuns = 300;
  constexpr double kTurned = 10 - 0.125;  // 1 rad/s for 10 s, less what getting up to speed takes
  for (int run = 0; run < kRuns; ++run) {
    Drill drill(params, static_cast<std::uint64_t>(run) + 900);
    drill.go(0, 1, 10);
    const Pose2 off = drill.drive.true_pose().inverse() * drill.drive.odometry_pose();
    EXPECT_NEAR(drill.drive.true_pose().translation().norm(), 0, 1e-12);
    turn_squares += off.heading() * off.heading() / kTurned / kRuns;
    way_squares += off.translation().squaredNorm() / kTurned / kRuns;
  }
  EXPECT_NEAR(std::sqrt(turn_squares), 0.03, 0.004);
  EXPECT_NEAR(std::sqrt(way_squares), 0.005, 0.0008) << "ways in all directions add up like one";
}

TEST(RobotDrive, HasTheSameDriftInLongStepsAsInShortOnes) {
  DriveParams params = perfect_wheels();
  params.sigma_way_per_metre = 0.05;
  const auto spread = [&](Stamp step) {
    double squares = 0;
    for (std::uint64_t run = 0; run < 200; ++run) {
      RobotDrive drive(params, {}, std::mt19937_64(run));
      const SegmentWorld world({{{{1e4, 0}, {1e4, 1}}}});
      for (Stamp now = 0; now < from_seconds(10);) {
        drive.command(0.5, 0, now);
        drive.step(world, step, now += step);
      }
      squares += std::pow(drive.odometry_pose().x() - drive.true_pose().x(), 2) / drive.true_pose().x() / 200;
    }
    return std::sqrt(squares);
  };
  EXPECT_NEAR(spread(from_seconds(0.01)), 0.05, 0.006);
  EXPECT_NEAR(spread(from_seconds(0.25)), 0.05, 0.006);
}

TEST(RobotDrive, NeverEntersAWallWhateverItIsTold) {
  const SegmentWorld world = build_world(corridor_building());
  int bumps = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    std::mt19937_64 random(seed);
    RobotDrive drive({}, {7, 6, uniform(random, -3, 3)}, std::mt19937_64(seed));
    double speed = 0, turn = 0;
    Stamp now = 0;
    for (int i = 0; i < 4000; ++i) {
      if (i % 50 == 0) speed = uniform(random, -1, 1), turn = uniform(random, -2, 2);
      drive.command(speed, turn, now);
      drive.step(world, kTick, now += kTick);
      ASSERT_GE(world.clearance_m(drive.true_pose().translation(), 1), 0.25 - 1e-9) << "seed " << seed << " step " << i;
    }
    bumps += drive.bumps();
  }
  EXPECT_GT(bumps, 0);
}

}  // namespace
}  // namespace smokemap
