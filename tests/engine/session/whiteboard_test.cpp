#include "session/whiteboard.hpp"

#include <gtest/gtest.h>

#include "session/carrier.hpp"
#include "session/merger.hpp"
#include "session/session_core.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

LayoutMap square_plan(double side_px = 200) {
  LayoutMap layout;
  layout.width_px = layout.height_px = static_cast<int>(side_px) + 40;
  const double a = 20, b = 20 + side_px;
  for (const Point2& p : {Point2(a, a), Point2(b, a), Point2(b, b), Point2(a, b)}) layout.corners.push_back({p, 2, 1});
  for (int i = 0; i < 4; ++i) layout.walls.push_back({i, (i + 1) % 4, 4, 1, false});
  layout.scale = LayoutScale{0.05, 0.02, true};
  return layout;
}

PlacePoi poi_at(const std::string& id, PlaceFrame frame, Point2 p) {
  PlacePoi place;
  place.poi.id = id;
  place.poi.kind = PoiKind::kGasBottle;
  place.poi.place = {frame, p, 0};
  return place;
}

SetGoal goal_at(const std::string& id, Point2 p) {
  SetGoal set;
  set.goal.id = id;
  set.goal.robot = "robot1";
  set.goal.place = {PlaceFrame::kMap, p, 0};
  return set;
}

Stroke stroke(const std::string& id) {
  Stroke s;
  s.id = id;
  s.points_px = {{1, 1}, {50, 1}};
  return s;
}

TEST(Whiteboard, TheSameCommandTwiceChangesNothingTheSecondTime) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(AddStroke{stroke("s1")}), test::IsOk());
  ASSERT_THAT(board.apply(goal_at("g1", {1, 1})), test::IsOk());
  const int sketch = board.revisions.sketch;
  ASSERT_THAT(board.apply(AddStroke{stroke("s1")}), test::IsOk());
  ASSERT_THAT(board.apply(goal_at("g1", {9, 9})), test::IsOk());
  EXPECT_EQ(board.revisions.sketch, sketch);
  EXPECT_EQ(board.sketch().strokes.size(), 1u);
  EXPECT_EQ(board.goals.size(), 1u);
  EXPECT_EQ(board.goals.front().place.p, Point2(1, 1));
}

TEST(Whiteboard, ErasedStrokesComeBack) {
  Whiteboard board;
  ASSERT_THAT(board.apply(AddStroke{stroke("s1")}), test::IsOk());
  ASSERT_THAT(board.apply(EraseStroke{"s1", false}), test::IsOk());
  EXPECT_TRUE(board.sketch().strokes.empty());
  ASSERT_THAT(board.apply(EraseStroke{"s1", true}), test::IsOk());
  EXPECT_EQ(board.sketch().strokes.size(), 1u);
  EXPECT_THAT(board.apply(EraseStroke{"s2", false}), test::Fails(Errc::kNotFound));
}

TEST(Whiteboard, RefusesWhatCannotBe) {
  Whiteboard board;
  EXPECT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {1, 1})), test::Fails(Errc::kNotFound));
  EXPECT_THAT(board.apply(poi_at("", PlaceFrame::kMap, {1, 1})), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(board.apply(poi_at("p", PlaceFrame::kMap, {std::nan(""), 1})), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(board.apply(CancelGoal{"g"}), test::Fails(Errc::kNotFound));
  EXPECT_THAT(board.apply(JudgeWall{0, WallVerdict::kGone}), test::Fails(Errc::kNotFound));
  LayoutMap broken = square_plan();
  broken.walls[0].corner_a = 99;
  EXPECT_THAT(board.apply(SetLayout{"plan", broken}), test::Fails(Errc::kInvalidArgument));
  EXPECT_FALSE(board.layout);
}

TEST(Whiteboard, AnotherPictureForgetsWhatWasSaidAboutTheOldOne) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(AddAnchor{"a", {30, 30}, {0, 0}}), test::IsOk());
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  EXPECT_EQ(board.anchors.size(), 1u) << "the same picture, walls corrected";
  ASSERT_THAT(board.apply(SetLayout{"two", square_plan()}), test::IsOk());
  EXPECT_TRUE(board.anchors.empty());
}

