#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "navigation/follower.hpp"
#include "navigation/obstacle_watch.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Path path_over(std::vector<Point2> points) {
  Path path;
  for (std::size_t i = 1; i < points.size(); ++i) path.length_m += (points[i] - points[i - 1]).norm();
  path.points = std::move(points);
  return path;
}

Pose2 moved(const Pose2& pose, const Twist& twist, double dt) {
  return pose * Pose2(twist.speed_mps * dt, 0, twist.turn_rate_radps * dt);
}

TEST(ProgressOnAPath, AgreesWithTryingEveryPointOfIt) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 50; ++round) {
    std::vector<Point2> points;
    for (int i = 0; i < 6; ++i) points.emplace_back(uniform(random, -5, 5), uniform(random, -5, 5));
    const Path path = path_over(points);
    const Point2 p(uniform(random, -6, 6), uniform(random, -6, 6));
    double best = 1e9, remaining = 0, gone = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Point2 step = points[i] - points[i - 1];
      for (int k = 0; k <= 4000; ++k) {
        const double share = k / 4000.0, away = (points[i - 1] + share * step - p).norm();
        if (away < best) best = away, remaining = path.length_m - gone - share * step.norm();
      }
      gone += step.norm();
    }
    const PathProgress progress = progress_on(path, p);
    EXPECT_NEAR(progress.off_path_m, best, 1e-3);
    EXPECT_NEAR(progress.remaining_m, remaining, 0.01);
  }
}

TEST(ProgressOnAPath, TakesTheLaterOfTwoEquallyNearPieces) {
  const Path there_and_back = path_over({{0, 0}, {4, 0}, {4, 0.2}, {0, 0.2}});
  EXPECT_EQ(progress_on(there_and_back, {2, 0.1}).piece, 2u) << "nobody drives a loop twice";
}

TEST(Following, EndsOnRandomPathsFromRandomHeadings) {
  std::mt19937_64 random(5);
  const FollowerParams params;
  for (int round = 0; round < 40; ++round) {
    std::vector<Point2> points{{0, 0}};
    for (int i = 0; i < 4; ++i)
      points.push_back(points.back() + Point2(uniform(random, 0.6, 2.5), uniform(random, -1.5, 1.5)));
    const Path path = path_over(points);
    Pose2 pose(0, 0, uniform(random, -3.1, 3.1));
    double worst = 0, time_s = 0;
    for (; time_s < 120 && (pose.translation() - points.back()).norm() > 0.1; time_s += 0.05) {
      const Twist twist = follow(path, pose, params);
      EXPECT_GE(twist.speed_mps, 0);
      EXPECT_LE(twist.speed_mps, params.max_speed_mps);
      EXPECT_LE(std::abs(twist.turn_rate_radps), params.max_turn_rate_radps);
      pose = moved(pose, twist, 0.05);
      worst = std::max(worst, progress_on(path, pose.translation()).off_path_m);
    }
    EXPECT_LT((pose.translation() - points.back()).norm(), 0.11) << "round " << round;
    EXPECT_LT(worst, 0.35) << "corners are cut, not left";
  }
}

TEST(Following, TurnsOnTheSpotBeforeItDrivesAway) {
  const Path ahead = path_over({{0, 0}, {5, 0}});
  for (const double heading : {2.0, -2.0, 3.1}) {
    const Twist twist = follow(ahead, Pose2(0, 0, heading), {});
    EXPECT_EQ(twist.speed_mps, 0);
    EXPECT_LT(twist.turn_rate_radps * heading, 0) << "the shorter way round";
  }
  EXPECT_NEAR(follow(ahead, Pose2(0, 0, 0), {}).speed_mps, FollowerParams{}.max_speed_mps, 1e-9);
  EXPECT_LT(follow(ahead, Pose2(4.9, 0, 0), {}).speed_mps, 0.1) << "slow at the end";
}

