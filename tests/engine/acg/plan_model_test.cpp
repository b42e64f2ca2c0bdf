#include "acg/plan_model.hpp"

#include <gtest/gtest.h>

#include "acg/gates.hpp"
#include "acg/read_out.hpp"
#include "geometry/angle.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

/// 100 pixels a metre, 10 x 6 m, one wall across with a door in it; the picture turned by `turn`.
LayoutMap two_rooms(double turn = 0) {
  LayoutMap plan;
  plan.width_px = 1400;
  plan.height_px = 1400;
  plan.scale = LayoutScale{0.01, 0.05, true};
  const Pose2 turned(0, 0, turn);
  const PixelFrame frame = plan.frame();
  for (const Point2& p : {Point2(0, 0), Point2(10, 0), Point2(10, 6), Point2(0, 6), Point2(4, 0.02), Point2(4, 2),
                          Point2(4.03, 3), Point2(4, 6)})
    plan.corners.push_back({frame.to_pixels(Point2(7, 7) + turned * Point2(p - Point2(5, 3))), 0, 1});
  const int ends[][2] = {{0, 4}, {4, 1}, {1, 2}, {2, 7}, {7, 3}, {3, 0}, {4, 5}, {6, 7}};
  for (const auto& e : ends) plan.walls.push_back({e[0], e[1], 15, 1, false});
  return plan;
}

GraphState as_drawn(const PlanModel& plan) {
  GraphState state;
  for (const Point2& p : plan.corners) state.corners.push_back({p.x(), p.y()});
  return state;
}

TEST(PlanModel, KnowsLengthsThicknessesAndDegreesInMetres) {
  const auto plan = make_plan_model(two_rooms(), {});
  ASSERT_THAT(plan, IsOk());
  EXPECT_NEAR(plan->walls[2].length_m, 6, 1e-9);
  EXPECT_NEAR(plan->walls[2].half_thickness_m, 0.075, 1e-9);
  EXPECT_EQ(plan->degree, (std::vector<int>{2, 2, 2, 2, 3, 1, 1, 3}));
  EXPECT_EQ(plan->scale_sigma, 0.05);
}

TEST(PlanModel, FindsTheDrawnLinesWhateverTheTurnOfTheSheet) {
  for (const double turn : {0.0, 0.2, -0.5}) {
    const auto plan = make_plan_model(two_rooms(turn), {});
    ASSERT_THAT(plan, IsOk());
    EXPECT_NEAR(line_angle_between(plan->axis_rad, turn), 0, 0.01);
    EXPECT_EQ(plan->lines[0].size(), 3u);                               // x = 0, 4, 10
    EXPECT_EQ(plan->lines[1].size(), 4u);                               // y = 0, 2, 3, 6
    EXPECT_EQ(plan->line_of_corner[0][5], plan->line_of_corner[0][6]);  // 3 cm apart: drawn in line
    EXPECT_EQ(plan->offset_axis(plan->walls[0]), 1);
    EXPECT_EQ(plan->offset_axis(plan->walls[2]), 0);
    EXPECT_TRUE(std::is_sorted(plan->lines[0].begin(), plan->lines[0].end()));
  }
}

TEST(PlanModel, TakesADoorForAGapBetweenTwoFreeEnds) {
  const auto plan = make_plan_model(two_rooms(), {});
  ASSERT_EQ(plan->gaps.size(), 1u);
  EXPECT_EQ(std::minmax(plan->gaps[0].corner_a, plan->gaps[0].corner_b), std::minmax(5, 6));
  EXPECT_NEAR(plan->gaps[0].length_m, 1, 0.01);
}

TEST(PlanModel, GuessesTheScaleFromDoorsOrSaysThatItDoesNotKnow) {
  LayoutMap plan = two_rooms();
  plan.scale.reset();
  EXPECT_GE(make_plan_model(plan, {})->scale_sigma, 0.3);
  for (int i = 0; i < 3; ++i)
    plan.openings.push_back({{Point2(0, 100 * i), Point2(60, 100 * i)}, OpeningKind::kDoor, 1});
  EXPECT_NEAR(make_plan_model(plan, {})->metres_per_pixel, 0.015, 1e-9);
}

