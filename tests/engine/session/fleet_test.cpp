#include "session/fleet.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/engine/session/scene.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::goal_at;
using test::Recorder;
using test::standing_at;

/// A free room of 10 m whose left and right thirds nobody saw; walls around. Two robots in the middle.
std::shared_ptr<const CostMap> half_seen_room() {
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.origin = {-6, -6};
  frame.width_cells = frame.height_cells = 120;
  std::vector<Ground> ground(static_cast<std::size_t>(frame.width_cells) * 120, Ground::kBlocked);
  for (int y = 10; y < 110; ++y)
    for (int x = 10; x < 110; ++x)
      ground[static_cast<std::size_t>(y) * 120 + static_cast<std::size_t>(x)] =
          x < 40 || x >= 80 ? Ground::kPlanned : Ground::kFree;
  return std::make_shared<const CostMap>(frame, std::move(ground), CostMapParams{});
}

struct Pair {
  std::shared_ptr<Recorder> recorder = std::make_shared<Recorder>();
  Fleet fleet;
  Whiteboard board;
  MergedMap merged;
  SketchReading sketch;
  std::map<std::string, Pose2> poses;
  Stamp now = 0;

  explicit Pair(std::map<std::string, Pose2> at, const FleetParams& params = {})
      : fleet(params, recorder), poses(std::move(at)) {
    fleet.set_map(half_seen_room());
  }
  void step(int steps = 1) {
    for (int i = 0; i < steps; ++i) {
      for (auto& [robot, pose] : poses) {
        fleet.heard(robot, now);
        fleet.report(standing_at(pose, robot));
      }
      fleet.tick(now, board, Carrier(board, merged, sketch));
      for (auto& [robot, pose] : poses) {
        const Twist twist = recorder->last[robot];
        pose = pose * Pose2(twist.speed_mps * 0.1, 0, twist.turn_rate_radps * 0.1);
      }
      now += from_seconds(0.1);
    }
  }
  const RobotStatus status(const std::string& robot) const {
    for (const RobotStatus& s : fleet.status())
      if (s.id == robot) return s;
    return {};
  }
};

TEST(Fleet, TwoExplorersGoDifferentWays) {
  Pair pair({{"a", Pose2(0, 0.5, 0)}, {"b", Pose2(0, -0.5, 0)}});
  for (const char* robot : {"a", "b"}) ASSERT_THAT(pair.board.apply(SetExploring{robot, true}), test::IsOk());
  pair.step(30);
  const auto a = pair.status("a").path_map, b = pair.status("b").path_map;
  ASSERT_FALSE(a.empty());
  ASSERT_FALSE(b.empty());
  EXPECT_LT(a.back().x() * b.back().x(), 0) << "one to the left, one to the right";
}

TEST(Fleet, ARobotStopsForAnotherOneThatItsSensorsDoNotShow) {
  Pair pair({{"a", Pose2(0, 0, 0)}, {"b", Pose2(1.2, 0, 0)}});
  SetGoal set = goal_at("g", {2.5, 0});
  set.goal.robot = "a";
  ASSERT_THAT(pair.board.apply(set), test::IsOk());
  double nearest = 10;
  for (int i = 0; i < 60; ++i) {
    pair.step();
    nearest = std::min(nearest, (pair.poses.at("a").translation() - pair.poses.at("b").translation()).norm());
  }
  EXPECT_GT(nearest, FleetParams{}.robot_radius_m + 0.2) << "its own radius is 0.25 m";
}

