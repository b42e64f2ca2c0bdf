#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "navigation/planner.hpp"

namespace smokemap {

/// A velocity command in the robot's frame.
struct Twist {
  double speed_mps = 0;
  double turn_rate_radps = 0;
};

struct FollowerParams {
  double max_speed_mps = 0.5;
  double max_turn_rate_radps = 1.0;
  double lookahead_m = 0.5;
  double turn_in_place_rad = 0.9;  ///< heading errors above are turned off on the spot
  double robot_radius_m = 0.25;
  double margin_m = 0.04;    ///< kept from obstacles beyond the radius
  double stop_time_s = 0.7;  ///< so far ahead the way is to be clear
  int stop_points = 3;       ///< so many echoes are an obstacle, fewer are noise
  Result<Ok> validate() const;
};

/// Where along the path the robot is.
struct PathProgress {
  std::size_t piece = 0;   ///< points[piece] -> points[piece + 1]
  double remaining_m = 0;  ///< to the end
  double off_path_m = 0;
};
PathProgress progress_on(const Path& path, const Point2& p);
/// The place `ahead_m` further along the path than the foot of `p`, facing along it; its end where it is shorter.
Pose2 pose_ahead(const Path& path, const Point2& p, double ahead_m);

/// Pure pursuit: drives towards a point a little ahead on the path, slows for turns and at the end.
Twist follow(const Path& path, const Pose2& T_map_robot, const FollowerParams& params);

/// Does the robot, driving on like this for stop_time_s, keep its radius and `margin_m` away from all obstacles? From
/// one that is nearer already it may move away. Fewer than stop_points obstacles are noise. Backwards too. Points in
/// the robot's frame, x forward.
bool is_clear(const Twist& twist, const std::vector<Point2>& obstacles_robot, const FollowerParams& params);

/// What is wanted, or what is nearest to it among turns a little to the left or right and slower that keeps clear of
/// the obstacles; nothing if only standing does. Turning on the spot is always clear: the robot is a disc.
std::optional<Twist> steer_clear(const Twist& wanted, const std::vector<Point2>& obstacles_robot,
                                 const FollowerParams& params);

}  // namespace smokemap
