#include "slam/motion_model.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {
constexpr double kLongestExtrapolation_s = 0.5;
constexpr double kTwistMemory_s = 0.4;
constexpr double kMostOfNewTwist = 0.7;
constexpr double kWheelMemory_s = 0.5;
constexpr double kWheelsMayBeOff = 0.2;  ///< share of way and turn by which wheels are off before anything is learnt
constexpr double kStep_m = 0.003, kStep_rad = 0.002;  ///< noise of a matched step
constexpr double kWayPrior_m2 = (kStep_m / kWheelsMayBeOff) * (kStep_m / kWheelsMayBeOff);
constexpr double kTurnPrior_rad2 = (kStep_rad / kWheelsMayBeOff) * (kStep_rad / kWheelsMayBeOff);

std::complex<double> as_complex(const Point2& p) { return {p.x(), p.y()}; }
}  // namespace

void OdometryBuffer::add(const Odometry& reading) {
  if (!reading.T_odom_robot.is_finite()) return;
  readings_.push_back(reading);
  if (readings_.size() > kMost) readings_.pop_front();
}

std::optional<Pose2> OdometryBuffer::at(Stamp stamp) const {
  if (readings_.empty()) return std::nullopt;
  for (auto r = readings_.rbegin(); r != readings_.rend(); ++r)
    if (r->stamp == stamp) return r->T_odom_robot;
  for (auto later = readings_.rbegin(); later + 1 != readings_.rend(); ++later) {
    const auto earlier = later + 1;
    if (earlier->stamp > stamp || later->stamp < stamp) continue;
    const double share =
        static_cast<double>(stamp - earlier->stamp) / static_cast<double>(later->stamp - earlier->stamp);
    return interpolate(earlier->T_odom_robot, later->T_odom_robot, share);
  }
  const double ahead = to_seconds(stamp - readings_.back().stamp);
  const std::optional<Twist2> moving = twist();
  if (!moving || ahead <= 0) return readings_.back().T_odom_robot;
  return readings_.back().T_odom_robot * moving->after(std::min(ahead, kLongestExtrapolation_s));
}

std::optional<Twist2> OdometryBuffer::twist() const {
  for (auto before = readings_.rbegin(); before != readings_.rend(); ++before) {
    const double seconds = to_seconds(readings_.back().stamp - before->stamp);
    if (seconds < 1e-3) continue;
    if (seconds > 1.0) break;
    return twist_of(before->T_odom_robot.inverse() * readings_.back().T_odom_robot, seconds);
  }
  return std::nullopt;
}

Twist2 twist_of(const Pose2& T_before_now, double seconds) {
  if (!(seconds > 1e-3)) return {};
  return {T_before_now.translation() / seconds, T_before_now.heading() / seconds};
}

void WheelError::learn(const Pose2& by_wheels, const Pose2& matched, double seconds) {
  const double kept = std::exp(-std::max(0.0, seconds) / kWheelMemory_s);
  const std::complex<double> wheels = as_complex(by_wheels.translation());
  way_product_ = kept * way_product_ + std::conj(wheels) * as_complex(matched.translation());
  way_square_ = kept * way_square_ + std::norm(wheels);
  turn_product_ = kept * turn_product_ + by_wheels.heading() * matched.heading();
  turn_square_ = kept * turn_square_ + by_wheels.heading() * by_wheels.heading();
}

Twist2 WheelError::corrected(const Twist2& by_wheels, const Twist2& last) const {
  const std::complex<double> velocity =
      as_complex(by_wheels.velocity_mps) * (way_product_ + kWayPrior_m2) / (way_square_ + kWayPrior_m2);
  const double turn = (turn_product_ + kTurnPrior_rad2) / (turn_square_ + kTurnPrior_rad2) * by_wheels.turn_radps;
  // Wheels whose slip changes at once are misjudged by a multiple.
  const auto between = [](double value, double a, double b) {
    return std::clamp(value, std::min(a, b), std::max(a, b));
  };
  return {{between(velocity.real(), by_wheels.velocity_mps.x(), last.velocity_mps.x()),
           between(velocity.imag(), by_wheels.velocity_mps.y(), last.velocity_mps.y())},
          between(turn, by_wheels.turn_radps, last.turn_radps)};
}

Twist2 smoothed(const std::optional<Twist2>& before, const Twist2& measured, double seconds) {
  if (!before) return measured;
  const double share = std::min(kMostOfNewTwist, 1 - std::exp(-seconds / kTwistMemory_s));
  return {before->velocity_mps + share * (measured.velocity_mps - before->velocity_mps),
          before->turn_radps + share * (measured.turn_radps - before->turn_radps)};
}

PredictedStep predict_step(const std::optional<Pose2>& T_odom_before, const std::optional<Pose2>& T_odom_now,
                           double seconds, const std::optional<Twist2>& last_twist, const FrontEndParams& params) {
  PredictedStep step;
  const double elapsed = std::max(0.0, seconds);
  if (T_odom_before && T_odom_now) {
    step.T_before_now = T_odom_before->inverse() * *T_odom_now;
    // Stamps are not to be trusted by fractions of a second: half a second of grace.
    step.jumped = step.T_before_now.translation().norm() > params.fastest_mps * (elapsed + 0.5) ||
                  std::abs(step.T_before_now.heading()) > params.fastest_radps * (elapsed + 0.5);
    step.by_odometry = !step.jumped;
  }
  if (step.by_odometry) {
    const double way = step.T_before_now.translation().norm(), turn = std::abs(step.T_before_now.heading());
    step.sigma_m = params.sigma_odometry_m + params.sigma_odometry_share * way;
    step.sigma_rad = params.sigma_odometry_rad + params.sigma_turn_share * turn;
    return step;
  }
  const double horizon = std::min(elapsed, 1.0);
  step.T_before_now = last_twist ? last_twist->after(horizon) : Pose2();
  step.sigma_m = 0.05 + 0.5 * horizon * std::min(1.0, params.fastest_mps);
  step.sigma_rad = 0.05 + 0.5 * horizon;
  return step;
}

}  // namespace smokemap
