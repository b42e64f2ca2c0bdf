#pragma once

#include <deque>
#include <optional>

#include "maps/odometry.hpp"
#include "slam/slam_params.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// Odometry readings kept in order of arrival, asked for the pose at a scan's stamp. Stamps may step back: an exact
/// stamp wins, else the newest pair around it, else the newest reading, moved on by its own speed for at most 0.5 s.
class OdometryBuffer {
 public:
  void add(const Odometry& reading);
  std::optional<Pose2> at(Stamp stamp) const;
  /// Motion between the last two readings with different stamps.
  std::optional<Twist2> twist() const;
  bool empty() const { return readings_.empty(); }

 private:
  static constexpr std::size_t kMost = 400;
  std::deque<Odometry> readings_;
};

/// A predicted step and how much to trust it.
struct PredictedStep {
  Pose2 T_before_now;
  double sigma_m = 0;
  double sigma_rad = 0;
  bool by_odometry = false;
  bool jumped = false;  ///< odometry moved faster than a robot can: the step is not to be believed
};

/// The step since the scan before, from odometry; without it by the velocity of the last matched step.
PredictedStep predict_step(const std::optional<Pose2>& T_odom_before, const std::optional<Pose2>& T_odom_now,
                           double seconds, const std::optional<Twist2>& last_twist, const FrontEndParams& params);

/// The constant motion that makes a step in the given time; zero for no time.
Twist2 twist_of(const Pose2& T_before_now, double seconds);

/// The velocity to go on with after a step at `measured` that took `seconds`: a share of the new one. A velocity taken
/// from one step straightens the next scan wrongly by its error, whose match then errs the other way: without the share
/// that swings for ever at ten scans a second.
Twist2 smoothed(const std::optional<Twist2>& before, const Twist2& measured, double seconds);

}  // namespace smokemap
