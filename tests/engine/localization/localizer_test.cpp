#include "localization/localizer.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "simulation/segment_world.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::IsNear;
using test::IsOk;

/// Two rooms, a corridor and a niche: no two places look alike.
std::vector<Segment2> small_flat() {
  return {{{0, 0}, {10, 0}},  {{10, 0}, {10, 7}},     {{10, 7}, {0, 7}},    {{0, 7}, {0, 0}},
          {{4, 0}, {4, 2.5}}, {{4, 3.5}, {4, 7}},     {{4, 4.5}, {7, 4.5}}, {{8, 4.5}, {10, 4.5}},
          {{6, 0}, {6, 1.2}}, {{6, 1.2}, {7.5, 1.2}}, {{0, 5}, {1.5, 5}}};
}

std::vector<Point2> scan_from(const SegmentWorld& world, const Pose2& pose, std::mt19937_64& random) {
  std::vector<Point2> hits;
  for (int i = 0; i < 180; ++i) {
    const double bearing = i * kPi / 90;
    const auto hit = world.cast(pose.translation(), pose.heading() + bearing, 12);
    if (!hit) continue;
    const double range = hit->range_m + normal(random, 0.02);
    hits.emplace_back(range * std::cos(bearing), range * std::sin(bearing));
  }
  return hits;
}

struct Flat {
  explicit Flat(double stretch = 1) {
    std::vector<WorldSegment> true_walls;
    for (const Segment2& s : small_flat()) {
      true_walls.push_back({s});
      drawn.push_back({{{stretch * s.a.x(), s.a.y()}, {stretch * s.b.x(), s.b.y()}}, 0});
    }
    world = SegmentWorld(true_walls);
  }
  SegmentWorld world;
  std::vector<LocalizerWall> drawn;
};

/// Around the left room, through the door and into the right one.
std::vector<Pose2> some_way() {
  std::vector<Pose2> way{{1, 1.5, 0}};
  const auto drive = [&](double metres, double turn) {
    for (int i = 0; i < 8; ++i) way.push_back(way.back() * Pose2(metres / 8, 0, turn / 8));
  };
  drive(1.5, 0.9), drive(2, 0.5), drive(1, -1.4), drive(3.0, -0.2), drive(1.5, -0.6);
  return way;
}

/// Drives the way with noisy odometry and returns the localizer at its end.
Localizer drive(const Flat& flat, const std::vector<Pose2>& way, Localizer localizer, std::uint64_t seed) {
  auto random = random_stream(seed, 1);
  for (std::size_t i = 0; i < way.size(); ++i) {
    Pose2 step = i == 0 ? Pose2() : way[i - 1].inverse() * way[i];
    if (i > 0)
      step = Pose2(step.x() + normal(random, 0.02), step.y() + normal(random, 0.02),
                   step.heading() + normal(random, 0.02));
    localizer.update(step, scan_from(flat.world, way[i], random));
  }
  return localizer;
}

TEST(Localizer, FollowsARobotFromAnInexactStart) {
  const Flat flat;
  const auto way = some_way();
  Localizer localizer({}, 3);
  localizer.set_walls(flat.drawn);
  localizer.start_at(way.front() * Pose2(0.25, -0.2, 0.06), 0.3, 0.08);
  const auto answer = drive(flat, way, std::move(localizer), 5).estimate();
  EXPECT_FALSE(answer.lost);
  EXPECT_THAT(answer.T_map_robot, IsNear(way.back(), 0.12, 0.05));
  EXPECT_GT(answer.explained, 0.8);
}

TEST(Localizer, ToleratesAPlanStretchedByTenPercent) {
  const Flat flat(1.1);
  const auto way = some_way();
  Localizer localizer({}, 3);
  localizer.set_walls(flat.drawn);
  localizer.start_at(way.front(), 0.3, 0.05);
  const auto answer = drive(flat, way, std::move(localizer), 6).estimate();
  EXPECT_FALSE(answer.lost);
  const Pose2 expected(1.1 * way.back().x(), way.back().y(), way.back().heading());
  EXPECT_THAT(answer.T_map_robot, IsNear(expected, 0.45, 0.10));
}

TEST(Localizer, FindsItselfWithoutAnyHint) {
  const Flat flat;
  const auto way = some_way();
  int found = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Localizer localizer({}, seed);
    localizer.set_walls(flat.drawn);
    localizer.start_anywhere();
    EXPECT_TRUE(localizer.estimate().lost);
    const auto answer = drive(flat, way, std::move(localizer), seed).estimate();
    found += !answer.lost && (answer.T_map_robot.translation() - way.back().translation()).norm() < 0.3;
  }
  EXPECT_GE(found, 4);
}

