#include "session/engine.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

class Nobody final : public RobotCommands {
 public:
  void drive(const std::string&, double, double) override {}
};

/// Waits for a snapshot that satisfies a condition; deadlines instead of sleeps.
class Watcher {
 public:
  explicit Watcher(Engine& engine) {
    engine.on_snapshot([this](std::shared_ptr<const Snapshot> snapshot) {
      const std::lock_guard lock(mutex_);
      latest_ = std::move(snapshot);
      changed_.notify_all();
    });
  }
  template <typename Condition>
  bool sees(const Condition& condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(30), [&] { return latest_ && condition(*latest_); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Snapshot> latest_;
};

LayoutMap two_corner_plan() {
  LayoutMap layout;
  layout.width_px = layout.height_px = 300;
  for (const Point2& p : {Point2(20, 20), Point2(280, 20), Point2(280, 280), Point2(20, 280)})
    layout.corners.push_back({p, 2, 1});
  for (int i = 0; i < 4; ++i) layout.walls.push_back({i, (i + 1) % 4, 4, 1, false});
  layout.scale = LayoutScale{0.05, 0.02, true};
  return layout;
}

Stroke line(const std::string& id, Point2 a, Point2 b) {
  Stroke stroke;
  stroke.id = id;
  stroke.points_px = {a, b};
  return stroke;
}

TEST(Engine, ShowsThePlanBeforeAnyRobotMoved) {
  Engine engine({}, std::make_shared<SystemClock>(), std::make_shared<Nobody>());
  Watcher watcher(engine);
  ASSERT_THAT(engine.apply(SetLayout{"plan", two_corner_plan()}), test::IsOk());
  EXPECT_TRUE(watcher.sees([](const Snapshot& s) { return s.merged->walls.size() == 4; }));
}

TEST(Engine, ADrawnRoomBecomesARegion) {
  Engine engine({}, std::make_shared<SystemClock>(), std::make_shared<Nobody>());
  Watcher watcher(engine);
  const Point2 a(200, 200), b(700, 200), c(700, 600), d(200, 600);
  int i = 0;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, d), std::pair(d, a)})
    ASSERT_THAT(engine.apply(AddStroke{line("s" + std::to_string(i++), from, to)}), test::IsOk());
  EXPECT_TRUE(watcher.sees([](const Snapshot& s) { return s.sketch->regions.size() == 1; }));
}

TEST(Engine, HostileSensorDataStopNothing) {
  Engine engine({}, std::make_shared<SystemClock>(), std::make_shared<Nobody>());
  Watcher watcher(engine);
  LaserScan empty;
  empty.robot = "robot1";
  engine.add_scan(empty);
  RadarSweep sweep;
  sweep.robot = "robot1";
  engine.add_sweep(sweep);
  Odometry odometry;
  odometry.robot = "robot1";
  odometry.T_odom_robot = Pose2(std::nan(""), 0, 0);
  engine.add_odometry(odometry);
  EXPECT_TRUE(watcher.sees([](const Snapshot& s) { return s.robots.size() == 1; }))
      << "it is there, and known not to know where";
  EXPECT_FALSE(engine.snapshot()->robots.front().localized);
}

TEST(Engine, SnapshotsShareWhatDidNotChange) {
  Engine engine({}, std::make_shared<SystemClock>(), std::make_shared<Nobody>());
  Watcher watcher(engine);
  ASSERT_THAT(engine.apply(SetLayout{"plan", two_corner_plan()}), test::IsOk());
  ASSERT_TRUE(watcher.sees([](const Snapshot& s) { return s.merged->walls.size() == 4; }));
  const auto first = engine.snapshot();
  ASSERT_TRUE(watcher.sees([&](const Snapshot& s) { return s.revision > first->revision + 1; }));
  EXPECT_EQ(engine.snapshot()->layout, first->layout);
  EXPECT_EQ(engine.snapshot()->merged, first->merged);
}

TEST(EngineParams, NameTheirFirstFieldOutOfRange) {
  EngineParams params;
  params.tick_s = 0;
  EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(EngineParams{}.validate(), test::IsOk());
}

}  // namespace
}  // namespace smokemap
