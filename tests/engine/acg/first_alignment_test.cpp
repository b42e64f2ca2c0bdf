#include "acg/first_alignment.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

/// An L of two rooms, walls without thickness worth mentioning.
PlanModel l_shaped_plan() {
  PlanModel plan;
  plan.corners = {{0, 0}, {9, 0}, {9, 3}, {4, 3}, {4, 7}, {0, 7}, {4, 1.2}};
  const int ends[][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}, {3, 6}};
  for (const auto& e : ends) {
    const Segment2 s{plan.corners[static_cast<std::size_t>(e[0])], plan.corners[static_cast<std::size_t>(e[1])]};
    plan.walls.push_back({e[0], e[1], s.length(), s.heading(), 0.02, true});
  }
  return plan;
}

std::vector<Point2> hits_on(const PlanModel& plan, const PlanPlacement& placement) {
  std::vector<Point2> hits;
  for (const PlanEdge& w : plan.walls) {
    const Segment2 s{plan.corners[static_cast<std::size_t>(w.corner_a)],
                     plan.corners[static_cast<std::size_t>(w.corner_b)]};
    for (double t = 0.1; t < s.length(); t += 0.2) hits.push_back(placement * Point2(s.a + t * s.direction()));
  }
  return hits;
}

TEST(PlanPlacement, ComesBackAndStretchesAlongThePlansOwnAxes) {
  auto random = random_stream(9, 1);
  for (int i = 0; i < 100; ++i) {
    PlanPlacement placement{uniform(random, -3, 3),
                            {uniform(random, 0.8, 1.2), uniform(random, 0.8, 1.2)},
                            uniform(random, -0.7, 0.7),
                            {uniform(random, -5, 5), uniform(random, -5, 5)}};
    const Point2 p(uniform(random, -9, 9), uniform(random, -9, 9));
    EXPECT_LT((placement.inverse(placement * p) - p).norm(), 1e-9);
    const Point2 u(std::cos(placement.axis_rad), std::sin(placement.axis_rad));
    EXPECT_NEAR((placement * Point2(p + u) - placement * p).norm(), placement.scale.x(), 1e-9);
  }
  const Similarity2 similarity{1.1, Pose2(2, -1, 0.4)};
  const Point2 p(3, 5);
  EXPECT_LT((PlanPlacement::from(similarity, 0.3) * p - similarity * p).norm(), 1e-9);
}

TEST(AlignPlan, FindsThePlanNearAGuessThatIsOff) {
  const PlanModel plan = l_shaped_plan();
  const PlanPlacement truth{0.5, {1.06, 0.97}, 0, {1, 2}};
  const Point2 robot = truth * Point2(2, 2);
  StartSearch search;
  search.sigma_m = 0.5;
  search.sigma_rad = 0.09;
  const Point2 off(0.5, -0.4);
  search.guess = Similarity2{1, Pose2(robot + off, 0.58) * Pose2(Point2(-2, -2), 0)};
  const auto found = align_plan(plan, hits_on(plan, truth), robot, search);
  ASSERT_THAT(found, IsOk());
  EXPECT_GT(found->front().explained, 0.9);
  for (const Point2& p : plan.corners) EXPECT_LT((found->front().placement * p - truth * p).norm(), 0.25);
}

/// A robot that has hardly moved sees a few metres of one wall, and what is beside it is not on the plan.
TEST(AlignPlan, DoesNotTurnThePlanFartherThanAFewHitsAreWorth) {
  const PlanModel plan = l_shaped_plan();
  const Point2 robot(2, 2);
  StartSearch search;
  search.sigma_m = 0.2;
  search.sigma_rad = 0.02;
  search.guess = Similarity2{1, Pose2()};
  double worst = 0;
  for (const double tilt : {-0.10, -0.06, 0.06, 0.10}) {
    std::vector<Point2> hits;
    for (double t = -1; t < 1; t += 0.05) hits.push_back(Point2(2, 0) + t * Point2(std::cos(tilt), std::sin(tilt)));
    const auto found = align_plan(plan, hits, robot, search);
    ASSERT_THAT(found, IsOk());
    worst = std::max(worst, std::abs(found->front().placement.turn_rad));
  }
  EXPECT_LT(worst, 1.5 * search.sigma_rad);
}

TEST(AlignPlan, TurnsThePlanByAllThatWasSeenWhenMuchWasSeen) {
  const PlanModel plan = l_shaped_plan();
  const PlanPlacement truth{0.08, {1, 1}, 0, {0, 0}};
  StartSearch search;
  search.sigma_m = 0.2;
  search.sigma_rad = 0.04;
  search.guess = Similarity2{1, Pose2()};
  const auto found = align_plan(plan, hits_on(plan, truth), truth * Point2(2, 2), search);
  ASSERT_THAT(found, IsOk());
  EXPECT_NEAR(found->front().placement.turn_rad, 0.08, 0.02);
}

TEST(AlignPlan, FindsThePlanWithoutAnyHint) {
  const PlanModel plan = l_shaped_plan();
  const PlanPlacement truth{-2.1, {1, 1}, 0, {4, -3}};
  const auto found = align_plan(plan, hits_on(plan, truth), truth * Point2(2, 5), {});
  ASSERT_THAT(found, IsOk());
  EXPECT_GT(found->front().margin, 0.05);
  for (const Point2& p : plan.corners) EXPECT_LT((found->front().placement * p - truth * p).norm(), 0.3);
}

TEST(AlignPlan, SaysThatTooLittleWasSeen) {
  EXPECT_THAT(align_plan(l_shaped_plan(), std::vector<Point2>(10, Point2(1, 1)), {0, 0}, {}), Fails(Errc::kDegenerate));
}

TEST(FirstHits, StopAtTheWayAndKeepToTheFirstRobot) {
  std::vector<NodeView> views(4);
  GraphState state;
  for (int i = 0; i < 4; ++i) {
    views[static_cast<std::size_t>(i)].pieces.push_back({{{2, -1}, {2, 1}}, 20});
    state.poses.push_back({3.0 * i, 0, 0});
  }
  views[1].robot = 1;
  const auto hits = first_hits(views, state, 6.5, 5);
  ASSERT_FALSE(hits.empty());
  for (const Point2& p : hits) EXPECT_TRUE(std::abs(p.x() - 2) < 1e-9 || std::abs(p.x() - 8) < 1e-9) << p.x();
  EXPECT_TRUE(first_hits(views, state, 6.5, 1).empty());
}

}  // namespace
}  // namespace smokemap
