#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/time.hpp"
#include "navigation/follower.hpp"
#include "navigation/planner.hpp"

namespace smokemap {

enum class PilotState {
  kIdle,  ///< no target
  kDriving,
  kArrived,
  kBlocked,  ///< something stands in the way; trying again
  kGivenUp,  ///< no way for longer than patience_s; see `reason`
};

struct PilotParams {
  FollowerParams follower;
  PlannerParams planner;
  double arrival_m = 0.30;
  double arrival_rad = 0.2;  ///< only where a heading was asked for
  double replan_period_s = 1.0;
  double patience_s = 12.0;        ///< without a way
  double stuck_patience_s = 30.0;  ///< on a way, or before what stands in it, without progress
  double watch_patience_s = 60;    ///< the same where the robot's own navigator drives: it frees itself in its own time
  double back_up_after_s = 3.0;    ///< of being blocked
  double back_up_speed_mps = 0.15;
  double met_valid_s = 40.0;      ///< what stood in the way and is not on the map is kept clear of for so long
  double smoke_speed_mps = 0.25;  ///< at most, where the lidar sees nothing and the radar alone looks out
  double clear_share = 0.35;      ///< of beams lost in smoke: with fewer the robot drives as ever ...
  double blind_share = 0.75;      ///< ... and from here on no faster than that
  int most_ways = 6;              ///< tried to one target before longer ways round no longer count as progress
  Result<Ok> validate() const;
};

struct PilotOutput {
  Twist twist;
  PilotState state = PilotState::kIdle;
  std::string reason;  ///< for people
  Path path;
  double remaining_m = 0;
};

/// Drives one robot to a target over a map that keeps changing: plans, follows, steers clear of what the robot's own
/// sensors see or stops for it, backs off, plans again around what it met, and gives up with a reason. Slow in smoke.
/// No threads, no clock of its own.
class Pilot {
 public:
  explicit Pilot(const PilotParams& params) : params_(params) {}

  void set_map(std::shared_ptr<const CostMap> map) { map_ = std::move(map); }
  /// A new target starts afresh; nothing stops the robot.
  void set_target(const std::optional<Point2>& p_map, std::optional<double> heading_rad = std::nullopt);
  /// The same target, moved because the map under it moved.
  void move_target(const Point2& p_map);
  const std::optional<Point2>& target() const { return target_; }

  /// @param obstacles_robot what stands near, robot frame (ObstacleWatch)
  /// @param smoke_share of the lidar's beams that smoke swallows
  PilotOutput step(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot,
                   double smoke_share = 0);
  /// The same while somebody else drives: path, progress and arrival, no velocities.
  PilotOutput watch(Stamp now, const Pose2& T_map_robot);
  void give_up(const std::string& reason) { given_up_ = true, reason_ = reason; }
  const std::optional<double>& heading_rad() const { return heading_rad_; }

 private:
  /// @param obstacles_robot null: somebody else drives
  PilotOutput advance(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>* obstacles_robot,
                      double smoke_share);
  bool at_target(const Pose2& T_map_robot) const;
  void plan_if_due(Stamp now, const Point2& p);
  Result<Path> plan(Stamp now, const Point2& p);
  void note_progress(Stamp now, double remaining_m);
  /// What stands ahead is not on the map, or not where the map has it.
  void remember_obstacles(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot);
  Twist drive(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot, double smoke_share);
  Twist get_past(Stamp now, const Pose2& T_map_robot, const Twist& wanted, const std::vector<Point2>& obstacles_robot);
  PilotOutput turn_to_heading(const Pose2& T_map_robot) const;

  PilotParams params_;
  std::shared_ptr<const CostMap> map_;
  std::optional<Point2> target_;
  std::optional<double> heading_rad_;
  std::optional<Path> path_;
  std::string reason_;
  std::optional<Stamp> planned_at_;
  struct HeldUp {
    Stamp since;
    Point2 p_map;
  };
  std::optional<HeldUp> held_up_;  ///< something kept it from driving as planned
  bool standing_ = false;          ///< before something, now
  std::vector<Point2> met_map_;    ///< what stood in the way
  Stamp met_at_ = 0;
  std::optional<Stamp> progressed_at_;
  double least_remaining_m_ = 0, last_remaining_m_ = 0, begun_remaining_m_ = 0;
  int ways_ = 0;  ///< longer ones taken instead
  bool given_up_ = false;
};

}  // namespace smokemap
