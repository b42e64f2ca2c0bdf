#pragma once

#include <map>
#include <memory>
#include <string>

#include "session/merger.hpp"
#include "session/session_core.hpp"

namespace smokemap::test {

inline LayoutMap square_plan(double side_px = 200) {
  LayoutMap layout;
  layout.width_px = layout.height_px = static_cast<int>(side_px) + 40;
  const double a = 20, b = 20 + side_px;
  for (const Point2& p : {Point2(a, a), Point2(b, a), Point2(b, b), Point2(a, b)}) layout.corners.push_back({p, 2, 1});
  for (int i = 0; i < 4; ++i) layout.walls.push_back({i, (i + 1) % 4, 4, 1, false});
  layout.scale = LayoutScale{0.05, 0.02, true};
  return layout;
}

inline PlacePoi poi_at(const std::string& id, PlaceFrame frame, Point2 p) {
  PlacePoi place;
  place.poi.id = id;
  place.poi.kind = PoiKind::kGasBottle;
  place.poi.place = {frame, p, 0};
  return place;
}

inline SetGoal goal_at(const std::string& id, Point2 p) {
  SetGoal set;
  set.goal.id = id;
  set.goal.robot = "robot1";
  set.goal.place = {PlaceFrame::kMap, p, 0};
  return set;
}

inline Stroke stroke(const std::string& id) {
  Stroke s;
  s.id = id;
  s.points_px = {{1, 1}, {50, 1}};
  return s;
}

/// Remembers the last command of every robot.
class Recorder final : public RobotCommands {
 public:
  void drive(const std::string& robot, double speed_mps, double turn_rate_radps) override {
    last[robot] = {speed_mps, turn_rate_radps};
    ++calls;
  }
  void stop(const std::string& robot) override {
    drive(robot, 0, 0);
    ++stops[robot];
  }
  bool navigates(const std::string& robot) const override { return errands.contains(robot); }
  void lead(const std::string& robot, const Pose2& T_robot_place) override {
    places[robot].push_back(T_robot_place);
    errands[robot] = Errand::kUnderWay;
  }
  Errand errand(const std::string& robot) const override { return errands.at(robot); }

  std::map<std::string, Twist> last;
  std::map<std::string, int> stops;
  std::map<std::string, Errand> errands;  ///< of the robots that navigate by themselves
  std::map<std::string, std::vector<Pose2>> places;
  int calls = 0;
};

/// A robot in the middle of a free square of 10 m.
inline MergeResult free_square() {
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

inline PoseReport standing_at(const Pose2& pose, const std::string& robot = "robot1") {
  PoseReport report;
  report.robot = robot;
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

}  // namespace smokemap::test