TEST(Fleet, GoalsAreDrivenToInTheOrderInWhichTheyWereGiven) {
  Pair pair({{"robot1", Pose2()}});
  ASSERT_THAT(pair.board.apply(goal_at("first", {1.5, 0})), test::IsOk());
  ASSERT_THAT(pair.board.apply(goal_at("second", {-1.5, 0})), test::IsOk());
  pair.step(5);
  EXPECT_EQ(pair.status("robot1").goal_id, "first");
  EXPECT_EQ(pair.board.find_goal("second")->state, GoalState::kQueued);
  for (int i = 0; i < 400 && !is_final(pair.board.find_goal("second")->state); ++i) pair.step();
  EXPECT_EQ(pair.board.find_goal("first")->state, GoalState::kArrived);
  EXPECT_EQ(pair.board.find_goal("second")->state, GoalState::kArrived);
  EXPECT_LT((pair.poses.at("robot1").translation() - Point2(-1.5, 0)).norm(), 0.35);
}

TEST(Fleet, ACancelledGoalLetsTheRobotStand) {
  Pair pair({{"robot1", Pose2()}});
  ASSERT_THAT(pair.board.apply(goal_at("g", {3, 0})), test::IsOk());
  pair.step(15);
  ASSERT_GT(pair.recorder->last["robot1"].speed_mps, 0);
  ASSERT_THAT(pair.board.apply(CancelGoal{"g"}), test::IsOk());
  pair.step(2);
  EXPECT_EQ(pair.recorder->last["robot1"].speed_mps, 0);
  EXPECT_TRUE(pair.status("robot1").goal_id.empty());
}

TEST(Fleet, TimeAndWayToGoShrink) {
  Pair pair({{"robot1", Pose2()}});
  ASSERT_THAT(pair.board.apply(goal_at("g", {4, 0})), test::IsOk());
  pair.step(5);
  const Carrier carrier(pair.board, pair.merged, pair.sketch);
  const GoalView early = pair.fleet.view(*pair.board.find_goal("g"), carrier);
  EXPECT_NEAR(early.remaining_m, 4, 0.6);
  EXPECT_GT(early.eta_s, early.remaining_m / FollowerParams{}.max_speed_mps)
      << "nobody drives at top speed all the way";
  pair.step(40);
  EXPECT_LT(pair.fleet.view(*pair.board.find_goal("g"), carrier).remaining_m, early.remaining_m - 1);
}

TEST(Fleet, ARobotThatNeverKnewWhereItIsIsNotDriven) {
  Pair pair({{"robot1", Pose2()}});
  PoseReport lost = standing_at(Pose2(), "robot2");
  lost.localized = false;
  ASSERT_THAT(pair.board.apply(SetExploring{"robot2", true}), test::IsOk());
  pair.fleet.heard("robot2", 0);
  pair.fleet.report(lost);
  pair.step(20);
  EXPECT_FALSE(pair.recorder->last.contains("robot2"));
  EXPECT_EQ(pair.status("robot2").note, "the robot does not know where it is yet");
  EXPECT_FALSE(pair.fleet.T_graph_robot("robot2"));
}

TEST(Fleet, LinksGetOldByTheClockAlone) {
  Pair pair({{"robot1", Pose2()}});
  pair.step();
  const auto after = [&](double seconds) {
    pair.fleet.tick(from_seconds(seconds), pair.board, Carrier(pair.board, pair.merged, pair.sketch));
    return pair.status("robot1").link;
  };
  EXPECT_EQ(after(0.9), LinkQuality::kFresh);
  EXPECT_EQ(after(1.1), LinkQuality::kStale);
  EXPECT_EQ(after(5.1), LinkQuality::kLost);
}

/// A robot that drives to where it is led in a straight line.
struct Navigator : Pair {
  explicit Navigator(const Pose2& at) : Pair({{"robot1", at}}) { recorder->errands["robot1"] = Errand::kNone; }
  Pose2& pose() { return poses.at("robot1"); }
  void step_and_drive() {
    step();
    const std::vector<Pose2>& told = recorder->places["robot1"];
    if (told.size() > heard_) T_map_wanted_ = pose() * told.back(), heard_ = told.size();
    if (!T_map_wanted_) return;
    const Point2 way = T_map_wanted_->translation() - pose().translation();
    const double length = way.norm();
    if (length > 0.05)
      pose() = Pose2(pose().translation() + std::min(0.05, length) / length * way, std::atan2(way.y(), way.x()));
    else
      pose() = *T_map_wanted_, recorder->errands["robot1"] = Errand::kDone;
  }
  const Pose2& wanted() const { return *T_map_wanted_; }