TEST(Whiteboard, OneRobotsReleaseDoesNotReleaseAll) {
  Whiteboard board;
  ASSERT_THAT(board.apply(EmergencyStop{"", true}), test::IsOk());
  ASSERT_THAT(board.apply(EmergencyStop{"robot1", false}), test::IsOk());
  EXPECT_TRUE(board.is_stopped("robot1"));
  ASSERT_THAT(board.apply(EmergencyStop{"", false}), test::IsOk());
  EXPECT_FALSE(board.is_stopped("robot1"));
}

TEST(Carrier, ABottleOnThePlanLandsWhereThePlanLies) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {120, 120})), test::IsOk());
  const PlanStart start{Pose2(1, 2, kPi / 2), 0.3, 0.05};
  const MergedMap merged = plan_alone(board.layout->layout, start);
  const SketchReading none;
  const Transferred t = Carrier(board, merged, none).to_map(board.pois.at("p").place);
  ASSERT_TRUE(t.p);
  const Point2 p_layout = board.layout->layout.frame().to_metres({120, 120});
  EXPECT_THAT(*t.p, test::IsNearPoint(start.T_layout_robot.inverse() * p_layout, 1e-6));
  EXPECT_GT(t.sigma, 0.1) << "never without its error";
}

TEST(Carrier, AnEarlierPlansPlaceIsNoPlace) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {120, 120})), test::IsOk());
  ASSERT_THAT(board.apply(SetLayout{"two", square_plan(300)}), test::IsOk());
  const MergedMap merged = plan_alone(board.layout->layout, std::nullopt);
  const SketchReading none;
  const Transferred t = Carrier(board, merged, none).to_map(board.pois.at("p").place);
  EXPECT_FALSE(t.p);
  EXPECT_EQ(t.reason, "it was placed on an earlier plan");
}

TEST(Carrier, ASketchThatWasNotReadHasNoPlaces) {
  const Whiteboard board;
  const MergedMap merged;
  const SketchReading none;
  EXPECT_FALSE(Carrier(board, merged, none).to_map({PlaceFrame::kSketchPx, {5, 5}, 0}).p);
  EXPECT_FALSE(Carrier(board, merged, none).to_map({PlaceFrame::kLayoutPx, {5, 5}, 0}).p);
  EXPECT_TRUE(Carrier(board, merged, none).to_map({PlaceFrame::kMap, {5, 5}, 0}).p);
}

/// Remembers the last command of every robot.
class Recorder final : public RobotCommands {
 public:
  void drive(const std::string& robot, double speed_mps, double turn_rate_radps) override {
    last[robot] = {speed_mps, turn_rate_radps};
    ++calls;
  }
  std::map<std::string, Twist> last;
  int calls = 0;
};

/// A robot in the middle of a free square of 10 m.
MergeResult free_square() {
  MergeResult result;
  result.merged = std::make_shared<const MergedMap>();
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.origin = {-5, -5};
  frame.width_cells = frame.height_cells = 100;
  OccupancyGrid sensed(frame, 0);
  result.cost_map = std::make_shared<const CostMap>(*build_cost_map(*result.merged, sensed, nullptr, {}));
  result.sensed = std::make_shared<const OccupancyGrid>(std::move(sensed));
  return result;
}

PoseReport standing_at(const Pose2& pose) {
  PoseReport report;
  report.robot = "robot1";
  report.T_graph_robot = pose;
  report.localized = true;
  return report;
}

struct Scene {
  std::shared_ptr<Recorder> recorder = std::make_shared<Recorder>();
  SessionCore core{FleetParams{}, recorder};
  Pose2 pose;
  Stamp now = 0;

  Scene() {
    core.take(free_square());
    step();
  }
  void step() {
    core.heard("robot1", now);
    core.report(standing_at(pose));
    core.tick(now);
    const Twist twist = recorder->last["robot1"];
    pose = pose * Pose2(twist.speed_mps * 0.1, 0, twist.turn_rate_radps * 0.1);
    now += from_seconds(0.1);
  }
  GoalState state() const { return core.snapshot(now).goals.front().goal.state; }
};

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

}  // namespace
}  // namespace smokemap
