#include "session/mapper.hpp"

#include <gtest/gtest.h>

#include "session/merger.hpp"
#include "simulation/simulated_robot.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A hall of 12 x 8 m with a wall and two pillars: no two corners look alike.
SimulatedWorld hall() {
  std::vector<WorldSegment> walls;
  for (const Segment2& s : std::vector<Segment2>{{{-4, -4}, {8, -4}},
                                                 {{8, -4}, {8, 4}},
                                                 {{8, 4}, {-4, 4}},
                                                 {{-4, 4}, {-4, -4}},
                                                 {{3, -4}, {3, -1.2}},
                                                 {{-4, 1.8}, {-1.5, 1.8}},
                                                 {{5, 2}, {6.5, 2}},
                                                 {{6.5, 2}, {6.5, 4}}})
    walls.push_back({s});
  SimulatedWorld world;
  world.walls = SegmentWorld(walls);
  world.smoke.read_walls(world.walls);
  return world;
}

SimulatedRobot robot_at(const std::string& name, std::uint64_t index, const Pose2& T_world_start) {
  SimulatedRobotParams params;
  params.name = name;
  params.index = index;
  params.with_radar = false;
  return SimulatedRobot(params, T_world_start);
}

struct Heard {
  std::map<std::string, PoseReport> last;
};

/// Drives a robot on a circle and feeds what it says.
void drive(Mapper& mapper, SimulatedRobot& robot, const SimulatedWorld& world, double seconds, Heard& heard) {
  for (int i = 0; i < static_cast<int>(seconds * 100); ++i) {
    if (i % 10 == 0) robot.command(0.4, 0.3);
    const RobotOutput out = robot.step(world);
    for (const Odometry& odometry : out.odometry) (void)mapper.add(odometry);
    for (const LaserScan& scan : out.scans)
      if (const auto report = mapper.add(scan)) heard.last[report->robot] = *report;
  }
  (void)mapper.optimize();
}

std::shared_ptr<const FloorView> merged_view(Merger& merger, const Mapper& mapper) {
  MergeInput input;
  input.floor = mapper.graph();
  const MergeResult result = merger.run(input);
  FloorView view;
  view.merged = result.merged;
  view.generation = result.generation;
  return std::make_shared<const FloorView>(view);
}

TEST(Mapper, TheFirstRobotHeardMakesTheMapAndOthersAreNotLocalised) {
  const SimulatedWorld world = hall();
  Mapper mapper;
  SimulatedRobot one = robot_at("one", 1, Pose2()), two = robot_at("two", 2, Pose2(1, 0, 0));
  Heard heard;
  drive(mapper, one, world, 3, heard);
  drive(mapper, two, world, 3, heard);
  EXPECT_TRUE(heard.last.at("one").localized);
  EXPECT_FALSE(heard.last.at("two").localized);
  for (const PoseNode& node : mapper.graph().graph->nodes) EXPECT_EQ(node.robot, "one");
  EXPECT_GT(heard.last.at("one").sigma_m, 0.04) << "never more certain than the map is";
}

TEST(Mapper, WithoutAPlanASecondRobotIsFoundInWhatTheFirstOneSaw) {
  const SimulatedWorld world = hall();
  Mapper mapper;
  Merger merger;
  SimulatedRobot one = robot_at("one", 1, Pose2()), two = robot_at("two", 2, Pose2(0.5, -1.5, 1.2));
  Heard heard;
  drive(mapper, one, world, 25, heard);
  mapper.take(merged_view(merger, mapper));
  drive(mapper, two, world, 60, heard);
  ASSERT_TRUE(heard.last.at("two").localized);
  EXPECT_THAT(heard.last.at("two").T_graph_robot, test::IsNear(two.true_pose(), 0.4, 0.1));
  const auto& nodes = mapper.graph().graph->nodes;
  EXPECT_TRUE(std::any_of(nodes.begin(), nodes.end(), [](const PoseNode& n) { return n.robot == "two"; }));
}

TEST(Mapper, MalformedInputSaysNothingAndBreaksNothing) {
  Mapper mapper;
  LaserScan empty;
  empty.robot = "one";
  EXPECT_FALSE(mapper.add(empty));
  RadarSweep sweep;
  sweep.robot = "one";
  EXPECT_FALSE(mapper.add(sweep));
  EXPECT_FALSE(mapper.optimize());
  EXPECT_TRUE(mapper.graph().graph->nodes.empty());
  mapper.take(std::make_shared<const FloorView>());
}

TEST(WallsToLocalizeIn, LeaveOutWhatIsNotThere) {
  MergedMap merged;
  for (const WallState state : {WallState::kConfirmed, WallState::kMissing, WallState::kNew, WallState::kUnseen})
    merged.walls.emplace_back().state = state;
  EXPECT_EQ(walls_to_localize_in(merged).size(), 3u);
}

}  // namespace
}  // namespace smokemap
