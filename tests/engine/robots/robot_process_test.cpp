#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "robots/gateway.hpp"
#include "robots/ros_robot.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/ros_domain.hpp"

// The wire itself: a robot in a process of its own, reached over loopback UDP. The robot's program is this one, told by
// its environment to be the robot.

namespace smokemap {
namespace {

LaserScan process_scan() {
  LaserScan scan{7, "", -3, 0.0078125f, 0, 0.125, 30, {}, {}, {}};
  for (int i = 0; i < 720; ++i) scan.ranges_m.push_back(0.25f * static_cast<float>(i % 100));
  return scan;
}

RadarSweep process_sweep() {
  RadarSweep sweep{7, 0.4, "", 0, 0.015625f, 0.25, 0.0625, 400, 500, {}, {}};
  for (int i = 0; i < 400 * 500; ++i) sweep.power.push_back(static_cast<float>(i % 1013));
  return sweep;
}

/// The robot's side: says what it measures until its input ends, and tells back in its odometry how fast it was told to
/// go.
TEST(RobotProcess, DISABLED_IsTheRobot) {
  std::atomic<double> speed_mps = 0;
  RosRobotParams params;
  params.domain = test::ros_domain();
  auto node = RosRobotNode::open(params, {[&](double v, double) { speed_mps = v; }, {}});
  ASSERT_THAT(node, test::IsOk());
  pollfd input{STDIN_FILENO, POLLIN, 0};
  for (int step = 0; poll(&input, 1, 20) == 0; ++step) {
    (*node)->publish(process_scan());
    (*node)->publish(Odometry{step, "", Pose2(), speed_mps, 0});
    if (step % 10 == 0) (*node)->publish(process_sweep());
  }
}

/// Starts the test above in a process of its own; ends with its owner.
class RobotProcess {
 public:
  RobotProcess() {
    setenv("SMOKEMAP_TEST_DOMAIN", std::to_string(test::ros_domain()).c_str(), 1);
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1, 0);
    std::string words[]{"robot", "--gtest_also_run_disabled_tests", "--gtest_filter=RobotProcess.DISABLED_IsTheRobot"};
    char* arguments[]{words[0].data(), words[1].data(), words[2].data(), nullptr};
    EXPECT_EQ(posix_spawn(&pid_, "/proc/self/exe", &actions, nullptr, arguments, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    input_ = ends[1];
  }
  ~RobotProcess() { end(); }
  void end() {
    if (pid_ <= 0) return;
    close(input_);
    waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }
  void crash() {
    kill(pid_, SIGKILL);
    end();
  }

 private:
  pid_t pid_ = 0;
  int input_ = -1;
};

/// Our side, with a clock of the test's own for the age of the link.
struct Ground {
  Ground() {
    GatewayParams params;
    params.domain = test::ros_domain();
    auto opened = RobotGateway::open(params,
                                     {[this](const LaserScan& s) { scans.put(s); },
                                      [this](const Odometry& o) { odometry.put(o); },
                                      [this](const RadarSweep& s) { sweeps.put(s); },
                                      {}},
                                     clock);
    EXPECT_THAT(opened, test::IsOk());
    gateway = std::move(*opened);
  }
  RobotLink link() const {
    const auto robots = gateway->robots();
    return robots.empty() ? RobotLink{} : robots[0];
  }
  std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
  test::Mailbox<LaserScan> scans;
  test::Mailbox<Odometry> odometry;
  test::Mailbox<RadarSweep> sweeps;
  std::unique_ptr<RobotGateway> gateway;
};

TEST(RobotInItsOwnProcess, IsFoundHeardAndDriven) {
  Ground ground;
  RobotProcess robot;
  ASSERT_TRUE(ground.scans.wait_for(3));
  for (const LaserScan& scan : ground.scans.all()) EXPECT_EQ(scan.ranges_m, process_scan().ranges_m);
  ASSERT_TRUE(ground.sweeps.wait_for(2));
  EXPECT_EQ(ground.sweeps.all()[1].power, process_sweep().power) << "800 kB in one piece";
  ASSERT_TRUE(test::eventually([&] { return ground.gateway->drive("robot", 0.375, 0).ok(); }));
  EXPECT_TRUE(test::eventually([&] {
    (void)ground.gateway->drive("robot", 0.375, 0);
    const auto odometry = ground.odometry.all();
    return !odometry.empty() && odometry.back().speed_mps == 0.375;
  }));
}

TEST(RobotInItsOwnProcess, AgesWhenItCrashesAndIsHeardAgainWhenItIsBack) {
  Ground ground;
  {
    RobotProcess robot;
    ASSERT_TRUE(ground.scans.wait_for(1));
    ASSERT_TRUE(
        test::eventually([&] { return ground.link().scans > 0 && ground.link().link == LinkFreshness::kFresh; }));
    robot.crash();
  }
  ASSERT_TRUE(test::eventually([&] {  // what was on its way may still arrive
    ground.clock->advance(from_seconds(0.01));
    return ground.link().link == LinkFreshness::kStale;
  }));
  ground.clock->advance(from_seconds(5));
  EXPECT_EQ(ground.link().link, LinkFreshness::kLost);
  const std::size_t before = ground.scans.size();
  RobotProcess again;
  EXPECT_TRUE(ground.scans.wait_for(before + 3)) << "a restarted robot takes the place of the one that fell silent";
  EXPECT_TRUE(test::eventually([&] { return ground.link().link == LinkFreshness::kFresh; }));
}

}  // namespace
}  // namespace smokemap