 private:
  std::optional<Pose2> T_map_wanted_;
  std::size_t heard_ = 0;
};

TEST(Fleet, ARobotWithItsOwnNavigatorIsLedAndGivenNoVelocities) {
  Navigator robot(Pose2(-3, 0, 2));
  SetGoal set = goal_at("g", {4, 0});
  set.goal.heading_rad = 1.0;
  ASSERT_THAT(robot.board.apply(set), test::IsOk());
  for (int i = 0; i < 400 && !is_final(robot.board.find_goal("g")->state); ++i) {
    robot.step_and_drive();
    EXPECT_EQ(robot.recorder->last["robot1"].speed_mps, 0);
  }
  EXPECT_EQ(robot.board.find_goal("g")->state, GoalState::kArrived);
  EXPECT_LT((robot.pose().translation() - Point2(4, 0)).norm(), 0.3);
  EXPECT_NEAR(robot.pose().heading(), 1.0, 0.2) << "stands as it was asked to";
  EXPECT_LE(robot.recorder->places["robot1"].size(), 5U) << "not a new place with every tick";
}

TEST(Fleet, AnotherGoalOrNoneReachesTheNavigatorToo) {
  Navigator robot{Pose2()};
  ASSERT_THAT(robot.board.apply(goal_at("g", {4, 0})), test::IsOk());
  for (int i = 0; i < 10; ++i) robot.step_and_drive();
  ASSERT_EQ(robot.board.find_goal("g")->state, GoalState::kDriving);
  ASSERT_THAT(robot.board.apply(CancelGoal{"g"}), test::IsOk());
  robot.step_and_drive();
  EXPECT_EQ(robot.recorder->stops["robot1"], 1) << "called off, once";
  ASSERT_THAT(robot.board.apply(goal_at("h", {0, 4})), test::IsOk());
  for (int i = 0; i < 5; ++i) robot.step_and_drive();
  EXPECT_GT(robot.wanted().y(), 3);
}

TEST(Fleet, AfterAnEmergencyStopTheNavigatorIsToldAgain) {
  Navigator robot{Pose2()};
  ASSERT_THAT(robot.board.apply(goal_at("g", {4, 0})), test::IsOk());
  for (int i = 0; i < 5; ++i) robot.step_and_drive();
  const std::size_t told = robot.recorder->places["robot1"].size();
  ASSERT_THAT(robot.board.apply(EmergencyStop{"", true}), test::IsOk());
  robot.step(5);
  EXPECT_EQ(robot.recorder->places["robot1"].size(), told);
  ASSERT_THAT(robot.board.apply(EmergencyStop{"", false}), test::IsOk());
  robot.recorder->errands["robot1"] = Errand::kGivenUp;  // the stop called it off
  robot.step(2);
  EXPECT_EQ(robot.recorder->places["robot1"].size(), told + 1);
  EXPECT_FALSE(is_final(robot.board.find_goal("g")->state));
}

TEST(Fleet, AGoalThatTheNavigatorDoesNotReachFailsWithTheReason) {
  Navigator robot{Pose2()};
  ASSERT_THAT(robot.board.apply(goal_at("g", {4, 0})), test::IsOk());
  for (int i = 0; i < 20; ++i) {
    robot.step();
    if (robot.recorder->errands["robot1"] == Errand::kUnderWay) robot.recorder->errands["robot1"] = Errand::kGivenUp;
  }
  const Goal& goal = *robot.board.find_goal("g");
  EXPECT_TRUE(is_final(goal.state));
  EXPECT_NE(goal.state, GoalState::kArrived);
  EXPECT_EQ(goal.reason, "the robot's own navigator does not get there");
  EXPECT_EQ(robot.recorder->places["robot1"].size(), 4U);
}

