#include "simulation/robot_drive.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/expect.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

constexpr double kFreeAgain = 0.02;  ///< metres between robot and wall that end a touch

double approach(double value, double wanted, double most) { return value + std::clamp(wanted - value, -most, most); }

/// Along an arc: the chord at half the turn.
Pose2 advanced(const Pose2& pose, double way_m, double turn_rad) {
  const double chord = std::abs(turn_rad) < 1e-9 ? way_m : way_m * std::sin(turn_rad / 2) / (turn_rad / 2);
  const double heading = pose.heading() + turn_rad / 2;
  return {pose.x() + chord * std::cos(heading), pose.y() + chord * std::sin(heading), pose.heading() + turn_rad};
}

}  // namespace

Result<Ok> DriveParams::validate() const {
  return ParamCheck("DriveParams")
      .in_range("radius_m", radius_m, 0.02, 2)
      .in_range("max_speed_mps", max_speed_mps, 0.01, 5)
      .in_range("max_turn_rate_radps", max_turn_rate_radps, 0.01, 10)
      .in_range("acceleration_mps2", acceleration_mps2, 0.01, 20)
      .in_range("turn_acceleration_radps2", turn_acceleration_radps2, 0.01, 100)
      .in_range("dead_man_s", dead_man_s, 0.01, 60)
      .in_range("sigma_turn_per_turn", sigma_turn_per_turn, 0, 1)
      .in_range("sigma_turn_per_metre", sigma_turn_per_metre, 0, 1)
      .in_range("sigma_way_per_metre", sigma_way_per_metre, 0, 1)
      .in_range("sigma_way_per_turn", sigma_way_per_turn, 0, 1)
      .in_range("sigma_scale", sigma_scale, 0, 0.3)
      .in_range("sigma_turn_scale", sigma_turn_scale, 0, 0.3)
      .in_range("sigma_bend_rad_per_m", sigma_bend_rad_per_m, 0, 0.3)
      .result();
}

RobotDrive::RobotDrive(const DriveParams& params, const Pose2& T_world_start, std::mt19937_64 random)
    : params_(params), random_(random), T_world_robot_(T_world_start) {
  ENGINE_EXPECT(params.validate().ok());
  scale_ = 1 + normal(random_, params.sigma_scale);
  turn_scale_ = 1 + normal(random_, params.sigma_turn_scale);
  bend_ = normal(random_, params.sigma_bend_rad_per_m);
}

void RobotDrive::command(double speed_mps, double turn_rate_radps, Stamp now) {
  if (!std::isfinite(speed_mps) || !std::isfinite(turn_rate_radps)) return;  // as a good motor controller does
  wanted_speed_ = std::clamp(speed_mps, -params_.max_speed_mps, params_.max_speed_mps);
  wanted_turn_ = std::clamp(turn_rate_radps, -params_.max_turn_rate_radps, params_.max_turn_rate_radps);
  last_command_ = now;
  commanded_ = true;
}

void RobotDrive::step(const SegmentWorld& world, Stamp dt, Stamp now) {
  const double seconds = to_seconds(dt);
  braking_ = !commanded_ || now - last_command_ > from_seconds(params_.dead_man_s);
  // Brakes are twice as strong as the motor.
  const double brake = braking_ || std::abs(wanted_speed_) < std::abs(speed_) ? 2 : 1;
  speed_ = approach(speed_, braking_ ? 0 : wanted_speed_, brake * params_.acceleration_mps2 * seconds);
  turn_rate_ = approach(turn_rate_, braking_ ? 0 : wanted_turn_, params_.turn_acceleration_radps2 * seconds);

  const double turn = turn_rate_ * seconds;
  double way = speed_ * seconds;
  Pose2 next = advanced(T_world_robot_, way, turn);
  const double here = world.clearance_m(T_world_robot_.translation(), params_.radius_m + 2 * kFreeAgain);
  const double there = world.clearance_m(next.translation(), params_.radius_m + 2 * kFreeAgain);
  const bool too_near = there < params_.radius_m && there < here + 1e-9;  // nearer to a wall than the disc allows
  if (way != 0 && (too_near || !world.sees(T_world_robot_.translation(), next.translation()))) {
    bumps_ += !touching_;
    touching_ = true;
    speed_ = way = 0;
    next = advanced(T_world_robot_, 0, turn);
  } else if (there > params_.radius_m + kFreeAgain) {
    touching_ = false;
  }
  T_world_robot_ = next;
  measure(way, turn);
}

void RobotDrive::measure(double way_m, double turn_rad) {
  if (way_m == 0 && turn_rad == 0) return;
  const double way = std::abs(way_m), turn = std::abs(turn_rad);
  const auto spread = [](double one, double of_one, double other, double of_other) {
    return std::sqrt(one * one * of_one + other * other * of_other);
  };
  const double way_seen =
      scale_ * way_m + normal(random_, spread(params_.sigma_way_per_metre, way, params_.sigma_way_per_turn, turn));
  const double turn_seen =
      turn_scale_ * turn_rad + bend_ * way_m +
      normal(random_, spread(params_.sigma_turn_per_turn, turn, params_.sigma_turn_per_metre, way));
  T_odom_robot_ = advanced(T_odom_robot_, way_seen, turn_seen);
}

}  // namespace smokemap
