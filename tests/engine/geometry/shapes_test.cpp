#include <gtest/gtest.h>

#include "core/random.hpp"
#include "geometry/polygon.hpp"
#include "geometry/segment2.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

Point2 somewhere(std::mt19937_64& random, double reach = 10) {
  return {uniform(random, -reach, reach), uniform(random, -reach, reach)};
}

/// A ring round the origin whose radius changes: simple, counter-clockwise, often not convex.
Polygon star(std::mt19937_64& random, int corners) {
  Polygon ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * kPi * i / corners, radius = uniform(random, 2, 8);
    ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return ring;
}

TEST(Interpolate, TurnsTheShortWayAndMeetsBothEnds) {
  auto random = random_stream(21, 1);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a(somewhere(random), uniform(random, -9, 9)), b(somewhere(random), uniform(random, -9, 9));
    EXPECT_THAT(interpolate(a, b, 0), test::IsNear(a, 1e-9, 1e-9));
    EXPECT_THAT(interpolate(a, b, 1), test::IsNear(b, 1e-9, 1e-9));
    const Pose2 half = interpolate(a, b, 0.5);
    EXPECT_NEAR(std::abs(wrap_angle(half.heading() - a.heading())), std::abs(wrap_angle(half.heading() - b.heading())),
                1e-9);
    EXPECT_LE(std::abs(wrap_angle(half.heading() - a.heading())), kPi / 2 + 1e-9);
  }
}

TEST(LineAngle, IsTheSameForBothDirectionsOfEitherLine) {
  auto random = random_stream(22, 1);
  for (int i = 0; i < 200; ++i) {
    const double a = uniform(random, -7, 7), b = uniform(random, -7, 7);
    const double angle = line_angle_between(a, b);
    EXPECT_GE(angle, 0);
    EXPECT_LE(angle, kPi / 2 + 1e-12);
    EXPECT_NEAR(line_angle_between(a + kPi, b), angle, 1e-9);
    EXPECT_NEAR(line_angle_between(b, a), angle, 1e-9);
  }
}

TEST(Segment2, KeepsItsDirectionsStraight) {
  auto random = random_stream(23, 1);
  for (int i = 0; i < 200; ++i) {
    const Segment2 s{somewhere(random), somewhere(random)};
    EXPECT_NEAR(s.direction().norm(), 1, 1e-12);
    EXPECT_NEAR(s.direction().dot(s.normal()), 0, 1e-12);
    EXPECT_GT(cross(s.direction(), s.normal()), 0) << "the normal points to the left";
    EXPECT_NEAR(signed_line_distance(s, s.a + 2.5 * s.normal()), 2.5, 1e-9);
    EXPECT_NEAR(wrap_angle(s.heading() - std::atan2(s.direction().y(), s.direction().x())), 0, 1e-12);
    EXPECT_NEAR(along(s, s.midpoint()), 0.5, 1e-12);
  }
}

TEST(Segment2, APointLikeOneHasNoDirectionAndStillADistance) {
  const Segment2 dot{{3, 4}, {3, 4}};
  EXPECT_EQ(dot.direction(), Point2(0, 0));
  EXPECT_EQ(along(dot, {9, 9}), 0);
  EXPECT_NEAR(distance(dot, {0, 0}), 5, 1e-12);
  EXPECT_FALSE(line_intersection(dot, {{0, 0}, {1, 1}}));
}

TEST(Intersection, AgreesWithTheSidesOnWhichTheEndsLie) {
  auto random = random_stream(24, 1);
  int crossing = 0;
  for (int i = 0; i < 2000; ++i) {
    const Segment2 one{somewhere(random), somewhere(random)}, two{somewhere(random), somewhere(random)};
    const auto side = [](const Segment2& s, const Point2& p) { return cross(s.b - s.a, p - s.a); };
    const bool apart = side(one, two.a) * side(one, two.b) > 0 || side(two, one.a) * side(two, one.b) > 0;
    EXPECT_EQ(intersection(one, two).has_value(), !apart);
    crossing += !apart;
  }
  EXPECT_GT(crossing, 300);
}

TEST(Intersection, CountsEndsAndRefusesParallels) {
  EXPECT_TRUE(intersection({{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}));
  EXPECT_FALSE(intersection({{0, 0}, {2, 0}}, {{1, 0}, {3, 0}})) << "in one line: no single point";
  const auto far = line_intersection({{0, 0}, {1, 0}}, {{5, 1}, {5, 2}});
  ASSERT_TRUE(far);
  EXPECT_THAT(*far, test::IsNearPoint(Point2(5, 0), 1e-9));
  EXPECT_FALSE(line_intersection({{0, 0}, {1, 0}}, {{0, 1}, {1, 1}}));
}

TEST(Polygon, AreaTurnsItsSignWithTheRingAndIgnoresWhereItLies) {
  auto random = random_stream(25, 1);
  for (int i = 0; i < 50; ++i) {
    Polygon ring = star(random, 9);
    const double area = signed_area(ring);
    EXPECT_GT(area, 0);
    const Point2 middle = centroid(ring);
    const Pose2 T(somewhere(random), uniform(random, -3, 3));
    Polygon moved;
    for (const Point2& p : ring) moved.push_back(T * p);
    EXPECT_NEAR(signed_area(moved), area, 1e-9);
    EXPECT_THAT(centroid(moved), test::IsNearPoint(Point2(T * middle), 1e-9));
    std::reverse(ring.begin(), ring.end());
    EXPECT_NEAR(signed_area(ring), -area, 1e-9);
    EXPECT_THAT(centroid(ring), test::IsNearPoint(middle, 1e-9));
  }
}

TEST(Polygon, ContainsAgreesWithTheAreaByDrawingLots) {
  auto random = random_stream(26, 1);
  const Polygon ring = star(random, 11);
  int inside = 0;
  constexpr int kDraws = 40'000;
  for (int i = 0; i < kDraws; ++i) inside += contains(ring, somewhere(random, 8));
  EXPECT_NEAR(256.0 * inside / kDraws, signed_area(ring), 0.02 * 256);
}

TEST(Polygon, RingsWithoutAreaHaveTheMeanOfTheirPoints) {
  EXPECT_THAT(centroid({{0, 0}, {2, 0}, {4, 0}}), test::IsNearPoint(Point2(2, 0), 1e-12));
  EXPECT_FALSE(contains({}, {0, 0}));
  EXPECT_FALSE(contains({{0, 0}, {1, 0}}, {0.5, 0}));
}

}  // namespace
}  // namespace smokemap
