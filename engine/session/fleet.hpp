#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "navigation/frontier.hpp"
#include "navigation/leader.hpp"
#include "navigation/pilot.hpp"
#include "session/carrier.hpp"
#include "session/snapshot.hpp"
#include "session/whiteboard.hpp"

namespace smokemap {

/// The way back to robots: implemented over DDS, by the simulator and by test doubles. Must not block.
/// The robot's side stops by itself when nothing comes for 0.5 s.
class RobotCommands {
 public:
  virtual ~RobotCommands() = default;
  virtual void drive(const std::string& robot, double speed_mps, double turn_rate_radps) = 0;
  /// Emergency: stands at once, and whatever the robot does of its own accord is called off.
  virtual void stop(const std::string& robot) { drive(robot, 0, 0); }
  /// Whether the robot has a navigator of its own: it is then led from place to place and given no velocities, which
  /// would fight the navigator's.
  virtual bool navigates(const std::string& /*robot*/) const { return false; }
  /// To a place as seen from where the robot is now.
  virtual void lead(const std::string& /*robot*/, const Pose2& /*T_robot_place*/) {}
  /// What became of the place that it was led to last.
  virtual Errand errand(const std::string& /*robot*/) const { return Errand::kNone; }
};

struct FleetParams {
  PilotParams pilot;
  FrontierParams frontier;
  LeaderParams leader;
  double stale_after_s = 1.0;
  double lost_after_s = 5.0;
  double look_again_s = 2.0;     ///< between two searches for a way that was not known
  double look_patience_s = 60;   ///< looking for a way without coming anywhere new
  double look_limit_s = 180;     ///< looking for a way to one goal in all
  double doubt_patience_s = 20;  ///< at a place of a plan that does not fit: it may yet be laid right
  double smoky_share = 0.5;      ///< a robot that gives up in such smoke goes back ...
  double clear_share = 0.25;     ///< ... to where it last had this view
  double explore_pause_s = 1.0;  ///< after a place was reached, before the next is chosen
  double robot_radius_m = 0.35;  ///< of another robot, which the map does not show
  Result<Ok> validate() const;
};

/// A robot's own account of itself, from SLAM.
struct PoseReport {
  std::string robot;
  Pose2 T_graph_robot;  ///< in the frame of the floor's pose graph; a robot that did not join it: in its own
  double sigma_m = 0;
  double sigma_rad = 0;
  bool localized = false;
  double speed_mps = 0;
  std::vector<Point2> obstacles_robot;  ///< what stands near, smoke left out (ObstacleWatch)
  double smoke_share = 0;               ///< of the lidar's beams that smoke swallows
};

/// Values only: planning takes a while, and happens without any lock.
struct WayQuestion {
  std::shared_ptr<const CostMap> map;
  Point2 from_map, to_map;
  PlannerParams planner;
};

/// Robots, their goals and their exploring. No threads, no clock of its own.
class Fleet {
 public:
  Fleet(const FleetParams& params, std::shared_ptr<RobotCommands> commands)
      : params_(params), commands_(std::move(commands)) {}

  void heard(const std::string& robot, Stamp now);
  void report(const PoseReport& report);
  void set_map(std::shared_ptr<const CostMap> map) { map_ = std::move(map); }
  /// What the merge says about the newest poses of a robot in the graph.
  void set_correction(const std::string& id, const Pose2& T_map_graph);

  /// Ten times a second: chooses what each robot does, drives it, moves goals through their states.
  void tick(Stamp now, Whiteboard& board, const Carrier& carrier);
  /// At once, before anything else; an empty id stops all.
  void stop_now(const std::string& id);

  std::vector<RobotStatus> status() const;
  /// Distance and time to go of the goal that a robot drives to; zeros for others.
  GoalView view(const Goal& goal, const Carrier& carrier) const;
  /// What is asked of the planner for a way from where a robot is now. kNotFound for one never localised, kDegenerate
  /// before there is a map.
  Result<WayQuestion> way_question(const std::string& id, const Point2& p_map) const;
  /// Where SLAM has the robot now; nothing for a robot never localised.
  std::optional<Pose2> T_graph_robot(const std::string& id) const;

 private:
  struct Robot {
    Robot(const std::string& id, const FleetParams& params) : pilot(params.pilot), leader(params.leader) {
      status.id = id;
    }
    RobotStatus status;
    Pilot pilot;
    Leader leader;  ///< of a robot that navigates by itself
    Pose2 T_graph_robot;
    Pose2 T_map_graph;
    std::vector<Point2> obstacles_robot;
    double smoke_share = 0;
    std::optional<Point2> p_graph_clear;  ///< where it last saw well
    std::optional<Point2> p_map_retreat;  ///< where it goes, having given up in smoke
    PilotOutput last;
    std::vector<Point2> avoided;  ///< frontiers that could not be reached, or were
    PilotState last_detour = PilotState::kIdle;
    bool detour = false;             ///< no way to the goal is known: the pilot looks for one
    std::optional<Stamp> looked_at;  ///< when a way to the goal was last asked for
    double looking_s = 0;            ///< for a way, without coming anywhere new
    double looked_s = 0;             ///< for a way to this goal in all
    double doubted_s = 0;            ///< stood where a plan that does not fit has the goal
    Stamp steered_at = 0;
    Stamp idle_since = 0;
    bool ever_localized = false;
  };

  void steer(Robot& robot, Stamp now, Whiteboard& board, const Carrier& carrier);
  void drive(Robot& robot, Stamp now);
  /// The same for a robot that navigates by itself.
  void lead(Robot& robot, Stamp now);
  /// The goal to drive to now; refuses, with the reason, those that have no place.
  Goal* next_goal(Robot& robot, Whiteboard& board, const Carrier& carrier);
  /// Frontiers that this robot gave up or saw, and those that others drive to.
  std::vector<Point2> avoided_by(const Robot& robot) const;
  /// What its sensors see, and the other robots: two lidars at one height do not see each other's masts.
  std::vector<Point2> obstacles_of(const Robot& robot) const;
  void take_target(Robot& robot, Stamp now, Goal* goal, const Carrier& carrier, bool explores);
  void take_goal(Robot& robot, Goal& goal, const Point2& p_map);
  /// A plan that is wrong in a part nobody saw may show no way where there is one: drive to where more can be seen,
  /// nearest to the goal, until a way is known or nothing is left to look at. False: nothing is left.
  bool look_for_way(Robot& robot, Stamp now, const Goal& goal, const Point2& p_map);
  void settle_goal(Robot& robot, Stamp now, Goal* goal, const Carrier& carrier);
  /// The robot is where the goal seems to be. Nothing is claimed of a plan that does not fit; any other doubt stays
  /// said.
  void arrive(Robot& robot, Goal& goal, const Carrier& carrier, double passed_s);
  /// The goal cannot be reached; in smoke the robot goes back to where it can see.
  void give_up(Robot& robot, Goal& goal, const std::string& reason);
  void go_back(Robot& robot, Stamp now);
  Robot& robot_of(const std::string& id);

  FleetParams params_;
  std::shared_ptr<RobotCommands> commands_;
  std::shared_ptr<const CostMap> map_;
  std::map<std::string, Robot> robots_;
};

}  // namespace smokemap
