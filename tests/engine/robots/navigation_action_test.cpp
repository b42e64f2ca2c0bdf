// NavigateToPose over the wire, against a navigator that speaks as rmw_cyclonedds or rmw_fastrtps makes one speak.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <set>

#include "robots/gateway.hpp"
#include "robots/ros_robot.hpp"
#include "tests/engine/robots/action_peer.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

using State = NavigationState;
using test::ActionPeer;
using test::eventually;

LaserScan navigator_scan() {
  LaserScan scan;
  scan.stamp = 1;
  scan.angle_increment_rad = 0.01;
  scan.range_max_m = 10;
  scan.ranges_m.assign(100, 2.f);
  return scan;
}

/// A gateway, and the robot "fox" with or without goal_pose; its navigator is the test's.
struct Site {
  explicit Site(ServiceFormat format, bool with_robot = true) {
    GatewayParams params;
    params.domain = test::ros_domain();
    params.services = format;
    RobotGateway::Callbacks callbacks;
    callbacks.on_navigation = [this](const NavigationReport& report) { reports.put(report); };
    auto opened = RobotGateway::open(params, std::move(callbacks), clock);
    EXPECT_THAT(opened, test::IsOk());
    gateway = std::move(*opened);
    RosRobotParams robot;
    robot.robot = "fox";
    robot.domain = test::ros_domain();
    if (!with_robot) return;
    auto fox = RosRobotNode::open(robot, {[this](double v, double) { velocities.put(v); },
                                          [this](const Pose2& goal, const std::string&) { poses.put(goal); }});
    EXPECT_THAT(fox, test::IsOk());
    node = std::move(*fox);
    node->publish(navigator_scan());
  }
  RobotLink fox() const {
    for (const RobotLink& link : gateway->robots())
      if (link.id == "fox") return link;
    return {};
  }
  struct Sent {
    std::uint64_t number = 0;
    ActionPeer::GoalId id{};
  };
  /// Sends until the navigator has it: a writer needs a moment to find its readers. The robot numbers a goal in the
  /// last bytes of its identifier.
  Sent send_until_heard(ActionPeer& peer, const Pose2& goal) {
    EXPECT_TRUE(eventually([&] { return fox().navigates; }));
    Sent sent;
    std::chrono::steady_clock::time_point again;
    EXPECT_TRUE(eventually([&] {
      for (const ActionPeer::Asked& asked : peer.goals.all()) {
        std::uint64_t number = 0;
        std::memcpy(&number, asked.id.data() + 8, sizeof number);
        if (number == sent.number) sent.id = asked.id;
      }
      if (sent.id != ActionPeer::GoalId{}) return true;
      if (std::chrono::steady_clock::now() < again) return false;
      again = std::chrono::steady_clock::now() + std::chrono::seconds(1);
      const auto answer = gateway->send_goal("fox", goal);
      EXPECT_THAT(answer, test::IsOk());
      EXPECT_TRUE(answer->followed);
      sent.number = answer->number;
      return false;
    }));
    return sent;
  }
  std::vector<State> states_of(std::uint64_t number) const {
    std::vector<State> states;
    for (const NavigationReport& report : reports.all())
      if (report.goal == number) states.push_back(report.state);
    return states;
  }
  bool ends(std::uint64_t number, State state) const {
    return eventually([&] {
      const auto states = states_of(number);
      return !states.empty() && states.back() == state;
    });
  }

  std::shared_ptr<SystemClock> clock = std::make_shared<SystemClock>();
  test::Mailbox<NavigationReport> reports;
  test::Mailbox<double> velocities;
  test::Mailbox<Pose2> poses;
  std::unique_ptr<RobotGateway> gateway;
  std::unique_ptr<RosRobotNode> node;
};

class NavigateToPose : public testing::TestWithParam<ServiceFormat> {
 protected:
  bool headed() const { return GetParam() != ServiceFormat::kBare; }
};

