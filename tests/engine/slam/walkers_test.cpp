// People who walk with the robot, told from what stands: flags against what every beam truly hit.
#include "slam/walkers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/slam.hpp"
#include "tests/engine/slam/toy_world.hpp"

namespace smokemap {
namespace {

constexpr double kStep_m = 0.1;
constexpr int kBeams = 360;

std::vector<Segment2> bare_corridor() { return {{{-20, -1.2}, {40, -1.2}}, {{-20, 1.2}, {40, 1.2}}}; }

void add_disc(std::vector<Segment2>& walls, const Point2& middle, double radius_m) {
  constexpr int kSides = 12;
  const auto corner = [&](int i) {
    return Point2(middle + radius_m * Point2(std::cos(2 * kPi * i / kSides), std::sin(2 * kPi * i / kSides)));
  };
  for (int i = 0; i < kSides; ++i) walls.push_back({corner(i), corner(i + 1)});
}

/// A robot that drives along x, scan after scan, and what is made of the beams that hit something it is asked about.
class CorridorDrive {
 public:
  explicit CorridorDrive(WalkerParams params = {}) : walkers_(params) {}

  /// @param things  middles of discs of 0.25 m at this scan
  void scan(double x, const std::vector<Point2>& things, const std::vector<Segment2>& walls = bare_corridor()) {
    std::vector<Segment2> all = walls;
    for (const Point2& thing : things) add_disc(all, thing, 0.25);
    at_ = Pose2(x, 0, 0);
    scan_ = test::scan_at(all, at_, 0, random_, kBeams);
    const HitRanges hits(scan_, {});
    view_ = walkers_.look(scan_, hits, at_);
    walkers_.remember(scan_, hits, at_);
  }
  /// Share of the beams that end within 0.4 m of a place.
  double share(const std::vector<bool>& flags, const Point2& p) const {
    int asked = 0, flagged = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      const double angle = scan_.angle_min_rad + static_cast<double>(i) * scan_.angle_increment_rad;
      const Point2 end =
          at_ * Point2(static_cast<double>(scan_.ranges_m[i]) * Point2(std::cos(angle), std::sin(angle)));
      if (!((end - p).norm() < 0.4)) continue;
      ++asked;
      flagged += flags[i];
    }
    return asked > 0 ? static_cast<double>(flagged) / asked : -1;
  }
  double unproven(const Point2& p) const { return share(view_.unproven, p); }
  double moving(const Point2& p) const { return share(view_.moving, p); }
  long flagged() const { return std::count(view_.unproven.begin(), view_.unproven.end(), true); }

