// From a person's goal to a robot's own navigator and back, over DDS.
#include "app/robot_link.hpp"

#include <gtest/gtest.h>

#include "robots/ros_robot.hpp"
#include "tests/engine/robots/action_peer.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::eventually;

const Pose2 kT_odom_map(10, 5, 1.0);  // the robot was switched on somewhere else

/// The robot "fox" in a room of 8 x 6 m, heard by an engine.
struct Site {
  Site() : navigator("fox/navigate_to_pose", true) {
    GatewayParams params;
    params.domain = test::ros_domain();
    EXPECT_THAT(links->open(params, engine, clock), test::IsOk());
    RosRobotParams robot;
    robot.robot = "fox";
    robot.domain = test::ros_domain();
    auto opened = RosRobotNode::open(robot, {[this](double v, double) { velocities.put(v); }, {}});
    EXPECT_THAT(opened, test::IsOk());
    node = std::move(*opened);
  }
  ~Site() { links->close(); }

  /// Measures from where it is; the map's frame is where the robot was first heard.
  void measure() {
    now += from_seconds(0.1);
    Odometry odometry;
    odometry.stamp = now;
    odometry.T_odom_robot = kT_odom_map * T_map_robot;
    node->publish(odometry);
    LaserScan scan;
    scan.stamp = now;
    scan.angle_min_rad = static_cast<float>(-kPi);
    scan.angle_increment_rad = static_cast<float>(2 * kPi / 360);
    scan.range_max_m = 20;
    for (int i = 0; i < 360; ++i) {
      const double angle = T_map_robot.heading() - kPi + i * 2 * kPi / 360;
      scan.ranges_m.push_back(static_cast<float>(room.range(T_map_robot.translation(), angle)));
    }
    node->publish(scan);
  }
  /// As soon as the robot knows where it is and its navigator was found.
  void send_to(const Point2& p_map) {
    ASSERT_TRUE(eventually([&] {
      measure();
      const auto status = fox();
      return status && status->localized && links->navigates("fox");
    }));
    SetGoal set;
    set.goal.id = "g";
    set.goal.robot = "fox";
    set.goal.place = {PlaceFrame::kMap, p_map, 0};
    ASSERT_THAT(engine.apply(set), test::IsOk());
  }
  std::optional<RobotStatus> fox() const {
    const auto snapshot = engine.snapshot();
    for (const RobotStatus& robot : snapshot->robots)
      if (robot.id == "fox") return robot;
    return std::nullopt;
  }
  GoalState goal_state() const {
    const auto snapshot = engine.snapshot();
    for (const GoalView& view : snapshot->goals)
      if (view.goal.id == "g") return view.goal.state;
    return GoalState::kQueued;
  }

  std::shared_ptr<SystemClock> clock = std::make_shared<SystemClock>();
  std::shared_ptr<app::RobotLinkage> links = std::make_shared<app::RobotLinkage>();
  Engine engine{{}, clock, links};
  test::ActionPeer navigator;
  test::Mailbox<double> velocities;
  std::unique_ptr<RosRobotNode> node;
  Pose2 T_map_robot;
  Stamp now = from_seconds(100);
  struct Room {
    double range(const Point2& p, double angle) const {
      const double x = std::cos(angle), y = std::sin(angle);
      const double to_x = ((x > 0 ? 5.0 : -3.0) - p.x()) / x, to_y = ((y > 0 ? 3.5 : -2.5) - p.y()) / y;
      return std::min(std::abs(to_x), std::abs(to_y));
    }
  } room;
};

TEST(RobotLinkage, LeadsARobotByItsOwnNavigatorInTheFrameOfItsOdometry) {
  Site site;
  site.send_to(Point2(2.5, 1));
  ASSERT_TRUE(eventually([&] {
    site.measure();
    return !site.navigator.goals.all().empty();
  }));
  const auto asked = site.navigator.goals.all().back();
  EXPECT_EQ(asked.frame, "odom");
  EXPECT_THAT(asked.T_frame_goal.translation(), test::IsNearPoint(kT_odom_map * Point2(2.5, 1), 0.2));
  EXPECT_EQ(site.links->errand("fox"), Errand::kUnderWay);

  for (int i = 1; i <= 10; ++i) {  // the navigator drives it there
    site.T_map_robot = Pose2(0.25 * i, 0.1 * i, 0);
    ASSERT_TRUE(eventually([&] {
      site.measure();
      return (site.fox()->T_map_robot.translation() - site.T_map_robot.translation()).norm() < 0.2;
    }));
  }
  EXPECT_TRUE(eventually([&] {
    site.measure();
    return site.goal_state() == GoalState::kArrived;
  }));
  for (const double speed : site.velocities.all()) EXPECT_EQ(speed, 0) << "two drivers would fight";
}

TEST(RobotLinkage, ANavigatorThatRefusesEverythingEndsTheGoal) {
  Site site;
  site.send_to(Point2(2.5, 1));
  std::size_t answered = 0;
  ASSERT_TRUE(eventually([&] {
    site.measure();
    const auto asked = site.navigator.goals.all();
    for (; answered < asked.size(); ++answered) site.navigator.say_status(asked[answered].id, RosGoalStatus::kAborted);
    return is_final(site.goal_state());
  }));
  EXPECT_NE(site.goal_state(), GoalState::kArrived);
}

}  // namespace
}  // namespace smokemap
