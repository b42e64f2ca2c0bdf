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

}  // namespace
}  // namespace smokemap