TEST_P(NavigateToPose, IsFollowedFromTheGoalToItsEnd) {
  ActionPeer peer("fox/navigate_to_pose", headed());
  Site site(GetParam());
  const Pose2 goal(3, -4, 1.25);
  const auto [number, id] = site.send_until_heard(peer, goal);
  const ActionPeer::Asked asked = peer.goals.all().back();
  EXPECT_THAT(asked.T_frame_goal, test::IsNear(goal, 1e-12, 1e-12));
  EXPECT_EQ(asked.frame, "map");
  EXPECT_EQ(site.poses.size(), 0u) << "a robot that navigates is not given the goal twice";

  peer.say_status(id, RosGoalStatus::kExecuting);
  ASSERT_TRUE(eventually([&, goal_id = id] {
    peer.say_feedback(goal_id, 7.5, 12);
    const auto reports = site.reports.all();
    return !reports.empty() && reports.back().remaining_m == 7.5;
  }));
  const NavigationReport report = site.reports.all().back();
  EXPECT_EQ(report.robot, "fox");
  EXPECT_EQ(report.goal, number);
  EXPECT_EQ(report.state, State::kDriving);
  EXPECT_NEAR(report.eta_s, 12, 1e-6);
  EXPECT_EQ(report.recoveries, 2);
  peer.say_status(id, RosGoalStatus::kSucceeded);
  EXPECT_TRUE(site.ends(number, State::kArrived));
}

TEST_P(NavigateToPose, IsCalledOffByAnEmergencyStop) {
  ActionPeer peer("fox/navigate_to_pose", headed());
  Site site(GetParam());
  const auto [number, id] = site.send_until_heard(peer, Pose2(1, 0, 0));
  peer.say_status(id, RosGoalStatus::kExecuting);
  ASSERT_TRUE(eventually([&] { return site.fox().takes_velocity; }));
  ASSERT_TRUE(peer.cancels.wait_poking([&] { EXPECT_THAT(site.gateway->stop("fox"), test::IsOk()); }));
  EXPECT_EQ(peer.cancels.all()[0], ActionPeer::GoalId{}) << "every goal, also those that others sent";
  ASSERT_TRUE(site.velocities.wait_for(1));
  EXPECT_EQ(site.velocities.all()[0], 0);
  peer.say_status(id, RosGoalStatus::kCancelling);
  peer.say_status(id, RosGoalStatus::kCancelled);
  EXPECT_TRUE(site.ends(number, State::kCancelled));
}

TEST_P(NavigateToPose, IsRefusedWhenTheNavigatorSaysNo) {
  ActionPeer peer("fox/navigate_to_pose", headed(), false);
  Site site(GetParam());
  const std::uint64_t number = site.send_until_heard(peer, Pose2(1, 0, 0)).number;
  EXPECT_TRUE(site.ends(number, State::kRefused));
  EXPECT_EQ(site.poses.size(), 0u) << "a no is no reason to ask in another way";
}

TEST_P(NavigateToPose, FallsBackToGoalPoseWhenNothingAnswers) {
  ActionPeer peer("fox/navigate_to_pose", headed(), true, false);
  Site site(GetParam());
  ASSERT_TRUE(eventually([&] { return site.fox().takes_goals; }));
  const std::uint64_t number = site.send_until_heard(peer, Pose2(5, 6, 0.5)).number;
  EXPECT_TRUE(site.ends(number, State::kNoAnswer));
  ASSERT_TRUE(site.poses.wait_for(1));
  EXPECT_THAT(site.poses.all()[0], test::IsNear(Pose2(5, 6, 0.5), 1e-12, 1e-12));
}

TEST_P(NavigateToPose, GivesAnEarlierGoalUpForALaterOne) {
  ActionPeer peer("fox/navigate_to_pose", headed());
  Site site(GetParam());
  const auto [number, id] = site.send_until_heard(peer, Pose2(1, 0, 0));
  const std::uint64_t first = number;
  peer.say_status(id, RosGoalStatus::kExecuting);
  const auto second = site.gateway->send_goal("fox", Pose2(2, 0, 0));
  ASSERT_THAT(second, test::IsOk());
  EXPECT_TRUE(eventually([&] {
    const auto states = site.states_of(first);
    return !states.empty() && states.back() == State::kCancelled;
  }));
  ASSERT_TRUE(eventually([&] { return peer.goals.all().back().T_frame_goal.x() == 2; }));
  peer.say_status(id, RosGoalStatus::kSucceeded);  // late news of the first
  peer.say_status(peer.goals.all().back().id, RosGoalStatus::kAborted);
  EXPECT_TRUE(site.ends(second->number, State::kFailed));
  EXPECT_EQ(site.states_of(first).back(), State::kCancelled);
}

