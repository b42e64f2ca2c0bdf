#include "session/session_core.hpp"

#include <gtest/gtest.h>

#include "tests/engine/session/scene.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::goal_at;
using test::poi_at;
using test::Scene;
using test::square_plan;

TEST(SessionCore, AGoalIsDrivenToAndReported) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(goal_at("g", {3, 2}), Origin::kLive), test::IsOk());
  for (int i = 0; i < 300 && !is_final(scene.state()); ++i) scene.step();
  EXPECT_EQ(scene.state(), GoalState::kArrived);
  EXPECT_LT((scene.pose.translation() - Point2(3, 2)).norm(), 0.35);
}

TEST(SessionCore, AGoalOutsideOfEverythingKnownIsRefusedWithTheReason) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(goal_at("g", {30, 2}), Origin::kLive), test::IsOk());
  for (int i = 0; i < 300 && !is_final(scene.state()); ++i) scene.step();
  EXPECT_EQ(scene.state(), GoalState::kRefused);
  EXPECT_EQ(scene.core.snapshot(scene.now).goals.front().goal.reason,
            "the place is neither on the plan nor seen by a robot");
}

TEST(SessionCore, TheEmergencyStopReachesTheRobotAtOnceAndHolds) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(goal_at("g", {3, 2}), Origin::kLive), test::IsOk());
  for (int i = 0; i < 20; ++i) scene.step();
  ASSERT_NE(scene.recorder->last["robot1"].speed_mps, 0);
  ASSERT_THAT(scene.core.apply(EmergencyStop{"", true}, Origin::kLive), test::IsOk());
  EXPECT_EQ(scene.recorder->last["robot1"].speed_mps, 0) << "before the next tick";
  const Pose2 stopped_at = scene.pose;
  for (int i = 0; i < 50; ++i) scene.step();
  EXPECT_THAT(scene.pose, test::IsNear(stopped_at, 1e-9, 1e-9));
  ASSERT_THAT(scene.core.apply(EmergencyStop{"", false}, Origin::kLive), test::IsOk());
  for (int i = 0; i < 300 && !is_final(scene.state()); ++i) scene.step();
  EXPECT_EQ(scene.state(), GoalState::kArrived);
}

TEST(SessionCore, ARobotThatIsSilentGetsNoCommands) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(goal_at("g", {3, 2}), Origin::kLive), test::IsOk());
  scene.step();
  const int calls = scene.recorder->calls;
  scene.core.tick(scene.now + from_seconds(6));
  EXPECT_EQ(scene.recorder->calls, calls);
  const RobotStatus status = scene.core.snapshot(scene.now).robots.front();
  EXPECT_EQ(status.link, LinkQuality::kLost);
  EXPECT_EQ(status.note, "no signal from the robot");
}

TEST(SessionCore, GoalsFromTheLogDoNotStartRobots) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(goal_at("g", {3, 2}), Origin::kHistory), test::IsOk());
  for (int i = 0; i < 20; ++i) scene.step();
  EXPECT_EQ(scene.state(), GoalState::kCancelled);
  EXPECT_THAT(scene.pose, test::IsNear(Pose2(), 1e-9, 1e-9));
}

TEST(SessionCore, AnOldStartIsNotBelievedAfterARestart) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(SetLayout{"plan", square_plan()}, Origin::kHistory), test::IsOk());
  ASSERT_THAT(scene.core.apply(SetStart{"robot1", {50, 50}, 0}, Origin::kHistory), test::IsOk());
  EXPECT_FALSE(scene.core.merge_input(FloorGraph{}).start);
  ASSERT_EQ(scene.core.snapshot(0).alerts.size(), 1u);
  ASSERT_THAT(scene.core.apply(SetStart{"robot1", {50, 50}, 0}, Origin::kLive), test::IsOk());
  EXPECT_TRUE(scene.core.merge_input(FloorGraph{}).start);
  EXPECT_TRUE(scene.core.snapshot(0).alerts.empty());
}

TEST(SessionCore, AStartGivenWhileDrivingIsCarriedBackToTheFirstPose) {
  Scene scene;
  scene.pose = Pose2(2, 0, kPi / 2);
  scene.step();
  ASSERT_THAT(scene.core.apply(SetLayout{"plan", square_plan()}, Origin::kLive), test::IsOk());
  ASSERT_THAT(scene.core.apply(SetStart{"robot1", {50, 50}, 0}, Origin::kLive), test::IsOk());
  const auto start = scene.core.merge_input(FloorGraph{}).start;
  ASSERT_TRUE(start);
  const Pose2 T_layout_now = start->T_layout_robot * Pose2(2, 0, kPi / 2);
  EXPECT_THAT(T_layout_now, test::IsNear(Pose2(square_plan().frame().to_metres({50, 50}), 0), 1e-9, 1e-9));
}

TEST(SessionCore, AStartOfTheSecondRobotDoesNotMoveThePlan) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(SetLayout{"plan", square_plan()}, Origin::kLive), test::IsOk());
  ASSERT_THAT(scene.core.apply(SetStart{"robot1", {50, 50}, 0}, Origin::kLive), test::IsOk());
  auto graph = std::make_shared<PoseGraph>();
  graph->nodes.emplace_back().robot = "robot1";
  const auto before = scene.core.merge_input({graph, 0}).start;
  ASSERT_TRUE(before);
  ASSERT_THAT(scene.core.apply(SetStart{"robot2", {90, 120}, 1}, Origin::kLive), test::IsOk());
  const auto after = scene.core.merge_input({graph, 0}).start;
  ASSERT_TRUE(after);
  EXPECT_THAT(after->T_layout_robot, test::IsNear(before->T_layout_robot, 1e-12, 1e-12));
}

