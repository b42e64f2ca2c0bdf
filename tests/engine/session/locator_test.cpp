#include "session/locator.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "simulation/segment_world.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A square room of 6 m with nothing in it: every quarter turn looks the same.
std::vector<Segment2> bare_square() { return {{{0, 0}, {6, 0}}, {{6, 0}, {6, 6}}, {{6, 6}, {0, 6}}, {{0, 6}, {0, 0}}}; }

/// The same with a wall, a pillar and a niche.
std::vector<Segment2> odd_square() {
  auto walls = bare_square();
  for (const Segment2& s : std::vector<Segment2>{{{2, 0}, {2, 2.2}}, {{4, 4.6}, {6, 4.6}}, {{0, 5}, {1.2, 5}}})
    walls.push_back(s);
  return walls;
}

struct WalledPlace {
  explicit WalledPlace(const std::vector<Segment2>& segments) {
    std::vector<WorldSegment> true_walls;
    for (const Segment2& s : segments) true_walls.push_back({s}), walls.push_back({s, 0});
    world = SegmentWorld(true_walls);
  }
  std::vector<Point2> scan(const Pose2& pose) const {
    std::vector<Point2> hits;
    for (int i = 0; i < 120; ++i)
      if (const auto hit = world.cast(pose.translation(), pose.heading() + i * kPi / 60, 12))
        hits.emplace_back(hit->range_m * std::cos(i * kPi / 60), hit->range_m * std::sin(i * kPi / 60));
    return hits;
  }
  SegmentWorld world;
  std::vector<LocalizerWall> walls;
};

/// Round and round on a circle of 1.3 m; true until the locator is sure, or `steps` are over.
Pose2 circle(Locator& locator, const WalledPlace& place, int steps) {
  Pose2 pose(3, 1.6, 0);
  for (int i = 0; i < steps && !locator.sure(); ++i) {
    const Pose2 next = pose * Pose2(0.3, 0, 0.3 / 1.3);
    locator.step(pose.inverse() * next, place.scan(next));
    pose = next;
  }
  return pose;
}

TEST(Locator, IsSureSoonWhenAPersonSaidWhereTheRobotIs) {
  const WalledPlace place(odd_square());
  Locator locator;
  locator.set_walls(place.walls);
  locator.start_at(Pose2(3.2, 1.5, 0.05), 0.3, 0.1);
  const Pose2 truth = circle(locator, place, 20);
  ASSERT_TRUE(locator.sure());
  EXPECT_THAT(locator.estimate().T_map_robot, test::IsNear(truth, 0.15, 0.05));
}

TEST(Locator, FindsTheRobotWithoutAHintAfterSomeMetres) {
  const WalledPlace place(odd_square());
  int found = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Locator locator({}, seed);
    locator.set_walls(place.walls);
    locator.start_anywhere();
    const Pose2 truth = circle(locator, place, 120);
    if (!locator.sure()) continue;
    const bool right = (locator.estimate().T_map_robot.translation() - truth.translation()).norm() < 0.3;
    found += right, wrong += !right;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(found, 3);
}

TEST(Locator, DoesNotChooseBetweenPlacesThatLookAlike) {
  const WalledPlace place(bare_square());
  int sure = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Locator locator({}, seed);
    locator.set_walls(place.walls);
    locator.start_anywhere();
    circle(locator, place, 60);
    sure += locator.sure();
  }
  EXPECT_LE(sure, 2) << "three filters agree by chance once in sixteen";
}

TEST(Locator, IsNotSureInAnotherBuilding) {
  const WalledPlace place(odd_square());
  std::vector<LocalizerWall> other;
  for (int i = 0; i < 6; ++i) other.push_back({{{2.3 * i, 9}, {2.3 * i + 3, 15}}, 0.1});
  Locator locator;
  locator.set_walls(other);
  locator.start_at(Pose2(3, 11, 0), 0.3, 0.1);
  circle(locator, place, 60);
  EXPECT_FALSE(locator.sure());
}

TEST(Locator, IgnoresStepsBeforeItsStartAndStepsThatAreNoNumbers) {
  Locator locator;
  locator.step(Pose2(1, 0, 0), {{1, 1}});
  EXPECT_FALSE(locator.started());
  EXPECT_FALSE(locator.sure());
  locator.start_at(Pose2(), 0.1, 0.1);
  locator.step(Pose2(std::nan(""), 0, 0), {{1, 1}});
  EXPECT_TRUE(locator.estimate().T_map_robot.is_finite());
}

TEST(LocatorParams, NameTheirFirstFieldOutOfRange) {
  LocatorParams params;
  params.witnesses = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(LocatorParams{}.validate(), test::IsOk());
}

}  // namespace
}  // namespace smokemap