TEST(Following, IsTheSameInEveryFrame) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 50; ++round) {
    const Path path = path_over({{0, 0}, {2, 1}, {4, 0}});
    const Pose2 pose(uniform(random, -1, 4), uniform(random, -1, 1), uniform(random, -3, 3));
    const Pose2 shift(uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -3, 3));
    Path shifted = path;
    for (Point2& p : shifted.points) p = shift * p;
    const Twist here = follow(path, pose, {}), there = follow(shifted, shift * pose, {});
    EXPECT_NEAR(here.speed_mps, there.speed_mps, 1e-9);
    EXPECT_NEAR(here.turn_rate_radps, there.turn_rate_radps, 1e-9);
  }
}

TEST(IsClear, ReachesFurtherTheFasterTheRobot) {
  const std::vector<Point2> wall{{0.5, -0.1}, {0.5, 0}, {0.5, 0.1}};
  EXPECT_FALSE(is_clear({0.5, 0}, wall, {}));
  EXPECT_TRUE(is_clear({0.1, 0}, wall, {}));
  const std::vector<Point2> noise{{0.4, 0}, {0.4, 0.01}};
  EXPECT_TRUE(is_clear({0.5, 0}, noise, {})) << "two echoes are noise";
  const std::vector<Point2> behind{{-0.35, 0}, {-0.35, 0.1}, {-0.35, -0.1}};
  EXPECT_TRUE(is_clear({0.5, 0}, behind, {}));
  EXPECT_FALSE(is_clear({-0.15, 0}, behind, {})) << "it looks where it goes";
}

/// The oracle: the disc moved in small steps along the arc.
bool keeps_clear(const Twist& twist, const Point2& p, const FollowerParams& params) {
  Pose2 at;
  for (double t = 0; t < params.stop_time_s; t += 0.002) {
    at = at * Pose2(twist.speed_mps * 0.002, 0, twist.turn_rate_radps * 0.002);
    const double away = (at.translation() - p).norm();
    if (away < params.robot_radius_m + params.margin_m && away < p.norm() - 1e-3) return false;
  }
  return true;
}

TEST(IsClear, AgreesWithMovingTheDiscInSmallSteps) {
  std::mt19937_64 random(9);
  const FollowerParams params;
  int blocked = 0, different = 0;
  for (int i = 0; i < 2000; ++i) {
    const Twist twist{uniform(random, -0.5, 0.5), uniform(random, -1, 1)};
    const Point2 p(uniform(random, -0.8, 0.8), uniform(random, -0.8, 0.8));
    const bool clear = keeps_clear(twist, p, params);
    blocked += !clear;
    different += is_clear(twist, {p, p, p}, params) != clear;
  }
  EXPECT_GT(blocked, 100);
  EXPECT_LT(different, 20) << "between two of its steps a centimetre may be missed";
}

TEST(SteerClear, PassesAJambBesideTheWayInsteadOfScrapingIt) {
  const FollowerParams params;
  std::vector<Point2> jamb;
  for (int i = 0; i < 6; ++i) jamb.emplace_back(0.30 + 0.01 * i, -0.27);
  const Twist wanted{0.5, 0};
  ASSERT_FALSE(is_clear(wanted, jamb, params));
  const auto twist = steer_clear(wanted, jamb, params);
  ASSERT_TRUE(twist);
  EXPECT_GT(twist->speed_mps, 0);
  EXPECT_GT(twist->turn_rate_radps, 0) << "away from it";
  EXPECT_TRUE(is_clear(*twist, jamb, params));
}

TEST(SteerClear, LetsBeWhatIsClearAndStandsWhereNothingIs) {
  const FollowerParams params;
  const auto same = steer_clear({0.4, 0.2}, {}, params);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->speed_mps, 0.4);
  EXPECT_EQ(same->turn_rate_radps, 0.2);
  std::vector<Point2> wall;
  for (int i = -40; i <= 40; ++i) wall.emplace_back(0.30, 0.02 * i);
  EXPECT_FALSE(steer_clear({0.5, 0}, wall, params));
  EXPECT_TRUE(steer_clear({0, 0.5}, wall, params)) << "a disc may turn";
}

