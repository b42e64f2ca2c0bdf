#include "simulation/recorded_run.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A scan from the origin with beams straight ahead only: `ranges` one after another within a hundredth of a radian.
LaserScan narrow_scan(const std::vector<float>& ranges) {
  LaserScan scan;
  scan.angle_min_rad = -0.005;
  scan.angle_increment_rad = 0.01 / static_cast<double>(ranges.size());
  scan.range_max_m = 20;
  scan.ranges_m = ranges;
  return scan;
}

TEST(WallWitness, CountsEchoesOnTheirPieceOfTheWall) {
  WallWitness witness({Segment2{{3, -1.5}, {3, 1.5}}});
  witness.add(narrow_scan(std::vector<float>(10, 2.93F)), {}, {});
  EXPECT_EQ(witness.echoes_near(0, {3, 0}, 0.2), 10);
  EXPECT_EQ(witness.echoes_near(0, {3, 1.4}, 0.2), 0);
  EXPECT_NEAR(witness.seen(0, 1), 0.05 * 2, 0.051) << "one or two of twenty pieces";
  EXPECT_EQ(witness.crossed(0, 1), 0);
  EXPECT_EQ(witness.seen(0, 11), 0);
}

TEST(WallWitness, CountsBeamsThatWentThrough) {
  WallWitness witness({Segment2{{3, -1.5}, {3, 1.5}}, Segment2{{6.1, -1}, {6.1, 1}}});
  witness.add(narrow_scan(std::vector<float>(10, 6.0F)), {}, {});
  EXPECT_GT(witness.crossed(0, 4), 0);
  EXPECT_EQ(witness.seen(0, 1), 0);
  EXPECT_GT(witness.seen(1, 4), 0);
  EXPECT_EQ(witness.crossed(1, 1), 0) << "an echo on a wall is no beam through it";
}

TEST(WallWitness, JoinsSeenPiecesIntoParts) {
  WallWitness witness({Segment2{{2, -3}, {2, 3}}});
  for (const double heading : {-0.6, -0.55, -0.5, 0.4}) {
    const float range = static_cast<float>(2 / std::cos(heading));
    witness.add(narrow_scan({range, range, range}), Pose2(0, 0, heading), Pose2(0, 0, heading));
  }
  const auto parts = witness.seen_parts(0, 1);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(parts[0].a.y(), 2 * std::tan(-0.6), 0.16);
  EXPECT_NEAR(parts[0].b.y(), 2 * std::tan(-0.5), 0.16);
  EXPECT_NEAR(parts[1].midpoint().y(), 2 * std::tan(0.4), 0.16);
}

class RecordedRunOfTheDemo : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = make_demo(1);
    ASSERT_THAT(made, test::IsOk());
    demo = new DemoScenario(std::move(*made));
    RunParams params;
    params.max_duration_s = 60;
    params.with_radar = false;
    auto recorded = record_run(*demo, params);
    ASSERT_THAT(recorded, test::IsOk());
    run = new RecordedRun(std::move(*recorded));
  }
  static void TearDownTestSuite() {
    delete demo;
    delete run;
    demo = nullptr;
    run = nullptr;
  }
  static DemoScenario* demo;
  static RecordedRun* run;
};
DemoScenario* RecordedRunOfTheDemo::demo = nullptr;
RecordedRun* RecordedRunOfTheDemo::run = nullptr;

TEST_F(RecordedRunOfTheDemo, HasATruePoseForEveryScan) {
  std::size_t scans = 0;
  for (const auto& item : run->items)
    if (const auto* scan = std::get_if<LaserScan>(&item)) {
      ASSERT_LT(scans, run->truth.size());
      EXPECT_EQ(run->truth[scans++].stamp, scan->stamp);
    }
  EXPECT_EQ(scans, run->truth.size());
  EXPECT_EQ(run->T_odom_scan.size(), scans);
  EXPECT_EQ(scans, 600u);
  EXPECT_THAT(run->truth.front().T_map_robot, test::IsNear(Pose2(), 1e-12, 1e-12));
  EXPECT_GT(run->way_m, 5);
  EXPECT_EQ(run->bumps, 0);
}

TEST_F(RecordedRunOfTheDemo, SawTheCorridorButNotTheFarWing) {
  const auto& layout = demo->truth.layout;
  double best = 0;
  int untouched = 0;
  for (std::size_t i = 0; i < layout.walls.size(); ++i) {
    const double seen = run->witness.seen(static_cast<int>(i), 8);
    best = std::max(best, seen);
    untouched += run->witness.seen(static_cast<int>(i), 1) == 0;
    EXPECT_GE(run->witness.seen(static_cast<int>(i), 1), seen);
  }
  EXPECT_GT(best, 0.9);
  EXPECT_GT(untouched, 5);
  EXPECT_TRUE(run->visited[0]) << "corridor A, where it starts";
}

TEST_F(RecordedRunOfTheDemo, KnowsThePiecesOfWallsThatThePlanLacks) {
  double length = 0, truth = 0;
  for (const Segment2& piece : run->unplanned) length += piece.length();
  for (const int wall : demo->plan.missing) truth += demo->building.wall_line(wall).length();
  EXPECT_GT(length, 1.0);
  EXPECT_LE(length, truth + 1e-9);
}

TEST(RecordedRun, RefusesPlacesItCannotReach) {
  const auto demo = make_demo(2);
  ASSERT_THAT(demo, test::IsOk());
  RunParams params;
  params.waypoints = {{-50, -50}};
  EXPECT_THAT(record_run(*demo, params), test::Fails(Errc::kDegenerate));
  params.max_duration_s = -1;
  EXPECT_THAT(record_run(*demo, params), test::Fails(Errc::kInvalidArgument));
}

}  // namespace
}  // namespace smokemap
