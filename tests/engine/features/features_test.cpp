#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "features/corners.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsNearPoint;
using test::IsOk;

void sample(std::vector<PosedHit>& hits, const Segment2& wall, const Point2& seen_from, double sigma_m,
            std::mt19937_64& random) {
  const int count = static_cast<int>(wall.length() / 0.05);
  for (int i = 0; i <= count; ++i) {
    const Point2 p = wall.a + (wall.b - wall.a) * (static_cast<double>(i) / count);
    hits.push_back({p + wall.normal() * normal(random, sigma_m), seen_from});
  }
}

/// A room of 6 m x 4 m with its lower left corner in the origin, seen from inside.
std::vector<PosedHit> room(double sigma_m, std::mt19937_64& random) {
  const std::vector<Point2> ring{{0, 0}, {6, 0}, {6, 4}, {0, 4}};
  std::vector<PosedHit> hits;
  for (std::size_t i = 0; i < 4; ++i) sample(hits, {ring[i], ring[(i + 1) % 4]}, {2.5, 1.5}, sigma_m, random);
  return hits;
}

std::vector<PosedHit> moved(const Pose2& T, std::vector<PosedHit> hits) {
  for (PosedHit& hit : hits) hit = {T * hit.point, T * hit.seen_from};
  return hits;
}

TEST(WallLines, FindsTheFourFacesOfARoomWithFreeSpaceOnTheirLeft) {
  std::mt19937_64 random(1);
  const auto walls = find_wall_lines(room(0.01, random));
  ASSERT_EQ(walls.size(), 4u);
  for (const WallLine& wall : walls) {
    EXPECT_GT(signed_line_distance(wall.segment, {2.5, 1.5}), 0);
    EXPECT_LT(wall.roughness_m, 0.02);
    EXPECT_GT(wall.sigma_m, 0);
  }
  EXPECT_NEAR(walls.front().segment.length(), 6, 0.3);
  EXPECT_NEAR(walls.back().segment.length(), 4, 0.3);
}

TEST(WallLines, AreWithinTheirSigmaOfTheTruth) {
  std::mt19937_64 random(2);
  int within = 0, all = 0;
  for (int trial = 0; trial < 30; ++trial)
    for (const WallLine& wall : find_wall_lines(room(0.02, random))) {
      const Point2 m = wall.segment.midpoint();
      const double off = std::min({std::abs(m.x()), std::abs(m.y()), std::abs(m.x() - 6), std::abs(m.y() - 4)});
      within += off < 2 * wall.sigma_m;
      ++all;
    }
  EXPECT_GT(within, 0.9 * all);
}

TEST(WallLines, KeepTheTwoFacesOfAThinWallApart) {
  std::mt19937_64 random(3);
  std::vector<PosedHit> hits;
  sample(hits, {{0, 0.05}, {3, 0.05}}, {1.5, 2}, 0.005, random);
  sample(hits, {{0, -0.05}, {3, -0.05}}, {1.5, -2}, 0.005, random);
  const auto walls = find_wall_lines(hits);
  ASSERT_EQ(walls.size(), 2u);
  EXPECT_LT(walls[0].segment.normal().y() * walls[1].segment.normal().y(), 0);
  for (const WallLine& wall : walls) EXPECT_NEAR(std::abs(wall.segment.midpoint().y()), 0.05, 0.01);
}

TEST(WallLines, EndAtADoor) {
  std::mt19937_64 random(4);
  std::vector<PosedHit> hits;
  sample(hits, {{0, 0}, {2, 0}}, {2, 2}, 0.01, random);
  sample(hits, {{3, 0}, {5, 0}}, {2, 2}, 0.01, random);
  const auto walls = find_wall_lines(hits);
  ASSERT_EQ(walls.size(), 2u);
  for (const WallLine& wall : walls) EXPECT_NEAR(wall.segment.length(), 2, 0.1);
}

TEST(WallLines, FindNothingInScatteredSmoke) {
  std::mt19937_64 random(5);
  std::vector<PosedHit> hits;
  for (int i = 0; i < 400; ++i) hits.push_back({{uniform(random, -2, 2), uniform(random, -2, 2)}, {0, 0}});
  EXPECT_LE(find_wall_lines(hits).size(), 3u);
  EXPECT_TRUE(find_wall_lines({}).empty());
}

