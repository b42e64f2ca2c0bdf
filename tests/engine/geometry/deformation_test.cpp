#include "geometry/deformation.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "geometry/delaunay.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsNearPoint;
using test::IsOk;

Similarity2 some_similarity(std::mt19937_64& random) {
  return {uniform(random, 0.5, 2.0), Pose2(uniform(random, -20, 20), uniform(random, -20, 20), uniform(random, -3, 3))};
}

/// A grid of nodes, as in a plan, warped gently: neighbours 3 m apart, moved by up to 0.5 m.
std::vector<PointPair> warped_grid(std::mt19937_64& random, double shake_m = 0.5) {
  const Similarity2 base = some_similarity(random);
  std::vector<PointPair> pairs;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 4; ++y) {
      const Point2 p(3.0 * x, 3.0 * y);
      const Point2 shaken = p + Point2(uniform(random, -shake_m, shake_m), uniform(random, -shake_m, shake_m));
      pairs.push_back({base * shaken, p, 0.05 + 0.01 * x});
    }
  return pairs;
}

TEST(Delaunay, CoversTheBoxOnceAndKeepsCirclesEmpty) {
  auto random = random_stream(7, 0);
  for (int run = 0; run < 20; ++run) {
    std::vector<Point2> points{{0, 0}, {10, 0}, {10, 8}, {0, 8}};
    for (int i = 0; i < 40; ++i) points.emplace_back(uniform(random, 0.5, 9.5), uniform(random, 0.5, 7.5));
    const auto triangles = triangulate_in_box(points);
    double area = 0;
    for (const auto& t : triangles) {
      const Point2 a = points[static_cast<std::size_t>(t[0])], b = points[static_cast<std::size_t>(t[1])],
                   c = points[static_cast<std::size_t>(t[2])];
      const double twice = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
      EXPECT_GT(twice, 0);
      area += twice / 2;
      for (const Point2& p : points) {
        const Eigen::Vector3d s = barycentric(p, a, b, c);
        EXPECT_LT(s.minCoeff(), 1e-3) << "a node inside a triangle";
      }
    }
    EXPECT_NEAR(area, 80, 1e-9);
  }
}

TEST(Delaunay, CopesWithARegularGrid) {
  std::vector<Point2> points{{-1, -1}, {10, -1}, {10, 10}, {-1, 10}};
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y) points.emplace_back(x, y);
  double area = 0;
  for (const auto& t : triangulate_in_box(points)) {
    const Point2 a = points[static_cast<std::size_t>(t[0])], b = points[static_cast<std::size_t>(t[1])] - a,
                 c = points[static_cast<std::size_t>(t[2])] - a;
    EXPECT_GE(b.x() * c.y() - b.y() * c.x(), -1e-9);
    area += (b.x() * c.y() - b.y() * c.x()) / 2;
  }
  EXPECT_NEAR(area, 121, 1e-9);
}

TEST(Deformation, IsTheIdentityUntilToldOtherwise) {
  const Deformation identity;
  EXPECT_THAT(identity({3, -4}), IsNearPoint(Point2(3, -4), 1e-12));
  EXPECT_THAT(identity.inverse({3, -4}), IsNearPoint(Point2(3, -4), 1e-12));
  EXPECT_EQ(identity.local_scale({0, 0}), 1);
  EXPECT_TRUE(identity.mesh_triangles().empty());
}

TEST(Deformation, NeedsTwoDistinctNodes) {
  EXPECT_THAT(Deformation::build({}), Fails(Errc::kDegenerate));
  EXPECT_THAT(Deformation::build({{{0, 0}, {1, 1}}}), Fails(Errc::kDegenerate));
  EXPECT_THAT(Deformation::build({{{0, 0}, {1, 1}}, {{5, 5}, {1, 1}}}), Fails(Errc::kDegenerate));
  EXPECT_THAT(Deformation::build({{{0, NAN}, {1, 1}}, {{5, 5}, {2, 1}}}), Fails(Errc::kInvalidArgument));
}

TEST(Deformation, MeetsItsNodesExactly) {
  auto random = random_stream(7, 1);
  for (int run = 0; run < 30; ++run) {
    const auto pairs = warped_grid(random);
    const auto deformation = Deformation::build(pairs);
    ASSERT_THAT(deformation, IsOk());
    ASSERT_FALSE(deformation->folded());
    for (const PointPair& pair : pairs) {
      EXPECT_THAT((*deformation)(pair.p_b), IsNearPoint(pair.p_a, 1e-9));
      EXPECT_NEAR(deformation->sigma_m(pair.p_b), pair.sigma_m, 1e-9);
    }
  }
}

