#include <gtest/gtest.h>

#include "core/random.hpp"
#include "geometry/covariance.hpp"
#include "geometry/polygon.hpp"
#include "geometry/segment2.hpp"
#include "geometry/similarity2.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Pose2 random_pose(std::mt19937_64& random) {
  return {uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -10, 10)};
}
Point2 random_point(std::mt19937_64& random) { return {uniform(random, -50, 50), uniform(random, -50, 50)}; }

TEST(Angle, WrapsIntoHalfOpenTurn) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), -kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), -kPi);
  EXPECT_NEAR(wrap_angle(7 * kPi / 2), -kPi / 2, 1e-12);
  EXPECT_NEAR(line_angle_between(0.1, 0.1 + kPi), 0, 1e-12);
}

TEST(Pose2, InverseUndoes) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100; ++i) {
    const Pose2 T = random_pose(random);
    EXPECT_THAT(T * T.inverse(), test::IsNear(Pose2(), 1e-9, 1e-9));
    const Point2 p = random_point(random);
    EXPECT_THAT(T.inverse() * (T * p), test::IsNearPoint(p, 1e-9));
  }
}

TEST(Pose2, ComposesLikeItsAction) {
  std::mt19937_64 random(8);
  for (int i = 0; i < 100; ++i) {
    const Pose2 A = random_pose(random), B = random_pose(random);
    const Point2 p = random_point(random);
    EXPECT_THAT((A * B) * p, test::IsNearPoint(Point2(A * (B * p)), 1e-9));
  }
}

TEST(Segment2, ClosestPointBeatsSampling) {
  std::mt19937_64 random(9);
  for (int i = 0; i < 200; ++i) {
    const Segment2 s{random_point(random), random_point(random)};
    const Point2 p = random_point(random);
    double best = 1e9;
    for (int k = 0; k <= 1000; ++k) best = std::min(best, (p - (s.a + k / 1000.0 * (s.b - s.a))).norm());
    EXPECT_LE(distance(s, p), best + 1e-9);
    EXPECT_NEAR(distance(s, p), best, 0.1);
  }
}

TEST(Segment2, CrossingLiesOnBoth) {
  std::mt19937_64 random(10);
  int crossings = 0;
  for (int i = 0; i < 300; ++i) {
    const Segment2 one{random_point(random), random_point(random)}, two{random_point(random), random_point(random)};
    if (const auto p = intersection(one, two)) {
      ++crossings;
      EXPECT_LT(distance(one, *p), 1e-7);
      EXPECT_LT(distance(two, *p), 1e-7);
    }
  }
  EXPECT_GT(crossings, 20);
  EXPECT_FALSE(intersection({{0, 0}, {1, 0}}, {{0, 1}, {1, 1}}));
}

TEST(Polygon, UnitSquare) {
  const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_DOUBLE_EQ(signed_area(square), 1);
  EXPECT_THAT(centroid(square), test::IsNearPoint(Point2(0.5, 0.5), 1e-12));
  EXPECT_TRUE(contains(square, {0.5, 0.5}));
  EXPECT_FALSE(contains(square, {1.5, 0.5}));
  EXPECT_EQ(signed_area({}), 0);
}

TEST(Similarity2, RecoversAPlantedOne) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 50; ++i) {
    const Similarity2 truth{uniform(random, 0.1, 3), random_pose(random)};
    std::vector<PointPair> pairs;
    for (int k = 0; k < 5; ++k) {
      const Point2 b = random_point(random);
      pairs.push_back({truth * b, b, uniform(random, 0.05, 1)});
    }
    const auto fit = fit_similarity(pairs);
    ASSERT_THAT(fit, test::IsOk());
    EXPECT_NEAR(fit->scale, truth.scale, 1e-9);
    EXPECT_THAT(fit->T_a_b, test::IsNear(truth.T_a_b, 1e-7, 1e-9));
    EXPECT_THAT(fit->inverse() * (truth * Point2(1, 2)), test::IsNearPoint(Point2(1, 2), 1e-7));
  }
}

TEST(Similarity2, NeedsTwoDistinctPairs) {
  EXPECT_THAT(fit_similarity({}), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(fit_similarity({{{0, 0}, {1, 1}}}), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(fit_similarity({{{0, 0}, {1, 1}}, {{0, 0}, {1, 1}}}), test::Fails(Errc::kDegenerate));
}

TEST(Covariance, SqrtInformationWhitens) {
  Eigen::Matrix2d cov;
  cov << 4, 1, 1, 2;
  const auto L = sqrt_information(cov);
  ASSERT_THAT(L, test::IsOk());
  EXPECT_TRUE((*L * cov * L->transpose()).isApprox(Eigen::Matrix2d::Identity(), 1e-12));
  EXPECT_THAT(sqrt_information(Eigen::Matrix2d(-cov)), test::Fails(Errc::kDegenerate));
}

TEST(Covariance, EllipseOfADiagonal) {
  const Ellipse e = ellipse(Eigen::Vector2d(1, 9).asDiagonal());
  EXPECT_DOUBLE_EQ(e.major_sigma_m, 3);
  EXPECT_DOUBLE_EQ(e.minor_sigma_m, 1);
  EXPECT_NEAR(std::abs(e.heading_rad), kPi / 2, 1e-9);
}

}  // namespace
}  // namespace smokemap