TEST(Localizer, SaysThatItIsLostInTheWrongBuilding) {
  const Flat flat;
  const auto way = some_way();
  std::vector<LocalizerWall> other;
  for (int i = 0; i < 6; ++i) other.push_back({{{2.3 * i, 9}, {2.3 * i + 3, 15}}, 0.1});
  Localizer localizer({}, 3);
  localizer.set_walls(other);
  localizer.start_at(Pose2(3, 11, 0), 0.3, 0.1);
  EXPECT_TRUE(drive(flat, way, std::move(localizer), 7).estimate().lost);
}

TEST(Localizer, SaysThatItIsLostWhereTwoRoomsLookAlike) {
  std::vector<WorldSegment> walls;
  std::vector<LocalizerWall> drawn;
  for (const double x : {0.0, 20.0})
    for (const Segment2& s : {Segment2{{x, 0}, {x + 5, 0}}, Segment2{{x + 5, 0}, {x + 5, 3}},
                              Segment2{{x + 5, 3}, {x, 3}}, Segment2{{x, 3}, {x, 0}}}) {
      walls.push_back({s});
      drawn.push_back({s, 0});
    }
  const SegmentWorld world(walls);
  auto random = random_stream(21, 1);
  Localizer localizer({}, 4);
  localizer.set_walls(drawn);
  localizer.start_anywhere();
  Pose2 pose(1.5, 1.2, 0.1);
  int claimed = 0;
  for (int i = 0; i < 12; ++i) {
    localizer.update(i == 0 ? Pose2() : Pose2(0.15, 0, 0.02), scan_from(world, pose, random));
    pose = pose * Pose2(0.15, 0, 0.02);
    claimed += !localizer.estimate().lost;
  }
  EXPECT_LE(claimed, 3);
}

TEST(Localizer, StandsWhereAPersonSaysAndForgetsWhatItThoughtBefore) {
  const Flat flat;
  Localizer localizer({}, 5);
  localizer.set_walls(flat.drawn);
  localizer.start_anywhere();
  const Pose2 said(8.5, 2, 1.2);
  localizer.start_at(said, 0.1, 0.03);
  EXPECT_THAT(localizer.estimate().T_map_robot, IsNear(said, 0.05, 0.02));
  EXPECT_FALSE(localizer.estimate().lost);
  auto random = random_stream(22, 1);
  for (int i = 0; i < 5; ++i) localizer.update(Pose2(), scan_from(flat.world, said, random));
  EXPECT_THAT(localizer.estimate().T_map_robot, IsNear(said, 0.1, 0.04));
}

TEST(Localizer, NoticesThatItWasCarriedAwayAndFindsItsWayBack) {
  const Flat flat;
  const auto way = some_way();
  Localizer localizer({}, 6);
  localizer.set_walls(flat.drawn);
  localizer.start_at(Pose2(8.5, 6, 0.5), 0.2, 0.1);  // the robot is in another room
  auto random = random_stream(23, 1);
  bool noticed = false;
  for (std::size_t i = 0; i < way.size(); ++i) {
    localizer.update(i == 0 ? Pose2() : way[i - 1].inverse() * way[i], scan_from(flat.world, way[i], random));
    noticed = noticed || localizer.estimate().lost;
  }
  EXPECT_TRUE(noticed);
}

TEST(Localizer, AnswersTheSameForTheSameSeed) {
  const Flat flat;
  const auto way = some_way();
  const auto run = [&] {
    Localizer localizer({}, 11);
    localizer.set_walls(flat.drawn);
    localizer.start_anywhere();
    return drive(flat, way, std::move(localizer), 8).estimate();
  };
  const auto one = run(), two = run();
  EXPECT_EQ(one.T_map_robot.vector(), two.T_map_robot.vector());
  EXPECT_EQ(one.covariance, two.covariance);
  EXPECT_EQ(one.particles, two.particles);
}

TEST(Localizer, UsesFewerParticlesOnceItKnows) {
  const Flat flat;
  Localizer localizer({}, 2);
  localizer.set_walls(flat.drawn);
  localizer.start_anywhere();
  const int before = localizer.estimate().particles;
  EXPECT_LT(drive(flat, some_way(), std::move(localizer), 2).estimate().particles, before / 2);
}

TEST(Localizer, WithoutWallsOrStartIsLostAndUnharmed) {
  Localizer localizer;
  localizer.update(Pose2(1, 0, 0), {Point2(1, 1)});
  EXPECT_TRUE(localizer.estimate().lost);
  localizer.set_walls({});
  localizer.start_at(Pose2(), 0.1, 0.1);
  localizer.update(Pose2(1, 0, 0), {});
  EXPECT_TRUE(localizer.estimate().lost);
}

TEST(LocalizerParams, AreChecked) {
  EXPECT_THAT(LocalizerParams{}.validate(), IsOk());
  LocalizerParams bad;
  bad.sigma_hit_m = 0;
  EXPECT_FALSE(bad.validate().ok());
}

}  // namespace
}  // namespace smokemap
