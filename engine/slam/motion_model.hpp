#pragma once

#include <complex>
#include <deque>
#include <optional>

#include "maps/odometry.hpp"
#include "slam/slam_params.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// Odometry readings kept in order of arrival, asked for the pose at a scan's stamp. Stamps may step back: an exact
/// stamp wins, else the newest pair around it, else the newest reading, moved on by its own speed for at most 0.5 s.
/// A constant delay between the clocks of wheels and scanner is not looked for: in intel.log and in fr079.log scans lag
/// the wheels by about 0.1 s, and logs with that taken out gave the same error within 0.1 mm and 0.004 degrees. A match
/// hardly leans on where it starts.
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

/// By how much the wheels turn, run and drift too far, learnt over the last half second from matched steps. A scan is
/// straightened by the motion during its own turn, which only the wheels tell; wheels that slip would bend it, and its
/// pose would be off by half the bend. Wheels that are right stay as they are: what it adds is less than a match's
/// noise.
class WheelError {
 public:
  /// A step as the wheels had it and as the match found it; `seconds` long, or a little longer.
  void learn(const Pose2& by_wheels, const Pose2& matched, double seconds);
  /// Between what the wheels say and how the robot last moved: a scan is never bent more than by the wheels alone.
  /// @param last  matched motion, smoothed
  Twist2 corrected(const Twist2& by_wheels, const Twist2& last) const;

 private:
  // Least squares of matched = ratio * by_wheels; of the way the ratio is complex: it turns and scales.
  std::complex<double> way_product_;
  double way_square_ = 0, turn_product_ = 0, turn_square_ = 0;
};

/// The velocity to go on with after a step at `measured` that took `seconds`: a share of the new one. A velocity taken
/// from one step straightens the next scan wrongly by its error, whose match then errs the other way: without the share
/// that swings for ever at ten scans a second.
Twist2 smoothed(const std::optional<Twist2>& before, const Twist2& measured, double seconds);

}  // namespace smokemap