TEST(Deformation, InverseUndoesItEverywhere) {
  auto random = random_stream(7, 2);
  for (int run = 0; run < 30; ++run) {
    const auto deformation = Deformation::build(warped_grid(random));
    ASSERT_THAT(deformation, IsOk());
    for (int i = 0; i < 200; ++i) {
      const Point2 p(uniform(random, -40, 60), uniform(random, -40, 60));
      EXPECT_THAT(deformation->inverse((*deformation)(p)), IsNearPoint(p, 1e-6));
    }
  }
}

TEST(Deformation, HasNoJumps) {
  auto random = random_stream(7, 3);
  for (int run = 0; run < 20; ++run) {
    const auto deformation = Deformation::build(warped_grid(random));
    ASSERT_THAT(deformation, IsOk());
    for (int i = 0; i < 300; ++i) {
      const Point2 p(uniform(random, -30, 50), uniform(random, -30, 50));
      const Point2 q = p + Point2(uniform(random, -1e-4, 1e-4), uniform(random, -1e-4, 1e-4));
      EXPECT_LT(((*deformation)(p) - (*deformation)(q)).norm(), 50 * 2e-4);
    }
  }
}

TEST(Deformation, OfARigidSetIsThatSimilarity) {
  auto random = random_stream(7, 4);
  for (int run = 0; run < 30; ++run) {
    const Similarity2 truth = some_similarity(random);
    std::vector<PointPair> pairs;
    for (int i = 0; i < 12; ++i) {
      const Point2 p(uniform(random, 0, 20), uniform(random, 0, 20));
      pairs.push_back({truth * p, p, 0.1});
    }
    const auto deformation = Deformation::build(pairs);
    ASSERT_THAT(deformation, IsOk());
    for (int i = 0; i < 50; ++i) {
      const Point2 p(uniform(random, -50, 70), uniform(random, -50, 70));
      EXPECT_THAT((*deformation)(p), IsNearPoint(truth * p, 1e-7));
      EXPECT_NEAR(deformation->local_scale(p), 1, 1e-6);
    }
  }
}

TEST(Deformation, WorksWithTwoNodesAndWithNodesInLine) {
  const auto two = Deformation::build({{{0, 0}, {0, 0}}, {{2, 0}, {1, 0}}});
  ASSERT_THAT(two, IsOk());
  EXPECT_THAT((*two)({1, 0}), IsNearPoint(Point2(2, 0), 1e-9));
  EXPECT_THAT((*two)({0, 1}), IsNearPoint(Point2(0, 2), 1e-9));
  const auto line = Deformation::build({{{0, 0}, {0, 0}}, {{1, 0}, {1, 0}}, {{3, 0}, {2, 0}}, {{4, 0}, {3, 0}}});
  ASSERT_THAT(line, IsOk());
  EXPECT_THAT((*line)({2, 0}), IsNearPoint(Point2(3, 0), 1e-9));
}

TEST(Deformation, MergesNodesThatAreOne) {
  const auto deformation = Deformation::build({{{0, 0}, {0, 0}}, {{0.2, 0}, {0, 1e-5}}, {{10, 0}, {10, 0}}});
  ASSERT_THAT(deformation, IsOk());
  EXPECT_THAT((*deformation)({0, 0}), IsNearPoint(Point2(0.1, 0), 1e-9));
}

TEST(Deformation, UnfoldsWhatWouldTurnInsideOut) {
  auto random = random_stream(7, 5);
  for (int run = 0; run < 20; ++run) {
    auto pairs = warped_grid(random, 0.1);
    std::swap(pairs[7].p_a, pairs[16].p_a);
    const auto deformation = Deformation::build(pairs);
    ASSERT_THAT(deformation, IsOk());
    EXPECT_TRUE(deformation->folded());
    for (int i = 0; i < 100; ++i) {
      const Point2 p(uniform(random, -5, 20), uniform(random, -5, 20));
      EXPECT_THAT(deformation->inverse((*deformation)(p)), IsNearPoint(p, 1e-6));
    }
  }
}

TEST(Deformation, TellsWhereThePlanIsStretched) {
  std::vector<PointPair> pairs;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 2; ++y) pairs.push_back({{x <= 2 ? x : 2 + 2.0 * (x - 2), 1.0 * y}, {1.0 * x, 1.0 * y}, 0.1});
  const auto deformation = Deformation::build(pairs);
  ASSERT_THAT(deformation, IsOk());
  EXPECT_GT(deformation->local_scale({3.3, 1.2}), deformation->local_scale({0.7, 1.2}) * 1.3);
}

}  // namespace
}  // namespace smokemap
