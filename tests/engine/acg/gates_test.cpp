#include "acg/gates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acg/plan_stretch.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// Upright walls of 4 m, one at each x; each is a line of its own, along axis 0.
PlanModel upright_walls(const std::vector<double>& xs) {
  PlanModel plan;
  for (const double x : xs) {
    const int a = static_cast<int>(plan.corners.size());
    for (const double y : {0.0, 4.0}) {
      plan.corners.push_back({x, y});
      plan.line_of_corner[0].push_back(static_cast<int>(plan.walls.size()));
      plan.line_of_corner[1].push_back(y > 0);
    }
    plan.walls.push_back({a, a + 1, 4, kPi / 2, 0.05, true});
    plan.lines[0].push_back(x);
  }
  plan.lines[1] = {0, 4};
  return plan;
}

TEST(WallGates, NeverWidenWhenOneMoreWallOfTheSameDirectionIsKnown) {
  auto random = random_stream(44, 1);
  const AcgParams params;
  for (int i = 0; i < 50; ++i) {
    std::vector<double> xs;
    for (int k = 0; k < 8; ++k) xs.push_back(uniform(random, 0, 12));
    const PlanModel plan = upright_walls(xs);
    std::vector<WallState> states(8, WallState::kUnseen);
    const std::vector<double> linked(8, 2);
    auto before = wall_gates_m(plan, states, linked, params);
    for (const double gate : before) EXPECT_EQ(gate, 0.5);
    for (int known = 0; known < 8; ++known) {
      states[static_cast<std::size_t>(known)] = WallState::kConfirmed;
      const auto gates = wall_gates_m(plan, states, linked, params);
      for (std::size_t w = 0; w < 8; ++w) {
        double nearest = 1e9;  // they stand side by side, so only x counts
        for (std::size_t k = 0; k <= static_cast<std::size_t>(known); ++k)
          nearest = std::min(nearest, std::abs(xs[w] - xs[k]));
        EXPECT_NEAR(gates[w], std::clamp(0.2 + 0.3 * nearest, params.gate_end_m, params.gate_start_m), 1e-9);
        EXPECT_TRUE(known == 0 || gates[w] <= before[w]);
      }
      before = gates;
    }
  }
}

TEST(WallGates, AreNotNarrowedByAWallThatWasHardlyLinkedOrIsMissing) {
  const PlanModel plan = upright_walls({0, 1, 8});
  using enum WallState;
  const std::vector<double> linked{0.4, 3, 3};
  const auto gates = wall_gates_m(plan, {kConfirmed, kMissing, kConfirmed}, linked, {});
  EXPECT_EQ(gates[0], AcgParams{}.gate_start_m);
  EXPECT_EQ(gates[1], AcgParams{}.gate_start_m);
  EXPECT_EQ(gates[2], AcgParams{}.gate_end_m);
}

TEST(Mature, NeedsAThirdOfAShortWallAndNoMoreThanItsLengthOfALongOne) {
  const AcgParams params;
  const auto wall = [](double length_m) { return PlanEdge{0, 1, length_m, 0, 0.05, true}; };
  EXPECT_TRUE(mature(wall(20), params.mature_m, params));
  EXPECT_FALSE(mature(wall(20), params.mature_m - 0.01, params));
  EXPECT_TRUE(mature(wall(1), 0.31, params));
  EXPECT_FALSE(mature(wall(1), 0.29, params));
  EXPECT_FALSE(mature(wall(0.1), 0.14, params)) << "a stroke of a hand's breadth needs that much all the same";
}

TEST(Tension, IsSharedByAllWallsAndInSquaredSigmas) {
  PlanModel plan = upright_walls({0, 5});
  GraphState state;
  for (const Point2& p : plan.corners) state.corners.push_back({p.x(), p.y()});
  const double corners = std::sqrt(2.0) * 0.05;
  state.corners[1][1] += 2 * std::hypot(0.4, corners);  // two sigmas too long
  EXPECT_NEAR(plan_tension(plan, state, {}), 4.0 / 2, 1e-9);
  for (const double sigmas : {2.9, 3.1}) {
    state.corners[3][0] = 5 - sigmas * std::hypot(0.04, corners);
    EXPECT_NEAR(plan_tension(plan, state, {}), (4 + sigmas * sigmas) / 2, 1e-9);
    EXPECT_EQ(tense_walls(plan, state, {}), (std::vector<bool>{false, sigmas > 3}));
  }
}

TEST(SeenOnLines, AddsUpTheConfirmedWallsThatRunAlongALine) {
  const PlanModel plan = upright_walls({0, 2, 5});
  using enum WallState;
  EXPECT_EQ(seen_on_lines_m(plan, 0, {kConfirmed, kUnseen, kConfirmed}, {1.5, 9, 0.25}),
            (std::vector<double>{1.5, 0, 0.25}));
  EXPECT_EQ(seen_on_lines_m(plan, 1, {kConfirmed, kUnseen, kConfirmed}, {1.5, 9, 0.25}), (std::vector<double>{0, 0}));
}

TEST(LearntStretch, StaysWithinReasonAndDoesNotDependOnTheScale) {
  auto random = random_stream(44, 2);
  const AcgParams params;
  for (int i = 0; i < 100; ++i) {
    std::vector<double> xs{0};
    for (int k = 0; k < 6; ++k) xs.push_back(xs.back() + uniform(random, 0.5, 6));
    const PlanModel plan = upright_walls(xs);
    const std::vector<WallState> confirmed(xs.size(), WallState::kConfirmed);
    const std::vector<double> linked(xs.size(), 2);
    GraphState state, scaled;
    state.lines = scaled.lines = plan.lines;
    scaled.log_scale = uniform(random, -1, 1);
    for (std::size_t k = 0; k < xs.size(); ++k) {
      state.lines[0][k] = xs[k] + normal(random, 1.0);
      scaled.lines[0][k] = std::exp(scaled.log_scale) * state.lines[0][k] + 70;
    }
    const double learnt = learnt_stretch(plan, state, confirmed, linked, params);
    EXPECT_GE(learnt, 0.6 * params.sigma_wall_log_length);
    EXPECT_LE(learnt, 2.5 * params.sigma_wall_log_length);
    EXPECT_NEAR(learnt, learnt_stretch(plan, scaled, confirmed, linked, params), 1e-9);
    EXPECT_LT(learnt_stretch(plan, GraphState{{}, {}, 0, 0, plan.lines}, confirmed, linked, params), 0.1);
  }
}

}  // namespace
}  // namespace smokemap