TEST(SteerClear, NeverTouchesWhateverStandsAround) {
  std::mt19937_64 random(10);
  const FollowerParams params;
  for (int i = 0; i < 300; ++i) {
    std::vector<Point2> around;
    for (int k = 0; k < 12; ++k) {
      const Point2 p(uniform(random, -0.9, 0.9), uniform(random, -0.9, 0.9));
      if (p.norm() > params.robot_radius_m) around.insert(around.end(), 3, p);
    }
    const auto twist = steer_clear({0.5, uniform(random, -1, 1)}, around, params);
    if (!twist) continue;
    for (const Point2& p : around) {
      Pose2 at;
      for (double t = 0; t < params.stop_time_s; t += 0.01)
        at = at * Pose2(twist->speed_mps * 0.01, 0, twist->turn_rate_radps * 0.01);
      EXPECT_GT((at.translation() - p).norm(), params.robot_radius_m - 0.01);
    }
  }
}

/// A scan of a straight wall `distance_m` ahead; beams of `holes` go on to 8 m.
LaserScan wall_scan(Stamp stamp, double distance_m, const std::vector<int>& holes = {}) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.angle_min_rad = -0.5;
  scan.angle_increment_rad = 0.01;
  scan.range_max_m = 15;
  for (int i = 0; i <= 100; ++i) scan.ranges_m.push_back(static_cast<float>(distance_m / std::cos(-0.5 + 0.01 * i)));
  for (const int hole : holes) scan.ranges_m[static_cast<std::size_t>(hole)] = 8;
  return scan;
}

TEST(ObstacleWatch, SeesAWallWhileTheRobotDrivesTowardsIt) {
  ObstacleWatch watch;
  Pose2 pose;
  for (int i = 0; i < 8; ++i, pose = pose * Pose2(0.05, 0, 0)) watch.add_scan(wall_scan(i, 1.2 - 0.05 * i), pose);
  const Pose2 now(0.05 * 7, 0, 0);
  const auto obstacles = watch.obstacles_robot(now);
  ASSERT_GT(obstacles.size(), 50u);
  for (const Point2& p : obstacles) EXPECT_NEAR(p.x(), 1.2 - 0.05 * 7, 1e-5);
}

TEST(ObstacleWatch, ForgetsWhatIsFarAndWhatHasGone) {
  ObstacleWatch watch;
  watch.add_scan(wall_scan(0, 3.0), Pose2());
  EXPECT_TRUE(watch.obstacles_robot(Pose2()).empty()) << "three metres stop nobody";
  for (int i = 1; i <= 3; ++i) watch.add_scan(wall_scan(i, 0.8), Pose2());
  EXPECT_FALSE(watch.obstacles_robot(Pose2()).empty());
  for (int i = 4; i <= 9; ++i) watch.add_scan(wall_scan(i, 8.0), Pose2());
  EXPECT_TRUE(watch.obstacles_robot(Pose2()).empty());
}

TEST(ObstacleWatch, TakesEchoesThatOthersPassThroughForSmoke) {
  ObstacleWatch watch;
  std::mt19937_64 random(7);
  for (int i = 0; i < 6; ++i) {  // echoes here and there in a cloud, most beams go through
    LaserScan scan = wall_scan(i, 8.0);
    for (float& range : scan.ranges_m)
      if (uniform_index(random, 6) == 0) range = static_cast<float>(uniform(random, 0.5, 1.1));
    watch.add_scan(scan, Pose2());
  }
  EXPECT_LT(watch.obstacles_robot(Pose2()).size(), 4u);
}

TEST(ObstacleParams, NameWhatIsOutOfRange) {
  ObstacleParams params;
  params.most_through = 2;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  FollowerParams follower;
  follower.stop_points = 0;
  EXPECT_THAT(follower.validate(), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