TEST(Fleet, ARobotThatCannotGetOnInSmokeSaysSoAndGoesBackToWhereItCanSee) {
  Pair robots({{"robot1", Pose2(-1, 0, 0)}});
  ASSERT_THAT(robots.board.apply(goal_at("g", {4, 0})), test::IsOk());
  Pose2& pose = robots.poses["robot1"];
  std::string reason;
  for (int i = 0; i < 1500; ++i) {
    robots.fleet.heard("robot1", robots.now);
    PoseReport report = standing_at(pose);
    report.smoke_share = pose.x() > 1.0 ? 0.9 : 0.0;
    for (double y = -5; y < 5; y += 0.05)  // a fence that the map does not show
      if (const Point2 p = pose.inverse() * Point2(2.0, y); p.norm() < 1.2) report.obstacles_robot.push_back(p);
    robots.fleet.report(report);
    robots.fleet.tick(robots.now, robots.board, Carrier(robots.board, robots.merged, robots.sketch));
    const Twist twist = robots.recorder->last["robot1"];
    pose = pose * Pose2(twist.speed_mps * 0.1, 0, twist.turn_rate_radps * 0.1);
    robots.now += from_seconds(0.1);
    ASSERT_LT(pose.x(), 1.75) << "it does not touch the fence";
  }
  const Goal& goal = *robots.board.find_goal("g");
  EXPECT_EQ(goal.state, GoalState::kFailed);
  EXPECT_NE(goal.reason.find("cannot get on in the smoke"), std::string::npos) << goal.reason;
  EXPECT_LT(pose.x(), 1.3) << "back in clear air";
}

// Regression: a robot stood where a plan that was laid wrong by 7 m had the goal, and "arrived".
TEST(Fleet, NothingIsReachedOnAPlanThatDoesNotFit) {
  const Point2 p_px(100, 100);
  const MergedMap plan = plan_alone(test::square_plan(), PlanStart{});
  const Point2 p_map = plan.layout_to_map(test::square_plan().frame().to_metres(p_px));
  const auto send = [&](const std::string& verdict) {
    auto pair = std::make_unique<Pair>(std::map<std::string, Pose2>{{"a", Pose2(p_map.x(), p_map.y(), 0)}});
    EXPECT_THAT(pair->board.apply(SetLayout{"plan", test::square_plan()}), test::IsOk());
    pair->merged = plan;
    pair->merged.fit = {0.1, verdict};
    SetGoal set;
    set.goal.id = "g", set.goal.robot = "a";
    set.goal.place = {PlaceFrame::kLayoutPx, p_px, pair->board.revisions.layout_frame};
    EXPECT_THAT(pair->board.apply(set), test::IsOk());
    pair->step(50);
    return pair;
  };
  EXPECT_EQ(send("fits")->board.find_goal("g")->state, GoalState::kArrived);
  const auto doubted = send("does not fit");
  const Goal& goal = *doubted->board.find_goal("g");
  EXPECT_EQ(goal.state, GoalState::kDriving);
  EXPECT_EQ(goal.reason, "this plan does not seem to fit this building");
  doubted->step(200);
  EXPECT_EQ(goal.state, GoalState::kFailed) << "its patience ends";
  EXPECT_EQ(goal.reason, "this plan does not seem to fit this building");
  const auto laid_right = send("does not fit");
  laid_right->merged.fit = {0.9, "fits"};
  laid_right->step(2);
  EXPECT_EQ(laid_right->board.find_goal("g")->state, GoalState::kArrived);
}