TEST(WallLines, MoveWithTheHits) {
  std::mt19937_64 random(6);
  const auto hits = room(0.01, random);
  const auto before = find_wall_lines(hits);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose2 T(uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -kPi, kPi));
    const auto after = find_wall_lines(moved(T, hits));
    ASSERT_EQ(after.size(), before.size());
    for (const WallLine& wall : before)
      EXPECT_TRUE(std::any_of(after.begin(), after.end(), [&](const WallLine& w) {
        return (w.segment.a - T * wall.segment.a).norm() < 0.12 && (w.segment.b - T * wall.segment.b).norm() < 0.12;
      }));
  }
}

TEST(Corners, OfARoomOpenIntoTheRoom) {
  std::mt19937_64 random(7);
  const auto corners = find_corners(find_wall_lines(room(0.01, random)));
  ASSERT_EQ(corners.size(), 4u);
  const Point2 middle(3, 2);
  for (const Corner& corner : corners) {
    EXPECT_NEAR(corner.opening_rad, kPi / 2, 0.05);
    const Point2 inwards = (middle - corner.position).normalized();
    EXPECT_GT(inwards.dot(Point2(std::cos(corner.orientation_rad), std::sin(corner.orientation_rad))), 0.9);
    EXPECT_GT(corner.confidence, 0.5);
  }
  EXPECT_TRUE(std::any_of(corners.begin(), corners.end(),
                          [](const Corner& c) { return (c.position - Point2(6, 4)).norm() < 0.03; }));
}

TEST(Corners, OfAPillarOpenAwayFromIt) {
  std::mt19937_64 random(8);
  std::vector<PosedHit> hits;  // the pillar's edge at the origin: one face seen from below, one from the left
  sample(hits, {{0, 0}, {1.5, 0}}, {0.7, -2}, 0.005, random);
  sample(hits, {{0, 0}, {0, 1.5}}, {-2, 0.7}, 0.005, random);
  const auto corners = find_corners(find_wall_lines(hits));
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_THAT(corners[0].position, IsNearPoint(Point2(0, 0), 0.03));
  EXPECT_NEAR(corners[0].opening_rad, 1.5 * kPi, 0.05);
  EXPECT_NEAR(wrap_angle(corners[0].orientation_rad - radians(-135)), 0, 0.05);
}

TEST(Corners, ATJunctionHasTwo) {
  const WallLine through{{{0, 0}, {6, 0}}, 100, 0.01, 0.005, 0.01};         // free above
  const WallLine right_face{{{3, 3}, {3, 0.1}}, 50, 0.01, 0.005, 0.01};     // free towards +x
  const WallLine left_face{{{2.9, 0.1}, {2.9, 3}}, 50, 0.01, 0.005, 0.01};  // free towards -x
  const auto corners = find_corners({through, right_face, left_face});
  ASSERT_EQ(corners.size(), 2u);
  for (const Corner& corner : corners) EXPECT_NEAR(corner.opening_rad, kPi / 2, 1e-6);
  EXPECT_NEAR(corners[0].orientation_rad, radians(45), 1e-6);
  EXPECT_NEAR(corners[1].orientation_rad, radians(135), 1e-6);
}

TEST(Corners, AreNotMadeOfWallsThatFaceAwayOrEndFarApart) {
  const WallLine floor_line{{{0, 0}, {3, 0}}, 50, 0.01, 0.005, 0.01};  // free above
  const WallLine below{
      {{3, -3}, {3, -0.1}}, 50, 0.01, 0.005, 0.01};  // below it, free towards -x: no common free sector
  EXPECT_TRUE(find_corners({floor_line, below}).empty());
  const WallLine far_away{{{5, 1}, {5, 4}}, 50, 0.01, 0.005, 0.01};
  EXPECT_TRUE(find_corners({floor_line, far_away}).empty());
}

TEST(Corners, KnowTheirCovarianceFromTheirWalls) {
  const WallLine sharp{{{0, 0}, {3, 0}}, 50, 0.01, 1e-6, 0.01};
  const WallLine vague{{{3, 0}, {3, 3}}, 50, 0.05, 1e-6, 0.01};
  const auto corners = find_corners({sharp, vague});
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_NEAR(std::sqrt(corners[0].covariance(0, 0)), 0.05, 1e-6);
  EXPECT_NEAR(std::sqrt(corners[0].covariance(1, 1)), 0.01, 1e-6);
}

TEST(FeatureParams, SayWhatIsWrong) {
  EXPECT_THAT(WallLineParams{}.validate(), IsOk());
  EXPECT_THAT(CornerParams{}.validate(), IsOk());
  WallLineParams params;
  params.tolerance_m = -1;
  EXPECT_THAT(params.validate(), Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
