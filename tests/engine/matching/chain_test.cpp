#include "matching/chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

/// Turned, scaled and shifted, always with the same error.
PointWay similarity(double angle_rad, double scale, const Point2& shift, double sigma, double confidence) {
  return [=](const Point2& p) {
    Transferred there;
    there.p = scale * (Eigen::Rotation2Dd(angle_rad) * p) + shift;
    there.sigma = sigma, there.confidence = confidence;
    return there;
  };
}

PointWay nowhere(const std::string& reason) {
  return [=](const Point2&) {
    Transferred none;
    none.reason = reason;
    return none;
  };
}

TEST(ChainedWays, AddTheErrorOfTheFirstScaledByTheSecond) {
  const PointWay way = chained(similarity(0.3, 2, {5, 6}, 3, 0.9), similarity(-1, 0.5, {1, 1}, 2, 0.8));
  const Transferred there = way({10, 20});
  ASSERT_TRUE(there.p.has_value());
  EXPECT_NEAR(there.sigma, std::hypot(0.5 * 3, 2), 1e-9);  // a turn does not change it
  EXPECT_NEAR(there.confidence, 0.72, 1e-12);
}

TEST(ChainedWays, EndWhereTheSecondEndsFromWhereTheFirstDid) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto any = [&] {
      return similarity(uniform(random, -3, 3), uniform(random, 0.2, 5), {normal(random, 9), normal(random, 9)},
                        uniform(random, 0.1, 4), uniform01(random));
    };
    const PointWay first = any(), second = any();
    const Point2 p(normal(random, 50), normal(random, 50));
    const Transferred there = chained(first, second)(p);
    EXPECT_LT((*there.p - *second(*first(p).p).p).norm(), 1e-9);
    EXPECT_GE(there.sigma, second(p).sigma);
  }
}

TEST(ChainedWays, AreAsUnsureAsRandomPointsCarriedOneByOne) {
  // A shear: what scatters evenly on the second map scatters as an ellipse on the third.
  const PointWay shear = [](const Point2& p) {
    Transferred there;
    there.p = Point2(p.x() + 3 * p.y(), 0.5 * p.y());
    there.sigma = 1, there.confidence = 1;
    return there;
  };
  Transferred first;
  first.p = Point2(4, -2), first.sigma = 2, first.confidence = 1;
  const Transferred there = carry_on(first, shear);
  std::mt19937_64 random(2);
  double squared = 0;
  const int count = 40000;
  for (int k = 0; k < count; ++k) {
    const Point2 p = *first.p + Point2(normal(random, 2), normal(random, 2));
    squared += (*shear(p).p + Point2(normal(random, 1), normal(random, 1)) - *there.p).squaredNorm() / 2;
  }
  EXPECT_NEAR(there.sigma, std::sqrt(squared / count), 0.05);
}

TEST(ChainedWays, HaveNoPlaceWhereOneOfTheTwoHasNone) {
  const PointWay some = similarity(0, 1, {0, 0}, 1, 1);
  EXPECT_EQ(chained(nowhere("first"), some)({0, 0}).reason, "first");
  EXPECT_EQ(chained(some, nowhere("second"))({0, 0}).reason, "second");
  EXPECT_FALSE(chained(some, nowhere("second"))({0, 0}).p.has_value());
}

TEST(ChainedWays, LookNearerWhereTheSecondMapIsNarrow) {
  // A corridor three wide and turned by nothing: a first error of 10 looks over its walls, but the scale is known.
  const PointWay corridor = [](const Point2& p) {
    Transferred there;
    if (std::abs(p.y()) <= 1.5 && std::abs(p.x()) <= 1.5) there.p = 2 * p, there.sigma = 1, there.confidence = 1;
    return there;
  };
  Transferred first;
  first.p = Point2(0, 0), first.sigma = 5, first.confidence = 1;
  EXPECT_NEAR(carry_on(first, corridor).sigma, std::hypot(10, 1), 1e-9);
}

}  // namespace
}  // namespace smokemap