TEST(SessionCore, HintsReachTheMapperAndCountUp) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(SetLayout{"plan", square_plan()}, Origin::kLive), test::IsOk());
  const auto none = scene.core.floor();
  EXPECT_TRUE(none->hints.empty());
  ASSERT_THAT(scene.core.apply(SetStart{"robot2", {90, 120}, 1}, Origin::kLive), test::IsOk());
  ASSERT_THAT(scene.core.apply(SetStart{"robot2", {95, 120}, 1}, Origin::kLive), test::IsOk());
  const auto floor = scene.core.floor();
  EXPECT_NE(floor, none) << "a new object, so that the mapper sees at a glance that something changed";
  EXPECT_EQ(floor->hints.at("robot2").revision, 2);
  const Point2 p = square_plan().frame().to_metres({95, 120});
  EXPECT_THAT(floor->hints.at("robot2").T_layout_robot, test::IsNear(Pose2(p, 1), 1e-9, 1e-9));
  ASSERT_THAT(scene.core.apply(SetLayout{"another", square_plan(300)}, Origin::kLive), test::IsOk());
  EXPECT_TRUE(scene.core.floor()->hints.empty()) << "they were places on the old plan";
}

TEST(SessionCore, EveryRobotGetsItsOwnCorrection) {
  Scene scene;
  MergeResult result = test::free_square();
  result.T_map_graph["robot1"] = Pose2(1, 0, 0);
  result.T_map_graph["robot2"] = Pose2(0, 2, kPi / 2);
  scene.core.take(result);
  scene.core.heard("robot2", scene.now);
  scene.core.report(test::standing_at(Pose2(1, 0, 0), "robot2"));
  const Snapshot snapshot = scene.core.snapshot(scene.now);
  ASSERT_EQ(snapshot.robots.size(), 2u);
  EXPECT_THAT(snapshot.robots[0].T_map_robot, test::IsNear(Pose2(1, 0, 0) * scene.pose, 1e-9, 1e-9));
  EXPECT_THAT(snapshot.robots[1].T_map_robot, test::IsNear(Pose2(0, 3, kPi / 2), 1e-9, 1e-9));
}

TEST(SessionCore, AMarkOnARobotsMapFromBeforeTheRestartHasNoPlace) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(poi_at("old", PlaceFrame::kMap, {1, 1}), Origin::kHistory), test::IsOk());
  ASSERT_THAT(scene.core.apply(poi_at("new", PlaceFrame::kMap, {1, 1}), Origin::kLive), test::IsOk());
  const Snapshot snapshot = scene.core.snapshot(scene.now);
  ASSERT_EQ(snapshot.pois.size(), 2u);
  for (const PoiView& view : snapshot.pois) {
    EXPECT_EQ(view.in_map.p.has_value(), view.poi.id == "new");
    EXPECT_EQ(view.in_map.reason.empty(), view.poi.id == "new");
  }
}

TEST(SessionCore, AMergeThatFailedIsSaidAndTheMapBeforeItStays) {
  Scene scene;
  MergeResult result = test::free_square();
  result.complaint = "the graph did not settle";
  scene.core.take(result);
  const Snapshot snapshot = scene.core.snapshot(scene.now);
  ASSERT_EQ(snapshot.alerts.size(), 1u);
  EXPECT_NE(snapshot.alerts.front().text.find("the graph did not settle"), std::string::npos);
  EXPECT_FALSE(snapshot.alerts.front().urgent);
}

TEST(SessionCore, APlanThatDoesNotFitIsAnUrgentAlertAndGivesNoPlaces) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(SetLayout{"plan", square_plan()}, Origin::kLive), test::IsOk());
  MergedMap merged = plan_alone(square_plan(), PlanStart{});
  MergeResult result = test::free_square();
  result.merged = std::make_shared<const MergedMap>(merged);
  scene.core.take(result);
  const Point2 p_map(2, 2);
  ASSERT_TRUE(scene.core.place_on_plan(p_map));
  merged.fit = {0.1, "does not fit"};
  result.merged = std::make_shared<const MergedMap>(merged);
  scene.core.take(result);
  EXPECT_FALSE(scene.core.place_on_plan(p_map));
  ASSERT_FALSE(scene.core.snapshot(scene.now).alerts.empty());
  EXPECT_TRUE(scene.core.snapshot(scene.now).alerts.front().urgent);
  EXPECT_FALSE(scene.core.place_on_plan({std::nan(""), 0}));
}

TEST(SessionCore, APlaceOnTheMapComesBackToItsPixel) {
  Scene scene;
  ASSERT_THAT(scene.core.apply(SetLayout{"plan", square_plan()}, Origin::kLive), test::IsOk());
  MergeResult result = test::free_square();
  const PlanStart start{Pose2(2, 3, 0.7), 0.3, 0.05};
  result.merged = std::make_shared<const MergedMap>(plan_alone(square_plan(), start));
  scene.core.take(result);
  const Point2 p_px(70, 150);
  const Point2 p_map = start.T_layout_robot.inverse() * square_plan().frame().to_metres(p_px);
  const auto back = scene.core.place_on_plan(p_map);
  ASSERT_TRUE(back);
  EXPECT_THAT(*back, test::IsNearPoint(p_px, 1e-6));
}

}  // namespace
}  // namespace smokemap