TEST(Fleet, LookingForAWayEndsAfterAMinuteWithoutComingAnywhereNew) {
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.width_cells = 120, frame.height_cells = 60;
  std::vector<Ground> ground(frame.cell_count(), Ground::kBlocked);
  for (int y = 5; y < 55; ++y)
    for (int x = 5; x < 115; ++x)
      if (x < 78 || x > 82) ground[frame.index({x, y})] = x < 30 || x > 82 ? Ground::kFree : Ground::kPlanned;
  Pair robots({{"robot1", Pose2(1.5, 3, 0)}});
  robots.fleet.set_map(std::make_shared<const CostMap>(frame, std::move(ground), CostMapParams{}));
  ASSERT_THAT(robots.board.apply(goal_at("g", {10, 3})), test::IsOk());
  for (int i = 0; i < 1500 && !is_final(robots.board.find_goal("g")->state); ++i) {
    robots.poses["robot1"] = Pose2(1.5, 3, 0);  // its wheels spin
    robots.step();
  }
  const Goal& goal = *robots.board.find_goal("g");
  EXPECT_TRUE(is_final(goal.state));
  EXPECT_LT(to_seconds(robots.now), 100);
  EXPECT_FALSE(goal.reason.empty());
}

TEST(Fleet, LookingForAWayEndsInTheEndAlsoWhereThereIsAlwaysSomethingNew) {
  FleetParams params;
  params.look_limit_s = 5;
  Pair robots({{"robot1", Pose2(1.5, 3, 0)}}, params);
  GridFrame frame;
  frame.resolution_m = 0.1;
  frame.width_cells = 120, frame.height_cells = 60;
  const auto corridor = [&](int seen_cells) {  // walled off from the goal, and longer whenever somebody looks
    std::vector<Ground> ground(frame.cell_count(), Ground::kBlocked);
    for (int y = 5; y < 55; ++y)
      for (int x = 5; x < 115; ++x)
        if (x < 78 || x > 82) ground[frame.index({x, y})] = x < seen_cells || x > 82 ? Ground::kFree : Ground::kPlanned;
    return std::make_shared<const CostMap>(frame, std::move(ground), CostMapParams{});
  };
  ASSERT_THAT(robots.board.apply(goal_at("g", {10, 3})), test::IsOk());
  for (int i = 0; i < 900 && !is_final(robots.board.find_goal("g")->state); ++i) {
    if (i % 10 == 0) robots.fleet.set_map(corridor(static_cast<int>(10 * robots.poses["robot1"].x()) + 15));
    robots.step();
  }
  const Goal& goal = *robots.board.find_goal("g");
  EXPECT_EQ(goal.state, GoalState::kFailed);
  EXPECT_NE(goal.reason.find("send the robot again"), std::string::npos) << goal.reason;
}

TEST(Fleet, AWayIsAskedFromWhereTheRobotIsNow) {
  Pair pair({{"robot1", Pose2(-1, 2, 0)}});
  EXPECT_THAT(pair.fleet.way_question("robot1", {3, 0}), test::Fails(Errc::kNotFound)) << "never heard";
  pair.fleet.heard("robot1", 0);
  EXPECT_THAT(pair.fleet.way_question("robot1", {3, 0}), test::Fails(Errc::kNotFound)) << "never localised";
  pair.step();
  const auto question = pair.fleet.way_question("robot1", {3, 0});
  ASSERT_THAT(question, test::IsOk());
  const auto way = plan_path(*question->map, question->from_map, question->to_map, question->planner);
  ASSERT_THAT(way, test::IsOk());
  EXPECT_THAT(way->points.front(), test::IsNearPoint(Point2(-1, 2), 1e-9));
  EXPECT_THAT(way->points.back(), test::IsNearPoint(Point2(3, 0), 0.1));
  EXPECT_GT(way->planned_m, 0.5) << "nobody has seen the right third";
  pair.fleet.set_map(nullptr);
  EXPECT_THAT(pair.fleet.way_question("robot1", {3, 0}), test::Fails(Errc::kDegenerate));
}

TEST(FleetParams, NameTheirFirstFieldOutOfRange) {
  FleetParams params;
  params.lost_after_s = 0.5 * params.stale_after_s;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  params = {};
  params.robot_radius_m = -1;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(FleetParams{}.validate(), test::IsOk());
}

}  // namespace
}  // namespace smokemap
