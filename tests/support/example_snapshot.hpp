#pragma once

#include <memory>

#include "session/snapshot.hpp"

namespace smokemap::test {

/// One of everything, so that every part of the wire has an object.
inline Snapshot example_snapshot() {
  Snapshot s;
  s.revision = 7;
  auto layout = std::make_shared<LayoutView>();
  layout->plan_id = std::string(64, 'a');
  layout->layout.width_px = 800;
  layout->layout.height_px = 600;
  layout->layout.corners = {{Point2(100, 500), 1, 1}, {Point2(700, 500), 2, 1}, {Point2(700, 100), 1, 1}};
  layout->layout.walls = {{0, 1, 8, 0.9, false}, {1, 2, 8, 0.8, true}};
  layout->layout.scale = LayoutScale{0.025, 0.02, true};
  auto merged = std::make_shared<MergedMap>();
  merged->revision = 3;
  merged->walls = {{0, {Point2(0, 0), Point2(6, 0)}, WallState::kConfirmed, 0.95, 5, 0.1},
                   {1, {Point2(6, 0), Point2(6, 4)}, WallState::kMissing, 0.9, 3, 0},
                   {std::nullopt, {Point2(2, 0), Point2(2, 4)}, WallState::kNew, 0.7, 3, 0}};
  merged->corners = {{Point2(100, 500), Point2(0, 0), 0.1, true}};
  merged->links = {{Point2(0.05, 0), 0, LinkState::kDoubtful}};
  merged->fit = {0.8, "fits"};
  auto sketch = std::make_shared<SketchView>();
  sketch->sketch.strokes = {{"s1", "Bo", StrokeKind::kWall, 3, {Point2(10, 10), Point2(50, 10)}}};
  sketch->regions = {{1, {Point2(0, 0), Point2(9, 0), Point2(9, 9)}, RegionKind::kRoom},
                     {2, {Point2(9, 9)}, RegionKind::kCorridor}};
  sketch->gaps = {{{Point2(1, 1), Point2(2, 2)}, true}};
  auto match = std::make_shared<MatchView>();
  match->matching.pairs = {{1, 5, 0.8, Verdict::kProposed}};
  match->matching.next_pin_label_a = 2;
  match->map_regions = {{5, {Point2(0, 0), Point2(4, 0), Point2(4, 4)}, RegionKind::kRoom}};
  GridFrame frame{0.05, Eigen::Vector2d(-1, -1), 40, 40};
  auto sensed = std::make_shared<OccupancyGrid>(frame);
  for (int x = 0; x < 40; ++x) sensed->at({x, 20}) = 5;
  sensed->at({30, 20}) = 100;
  RobotStatus robot;
  robot.id = "robot1";
  robot.T_map_robot = Pose2(1, 2, 0.5);
  robot.path_map = {Point2(1, 2), Point2(3, 2)};
  s.robots = {robot};
  PointOfInterest poi{
      "p1", PoiKind::kGasBottle, {PlaceFrame::kLayoutPx, Point2(200, 300), 1}, "acetylene", "Anna", 5'000'000, false};
  PointOfInterest lost{"p2", PoiKind::kVictim, {PlaceFrame::kSketchPx, Point2(20, 30), 1}, "", "Bo", 6'000'000, false};
  s.pois = {{poi, {Point2(1, 1), 0.3, 0.9, ""}}, {lost, {std::nullopt, 0, 0, "no counterpart"}}};
  Goal goal;
  goal.id = "g1";
  goal.robot = "robot1";
  goal.place = {PlaceFrame::kMap, Point2(3, 2), 0};
  goal.state = GoalState::kDriving;
  s.goals = {{goal, {Point2(3, 2), 0.1, 1, ""}, 2.5, 6}};
  s.alerts = {{"a1", "robot1 is silent", true}};
  s.layout = std::move(layout);
  s.merged = std::move(merged);
  s.sketch = std::move(sketch);
  s.match = std::move(match);
  s.sensed = std::move(sensed);
  return s;
}

}  // namespace smokemap::test
