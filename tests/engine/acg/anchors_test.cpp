#include "acg/anchors.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace smokemap {
namespace {

PointPair pair_under(const Similarity2& map_from_layout, const Point2& p_layout) {
  return {map_from_layout * p_layout, p_layout, 0.1};
}

std::vector<PointPair> pairs_under(const Similarity2& s, int count, std::mt19937_64& random) {
  std::vector<PointPair> pairs;
  for (int i = 0; i < count; ++i)
    pairs.push_back(pair_under(s, Point2(uniform(random, 0, 30), uniform(random, 0, 20))));
  return pairs;
}

TEST(OutlyingPairs, AreNoneWhileAllAgreeUpToThePlansLocalStretch) {
  auto random = random_stream(31, 1);
  for (int i = 0; i < 100; ++i) {
    const Similarity2 s{uniform(random, 0.9, 1.1), Pose2(uniform(random, -9, 9), 2, uniform(random, -3, 3))};
    auto pairs = pairs_under(s, 5, random);
    for (PointPair& p : pairs) p.p_a += Point2(uniform(random, -0.15, 0.15), uniform(random, -0.15, 0.15));
    const auto outlying = outlying_pairs(pairs);
    EXPECT_EQ(std::count(outlying.begin(), outlying.end(), true), 0) << i;
  }
}

TEST(OutlyingPairs, FlagTheOneThatIsFarFromWhereTheOthersPutIt) {
  auto random = random_stream(31, 2);
  for (int i = 0; i < 100; ++i) {
    const Similarity2 s{1.05, Pose2(3, -1, uniform(random, -3, 3))};
    auto pairs = pairs_under(s, 5, random);
    const std::size_t wrong = uniform_index(random, pairs.size());
    const double where = uniform(random, -kPi, kPi);
    pairs[wrong].p_a += 15 * Point2(std::cos(where), std::sin(where));
    const auto outlying = outlying_pairs(pairs);
    ASSERT_EQ(outlying.size(), pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) EXPECT_EQ(outlying[k], k == wrong) << i;
    EXPECT_EQ(trusted_pairs(pairs, outlying).size(), 4u);
  }
}

TEST(OutlyingPairs, CannotBeToldAmongTwoOrOneAgainstOne) {
  const Similarity2 s{1, Pose2(1, 2, 0.3)};
  std::vector<PointPair> pairs{pair_under(s, {0, 0}), pair_under(s, {10, 0})};
  pairs[1].p_a += Point2(4, 4);
  EXPECT_EQ(outlying_pairs(pairs), (std::vector<bool>{false, false}));
  EXPECT_TRUE(outlying_pairs({}).empty());
}

TEST(OutlyingPairs, AreToldFromThreeWhenTheRobotsStartIsAWitness) {
  const Similarity2 s{1, Pose2(1, 2, 0.3)};
  std::vector<PointPair> pairs{pair_under(s, {0, 0}), pair_under(s, {10, 0}), pair_under(s, {10, 8})};
  pairs[2].p_a += Point2(6, 0);
  const auto flagged = outlying_pairs(pairs, pair_under(s, {2, 7}));
  EXPECT_EQ(flagged, (std::vector<bool>{false, false, true}));
}

PlanModel square_plan() {
  PlanModel plan;
  plan.corners = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {2, 0}};
  return plan;
}

GraphState state_under(const PlanModel& plan, const Similarity2& s) {
  GraphState state;
  for (const Point2& p : plan.corners) {
    const Point2 q = s * p;
    state.corners.push_back({q.x(), q.y()});
  }
  return state;
}

TEST(AnchorLink, MovesWithTheCornersAroundIt) {
  auto random = random_stream(31, 3);
  const PlanModel plan = square_plan();
  for (int i = 0; i < 100; ++i) {
    const Similarity2 s{uniform(random, 0.8, 1.2), Pose2(uniform(random, -9, 9), uniform(random, -9, 9), 0.7)};
    const Point2 p(uniform(random, -1, 5), uniform(random, -1, 4));
    const auto link = anchor_link(plan, p, s * p + Point2(0.3, 0.4));
    ASSERT_TRUE(link);
    EXPECT_NEAR(link->shares.sum(), 1, 1e-9);
    EXPECT_NEAR(residual_m(*link, state_under(plan, s)), 0.5, 1e-9);
  }
}

TEST(AnchorLink, IsNoneInAPlanOfOneLine) {
  PlanModel plan;
  plan.corners = {{0, 0}, {4, 0}, {9, 0}};
  EXPECT_FALSE(anchor_link(plan, {1, 1}, {1, 1}));
  plan.corners.resize(1);
  EXPECT_FALSE(anchor_link(plan, {1, 1}, {1, 1}));
}

}  // namespace
}  // namespace smokemap
