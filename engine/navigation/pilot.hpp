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
  double patience_s = 12.0;      ///< without progress
  double watch_patience_s = 60;  ///< the same where the robot's own navigator drives: it frees itself in its own time
  double back_up_after_s = 3.0;  ///< of being blocked
  double back_up_speed_mps = 0.15;
  Result<Ok> validate() const;
};

struct PilotOutput {
  Twist twist;
  PilotState state = PilotState::kIdle;
  std::string reason;  ///< for people
  Path path;
  double remaining_m = 0;
};

/// Drives one robot to a target over a map that keeps changing: plans, follows, stops for what the robot's own sensor
/// sees, backs off, plans again, and gives up with a reason. No threads, no clock of its own.
class Pilot {
 public:
  explicit Pilot(const PilotParams& params) : params_(params) {}

  void set_map(std::shared_ptr<const CostMap> map) { map_ = std::move(map); }
  /// A new target starts afresh; nothing stops the robot.
  void set_target(std::optional<Point2> p_map, std::optional<double> heading_rad = std::nullopt);
  /// The same target, moved because the map under it moved.
  void move_target(const Point2& p_map);
  const std::optional<Point2>& target() const { return target_; }

  /// @param obstacles_robot echoes of the latest scan, robot frame
  PilotOutput step(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot);
  /// The same while somebody else drives: path, progress and arrival, no velocities.
  PilotOutput watch(Stamp now, const Pose2& T_map_robot);
  void give_up(const std::string& reason) { given_up_ = true, reason_ = reason; }
  const std::optional<double>& heading_rad() const { return heading_rad_; }

 private:
  /// @param obstacles_robot null: somebody else drives
  PilotOutput advance(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>* obstacles_robot);
  bool at_target(const Pose2& T_map_robot) const;
  void plan_if_due(Stamp now, const Point2& p);
  Twist drive(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot);
  PilotOutput turn_to_heading(const Pose2& T_map_robot) const;

  PilotParams params_;
  std::shared_ptr<const CostMap> map_;
  std::optional<Point2> target_;
  std::optional<double> heading_rad_;
  std::optional<Path> path_;
  std::string reason_;
  std::optional<Stamp> planned_at_;
  std::optional<Stamp> blocked_since_;
  Stamp progressed_at_ = 0;
  double least_remaining_m_ = 0;
  bool given_up_ = false;
};

}  // namespace smokemap
