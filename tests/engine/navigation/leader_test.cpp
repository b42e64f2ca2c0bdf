#include "navigation/leader.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Path path_along(std::vector<Point2> points) {
  Path path;
  path.points = std::move(points);
  for (std::size_t i = 1; i < path.points.size(); ++i) path.length_m += (path.points[i] - path.points[i - 1]).norm();
  return path;
}

/// 20 m to the east, then 10 m to the north.
Path bent_path() { return path_along({{0, 0}, {20, 0}, {20, 10}}); }

TEST(PoseAhead, IsOnThePathAndFacesAlongIt) {
  const Path path = bent_path();
  EXPECT_THAT(pose_ahead(path, {3, 0.4}, 5), test::IsNear(Pose2(8, 0, 0), 1e-12, 1e-12));
  EXPECT_THAT(pose_ahead(path, {18, -1}, 5), test::IsNear(Pose2(20, 3, kPi / 2), 1e-12, 1e-12));
  EXPECT_THAT(pose_ahead(path, {20, 9}, 5), test::IsNear(Pose2(20, 10, kPi / 2), 1e-12, 1e-12))
      << "no farther than the end";
  EXPECT_THAT(pose_ahead(path_along({{1, 1}, {1, 1}, {2, 1}}), {1, 1}, 0.5),
              test::IsNear(Pose2(1.5, 1, 0), 1e-12, 1e-12))
      << "a piece without length";
}

TEST(PoseAhead, IsAsFarAlongThePathAsAskedFromWhereverOneStandsOnIt) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(-3, 3), share(0, 1);
  for (int round = 0; round < 50; ++round) {
    std::vector<Point2> points{{0, 0}};  // always to the east, so that the nearest piece is the one stood on
    for (int i = 0; i < 6; ++i) points.push_back(points.back() + Point2(3.5, step(random)));
    const Path path = path_along(points);
    const Point2 here = points[2] + share(random) * (points[3] - points[2]);
    const double remaining = progress_on(path, here).remaining_m, ahead = share(random) * remaining;
    const Pose2 there = pose_ahead(path, here, ahead);
    EXPECT_NEAR(remaining - progress_on(path, there.translation()).remaining_m, ahead, 1e-6);
  }
}

TEST(Leader, TellsAPlaceAheadAndANewOneOnlyWhenItHasMovedOn) {
  Leader leader({});
  const Path path = bent_path();
  EXPECT_FALSE(leader.leads());
  const auto first = leader.next(path, Pose2(), std::nullopt, Errand::kNone);
  ASSERT_TRUE(first);
  EXPECT_THAT(*first, test::IsNear(Pose2(6, 0, 0), 1e-12, 1e-12));
  EXPECT_TRUE(leader.leads());
  EXPECT_FALSE(leader.next(path, Pose2(1.9, 0, 0), std::nullopt, Errand::kUnderWay)) << "still good";
  const auto second = leader.next(path, Pose2(2.1, 0.2, 0), std::nullopt, Errand::kUnderWay);
  ASSERT_TRUE(second);
  EXPECT_THAT(*second, test::IsNear(Pose2(8.1, 0, 0), 1e-12, 1e-12));
}

TEST(Leader, EndsAtTheGoalInTheHeadingThatWasAskedFor) {
  Leader leader({});
  const auto end = leader.next(bent_path(), Pose2(20, 5, 0), -1.0, Errand::kNone);
  ASSERT_TRUE(end);
  EXPECT_THAT(*end, test::IsNear(Pose2(20, 10, -1.0), 1e-12, 1e-12));
  EXPECT_FALSE(leader.next(bent_path(), Pose2(20, 9.8, 0), -1.0, Errand::kUnderWay));
  EXPECT_FALSE(leader.next(bent_path(), Pose2(20, 9.8, 0), -1.0, Errand::kDone)) << "there is nothing more to say";
  const auto moved = leader.next(path_along({{20, 5}, {20.2, 10}}), Pose2(20, 9.5, 0), -1.0, Errand::kUnderWay);
  ASSERT_TRUE(moved) << "the map under the goal was corrected by 20 cm";
  EXPECT_THAT(moved->translation(), test::IsNearPoint(Point2(20.2, 10), 1e-12));
}

TEST(Leader, AnErrandThatIsDoneOnTheWayIsFollowedByTheNext) {
  Leader leader({});
  ASSERT_TRUE(leader.next(bent_path(), Pose2(), std::nullopt, Errand::kNone));
  const auto next = leader.next(bent_path(), Pose2(5.9, 0, 0), std::nullopt, Errand::kDone);
  ASSERT_TRUE(next);
  EXPECT_THAT(*next, test::IsNear(Pose2(11.9, 0, 0), 1e-12, 1e-12));
}

TEST(Leader, ComesNearerAfterEachFailureAndThenGivesUp) {
  Leader leader({});
  Errand errand = Errand::kNone;
  for (const double ahead_m : {6.0, 3.0, 1.5, 1.5}) {
    const auto place = leader.next(bent_path(), Pose2(), std::nullopt, errand);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->x(), ahead_m, 1e-12);
    EXPECT_FALSE(leader.gave_up());
    errand = Errand::kGivenUp;
  }
  EXPECT_FALSE(leader.next(bent_path(), Pose2(), std::nullopt, errand));
  EXPECT_TRUE(leader.gave_up());
  const Path elsewhere = path_along({{0, 0}, {0, 9}});
  EXPECT_TRUE(leader.next(elsewhere, Pose2(), std::nullopt, Errand::kGivenUp)) << "another goal is another try";
}

TEST(Leader, AnErrandDoneForgetsFailures) {
  Leader leader({});
  ASSERT_TRUE(leader.next(bent_path(), Pose2(), std::nullopt, Errand::kNone));
  for (int i = 0; i < 10; ++i) {
    const double x = 1.4 * i;
    ASSERT_TRUE(leader.next(bent_path(), Pose2(x, 0, 0), std::nullopt, Errand::kGivenUp)) << i;
    ASSERT_TRUE(leader.next(bent_path(), Pose2(x + 1.4, 0, 0), std::nullopt, Errand::kDone)) << i;
  }
  EXPECT_FALSE(leader.gave_up());
}

TEST(LeaderParams, NameTheirFirstFieldOutOfRange) {
  EXPECT_THAT(LeaderParams{}.validate(), test::IsOk());
  LeaderParams params;
  params.ahead_m = params.least_ahead_m / 2;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.patience = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