INSTANTIATE_TEST_SUITE_P(OnTheWire, NavigateToPose, testing::Values(ServiceFormat::kByVendor, ServiceFormat::kBare),
                         [](const auto& of) { return of.param == ServiceFormat::kBare ? "AsFastDds" : "AsCyclone"; });

TEST(NavigateToPoseWithHeaders, BelievesTheResultOfItsOwnQuestionOnly) {
  ActionPeer peer("fox/navigate_to_pose", true);
  Site site(ServiceFormat::kByVendor);
  const std::uint64_t number = site.send_until_heard(peer, Pose2(1, 0, 0)).number;
  peer.answer_somebody_else(false);
  ASSERT_TRUE(peer.results.wait_for(1));
  peer.give_result(RosGoalStatus::kSucceeded);
  EXPECT_TRUE(site.ends(number, State::kArrived));
  const auto states = site.states_of(number);
  EXPECT_EQ(std::count(states.begin(), states.end(), State::kRefused), 0);
}

TEST(NavigateToPoseWithHeaders, IsReportedWhenTheNavigatorGoesAway) {
  auto peer = std::make_unique<ActionPeer>("fox/navigate_to_pose", true);
  Site site(ServiceFormat::kByVendor);
  const auto [number, id] = site.send_until_heard(*peer, Pose2(1, 0, 0));
  peer->say_status(id, RosGoalStatus::kExecuting);
  ASSERT_TRUE(site.ends(number, State::kDriving));
  peer.reset();
  EXPECT_TRUE(site.ends(number, State::kNoAnswer));
  EXPECT_TRUE(eventually([&] { return !site.fox().navigates; }));
}

TEST(NavigateToPoseWithHeaders, IgnoresStatusesThatTheMessageDoesNotDefine) {
  ActionPeer peer("fox/navigate_to_pose", true);
  Site site(ServiceFormat::kByVendor);
  const auto [number, id] = site.send_until_heard(peer, Pose2(1, 0, 0));
  for (const int status : {-128, 0, 7, 127}) peer.say_status(id, static_cast<RosGoalStatus>(status));
  ActionPeer::GoalId other{};
  other.fill(9);
  peer.say_status(other, RosGoalStatus::kAborted);
  peer.say_feedback(other, 1, 1);
  peer.say_status(id, RosGoalStatus::kSucceeded);
  EXPECT_TRUE(site.ends(number, State::kArrived));
  for (const State state : site.states_of(number)) EXPECT_NE(state, State::kFailed);
}

TEST(RobotStop, ReachesARobotWithoutANavigatorAsZeroVelocity) {
  Site site(ServiceFormat::kByVendor);
  EXPECT_THAT(site.gateway->stop("nobody"), test::Fails(Errc::kNotFound));
  ASSERT_TRUE(eventually([&] { return site.fox().takes_velocity; }));
  ASSERT_TRUE(site.velocities.wait_poking([&] { EXPECT_THAT(site.gateway->stop("fox"), test::IsOk()); }));
  EXPECT_EQ(site.velocities.all()[0], 0);
}

TEST(NavigationStates, HaveWordsAndKnowTheirEnd) {
  std::set<std::string> words;
  for (int i = 0; i <= static_cast<int>(State::kNoAnswer); ++i) words.insert(to_string(static_cast<State>(i)));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(State::kNoAnswer) + 1);
  EXPECT_FALSE(is_final(State::kCancelling));
  for (const State state : {State::kArrived, State::kCancelled, State::kFailed, State::kRefused, State::kNoAnswer})
    EXPECT_TRUE(is_final(state));
}

}  // namespace
}  // namespace smokemap