 private:
  Walkers walkers_;
  std::mt19937_64 random_{3};
  LaserScan scan_;
  Pose2 at_;
  WalkerView view_;
};

TEST(Walkers, NeverBelieveWhoKeepsHisPlaceBeforeOrBehindTheRobot) {
  for (const double ahead : {1.5, 3.0, -1.5}) {
    CorridorDrive drive;
    for (double x = 0; x < 5; x += kStep_m) {
      drive.scan(x, {{x + ahead, 0.1}});
      EXPECT_EQ(drive.unproven({x + ahead, 0.1}), 1) << "at " << x << ", ahead " << ahead;
    }
  }
}

TEST(Walkers, BelieveAPillarOnceItsPlaceWasSeenTakenFromFartherBack) {
  CorridorDrive drive;
  const Point2 pillar(4, 0.5);
  for (double x = 0; x < 0.55; x += kStep_m) {
    drive.scan(x, {pillar});
    EXPECT_EQ(drive.unproven(pillar), 1) << "at " << x;
  }
  for (double x = 0.7; x < 3; x += kStep_m) {
    drive.scan(x, {pillar});
    EXPECT_EQ(drive.unproven(pillar), 0) << "at " << x;
  }
}

TEST(Walkers, BelieveNobodyWhoStoodAndThenGoesAlong) {
  CorridorDrive drive;
  for (double x = 0; x < 1.05; x += kStep_m) drive.scan(x, {{3, 0}});
  EXPECT_EQ(drive.unproven({3, 0}), 0);
  for (double gone = kStep_m; gone < 3; gone += kStep_m) {
    drive.scan(1 + gone, {{3 + gone, 0}});
    if (gone > 0.25) {
      EXPECT_EQ(drive.unproven({3 + gone, 0}), 1) << "after " << gone;
    }
  }
}

TEST(Walkers, SeeThatSomebodyComesThroughWhatWasFree) {
  CorridorDrive drive;
  for (double x = 0; x < 1.05; x += kStep_m) drive.scan(x, {});
  drive.scan(1.1, {{4, 0.3}});
  EXPECT_EQ(drive.moving({4, 0.3}), 1);
  EXPECT_GE(drive.unproven({4, 0.3}), drive.moving({4, 0.3}));
}

TEST(Walkers, AreAlsoWhoStandsHalfBehindAnother) {
  CorridorDrive drive;
  for (double x = 0; x < 3; x += kStep_m) drive.scan(x, {{x + 1.5, 0}, {x + 2.6, 0.42}});
  EXPECT_EQ(drive.unproven({4.4, 0}), 1);
  EXPECT_EQ(drive.unproven({5.5, 0.42}), 1);
}

TEST(Walkers, AreNoWallsJambsOrNiches) {
  std::vector<Segment2> walls = test::ring_of_corridors();
  std::mt19937_64 random(5);
  Walkers walkers({});
  for (const Pose2& at : test::rounds(1, 0.3)) {
    const LaserScan scan = test::scan_at(walls, at, 0, random, kBeams);
    const HitRanges hits(scan, {});
    const WalkerView view = walkers.look(scan, hits, at);
    EXPECT_LE(std::count(view.unproven.begin(), view.unproven.end(), true), 0.02 * kBeams) << at.translation();
    walkers.remember(scan, hits, at);
  }
}

TEST(Walkers, ProveNothingByTremblingOnTheSpot) {
  CorridorDrive drive;
  for (int i = 0; i < 200; ++i) drive.scan(i % 2 == 0 ? 0.0 : 0.03, {{2, 0}});
  EXPECT_EQ(drive.unproven({2, 0}), 1);
}

TEST(Walkers, HaveToBeBelievedWhereHardlyAnythingElseIsSeen) {
  CorridorDrive drive;
  const std::vector<Segment2> nothing;
  for (double x = 0; x < 0.5; x += kStep_m) drive.scan(x, {{3, 0}, {2, 2}, {2, -2}}, nothing);
  EXPECT_EQ(drive.flagged(), 0) << "three pillars in an open field are all there is";
}

TEST(Walkers, NeedNoParametersOutOfRange) {
  WalkerParams params;
  EXPECT_TRUE(params.validate());
  params.proof_m = 0.5 * params.same_place_m;
  EXPECT_FALSE(params.validate()) << "whoever walks would be taken for the same";
}

/// Where SLAM is after 15 m along a corridor that says nothing along itself, by the lidar or by the radar alone.
/// @param people_at_m  where two people walk who keep their place, from the robot; nothing: nobody
Pose2 driven(std::optional<double> people_at_m, bool by_radar, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  test::Wheels wheels(1.01, 0, 0.02, seed);
  Slam slam(SlamParams{});
  const double step_m = by_radar ? 0.2 : kStep_m;
  double seconds = 0;
  for (double x = 0; x <= 15; x += step_m, seconds += 2 * step_m) {
    std::vector<Segment2> walls = bare_corridor();
    if (people_at_m) {
      add_disc(walls, {x + *people_at_m, 0.3}, 0.25);
      add_disc(walls, {x + *people_at_m + 1, -0.3}, 0.25);
    }
    const Pose2 at(x, 0, 0);
    slam.add_odometry(wheels.read(at, seconds));
    if (by_radar)
      EXPECT_TRUE(slam.add_sweep(test::sweep_at(walls, at, seconds, random)));
    else
      EXPECT_TRUE(slam.add_scan(test::scan_at(walls, at, seconds, random)));
  }
  return slam.latest_pose().T_map_robot;
}

TEST(Slam, IsNotHeldBackByPeopleWhoWalkBeforeOrBehindTheRobot) {
  for (const bool by_radar : {false, true})
    for (const double at_m : {1.5, -2.5})
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const Pose2 alone = driven({}, by_radar, seed), led = driven(at_m, by_radar, seed);
        EXPECT_NEAR(alone.translation().x(), 15, 0.6) << "what the wheels are off";
        EXPECT_NEAR(led.translation().x(), alone.translation().x(), by_radar ? 0.3 : 0.15)
            << (by_radar ? "radar" : "lidar") << ", people at " << at_m << ", seed " << seed;
        EXPECT_NEAR(led.heading(), 0, by_radar ? 0.03 : 0.01);
      }
}

}  // namespace
}  // namespace smokemap