TEST(PlanModel, RefusesWhatIsNoPlan) {
  LayoutMap plan = two_rooms();
  plan.walls[0].corner_b = 99;
  EXPECT_THAT(make_plan_model(plan, {}), Fails(Errc::kInvalidArgument));
  plan = two_rooms();
  plan.corners[1].p_px.x() = std::nan("");
  EXPECT_THAT(make_plan_model(plan, {}), Fails(Errc::kInvalidArgument));
  plan = two_rooms();
  for (LayoutWall& w : plan.walls) w.corner_b = w.corner_a;
  EXPECT_THAT(make_plan_model(plan, {}), Fails(Errc::kDegenerate));
}

TEST(WallGates, AreNarrowBesideKnownWallsAndWidenWithTheDistance) {
  const PlanModel plan = *make_plan_model(two_rooms(), {});
  std::vector<WallState> states(plan.walls.size(), WallState::kUnseen);
  std::vector<double> linked(plan.walls.size(), 0);
  const AcgParams params;
  const auto first = wall_gates_m(plan, states, linked, params);
  for (const double g : first) EXPECT_NEAR(g, first[0], 1e-9);  // nothing is known yet
  states[5] = WallState::kConfirmed;                            // x = 0
  linked[5] = 3;
  const auto gates = wall_gates_m(plan, states, linked, params);
  EXPECT_EQ(gates[5], params.gate_end_m);
  EXPECT_GT(gates[6], gates[5]);             // x = 4
  EXPECT_GE(gates[2], gates[6]);             // x = 10
  EXPECT_EQ(gates[0], params.gate_start_m);  // across: nothing is known of it
}

TEST(Tension, IsNoneForAPlanThatWasOnlyTurnedAndShifted) {
  const PlanModel plan = *make_plan_model(two_rooms(), {});
  GraphState state = as_drawn(plan);
  const Pose2 moved(3, -2, 0.7);
  for (auto& c : state.corners) {
    const Point2 p = moved * Point2(c[0], c[1]);
    c = {p.x(), p.y()};
  }
  state.turn = 0.7;
  EXPECT_NEAR(plan_tension(plan, state, {}), 0, 1e-9);
  for (const bool tense : tense_walls(plan, state, {})) EXPECT_FALSE(tense);
}

TEST(Tension, IsFeltByAWallThatIsTurnedButNotByOneThatIsStretched) {
  const PlanModel plan = *make_plan_model(two_rooms(), {});
  GraphState state = as_drawn(plan);
  state.corners[1][0] += 1.0;  // both walls at the lower right corner: one longer, one turned by ten degrees
  const auto tense = tense_walls(plan, state, {});
  EXPECT_FALSE(tense[1]);
  EXPECT_TRUE(tense[2]);
  EXPECT_GT(plan_tension(plan, state, {}), 1);
}

TEST(DropImmature, TakesTheWeightOfWallsThatWereHardlySeen) {
  const PlanModel plan = *make_plan_model(two_rooms(), {});
  std::vector<double> linked(plan.walls.size(), 0);
  linked[2] = 0.9;
  std::vector<PieceLink> pieces(2);
  pieces[0].wall = 2, pieces[1].wall = 3;
  drop_immature(linked, plan, {}, pieces);
  EXPECT_EQ(pieces[0].weight, 1);
  EXPECT_EQ(pieces[1].weight, 0);
  std::vector<CornerLink> corners(1);
  corners[0].walls = {2, 3};
  drop_immature(linked, plan, {}, corners);
  EXPECT_EQ(corners[0].weight, 0);
}

TEST(JudgeWallState, NeedsBeamsThroughHalfOfItAndNothingElseNearToCallAWallMissing) {
  WallEvidence evidence;
  evidence.hit.assign(20, 0);
  evidence.through.assign(20, 0);
  EXPECT_EQ(judge_wall_state(evidence, 0, 0, {}), WallState::kUnseen);
  std::fill_n(evidence.through.begin(), 12, 3);
  EXPECT_EQ(judge_wall_state(evidence, 0, 0, {}), WallState::kMissing);
  EXPECT_EQ(judge_wall_state(evidence, 0, 1.0, {}), WallState::kUnseen);  // misplaced rather than missing
  std::fill_n(evidence.through.begin(), 12, 1);                           // one node alone may be wrong
  EXPECT_EQ(judge_wall_state(evidence, 0, 0, {}), WallState::kUnseen);
  std::fill_n(evidence.hit.begin() + 12, 8, 2);
  EXPECT_EQ(judge_wall_state(evidence, 0, 0, {}), WallState::kConfirmed);
}

}  // namespace
}  // namespace smokemap
