#include "navigation/pilot.hpp"

#include <algorithm>
#include <limits>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr double kProgressM = 0.15;  // less way made is standing still

std::vector<Point2> turned_round(const std::vector<Point2>& points) {
  std::vector<Point2> turned;
  turned.reserve(points.size());
  for (const Point2& p : points) turned.emplace_back(-p);
  return turned;
}

}  // namespace

Result<Ok> PilotParams::validate() const {
  if (const auto valid = follower.validate(); !valid) return valid.error();
  if (const auto valid = planner.validate(); !valid) return valid.error();
  return ParamCheck("PilotParams")
      .positive("arrival_m", arrival_m)
      .positive("arrival_rad", arrival_rad)
      .positive("replan_period_s", replan_period_s)
      .positive("patience_s", patience_s)
      .positive("watch_patience_s", watch_patience_s)
      .positive("back_up_after_s", back_up_after_s)
      .in_range("back_up_speed_mps", back_up_speed_mps, 0, 1)
      .result();
}

void Pilot::set_target(std::optional<Point2> p_map, std::optional<double> heading_rad) {
  target_ = p_map;
  heading_rad_ = heading_rad;
  path_.reset(), planned_at_.reset(), blocked_since_.reset();
  reason_.clear();
  given_up_ = false;
  least_remaining_m_ = std::numeric_limits<double>::infinity();
}

void Pilot::move_target(const Point2& p_map) {
  if (!target_ || (*target_ - p_map).norm() < 0.05) return;
  target_ = p_map;
  planned_at_.reset();
  least_remaining_m_ = std::numeric_limits<double>::infinity();
}

bool Pilot::at_target(const Pose2& T_map_robot) const {
  const double away = (*target_ - T_map_robot.translation()).norm();
  if (away <= params_.arrival_m) return true;
  // A target too near to a wall is reached where the path ends.
  return path_ && (path_->points.back() - T_map_robot.translation()).norm() <= 0.15 &&
         away <= params_.planner.goal_radius_m + params_.arrival_m;
}

void Pilot::plan_if_due(Stamp now, const Point2& p) {
  if (planned_at_ && to_seconds(now - *planned_at_) < params_.replan_period_s) return;
  if (!planned_at_) progressed_at_ = now;
  planned_at_ = now;
  if (!map_) {
    reason_ = "there is no map yet";
    path_.reset();
    return;
  }
  auto planned = plan_path(*map_, p, *target_, params_.planner);
  if (planned) {
    path_ = std::move(*planned);
    reason_.clear();
  } else {
    path_.reset();
    reason_ = planned.error().message;
  }
}

Twist Pilot::drive(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot) {
  const Twist wanted = follow(*path_, T_map_robot, params_.follower);
  if (wanted.speed_mps <= 0 || !blocked_ahead(obstacles_robot, wanted.speed_mps, params_.follower)) {
    blocked_since_.reset();
    return wanted;
  }
  if (!blocked_since_) blocked_since_ = now;
  const double blocked_s = to_seconds(now - *blocked_since_);
  reason_ = "something stands in the way";
  const bool room_behind = !blocked_ahead(turned_round(obstacles_robot), params_.back_up_speed_mps, params_.follower);
  if (blocked_s > params_.back_up_after_s && blocked_s < params_.back_up_after_s + 1.5 && room_behind)
    return {-params_.back_up_speed_mps, 0};
  if (blocked_s >= params_.back_up_after_s + 1.5) blocked_since_.reset(), planned_at_.reset();
  // Near walls a slow creep with the turn wanted gets out of corners that a full stop never leaves.
  if (!blocked_ahead(obstacles_robot, 0.0, params_.follower)) return {0.08, wanted.turn_rate_radps};
  return {0, wanted.turn_rate_radps};
}

PilotOutput Pilot::turn_to_heading(const Pose2& T_map_robot) const {
  PilotOutput out;
  const double error = heading_rad_ ? wrap_angle(*heading_rad_ - T_map_robot.heading()) : 0.0;
  if (std::abs(error) <= params_.arrival_rad) {
    out.state = PilotState::kArrived;
    return out;
  }
  out.state = PilotState::kDriving;
  const double limit = params_.follower.max_turn_rate_radps;
  out.twist = {0, std::clamp(1.5 * error, -limit, limit)};
  return out;
}

PilotOutput Pilot::step(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot) {
  return advance(now, T_map_robot, &obstacles_robot);
}

PilotOutput Pilot::watch(Stamp now, const Pose2& T_map_robot) { return advance(now, T_map_robot, nullptr); }

PilotOutput Pilot::advance(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>* obstacles_robot) {
  PilotOutput out;
  if (!target_) return out;
  if (given_up_) {
    out.state = PilotState::kGivenUp;
    out.reason = reason_;
    return out;
  }
  if (at_target(T_map_robot)) return turn_to_heading(T_map_robot);
  plan_if_due(now, T_map_robot.translation());
  if (path_) {
    out.path = *path_;
    out.remaining_m = progress_on(*path_, T_map_robot.translation()).remaining_m;
    if (out.remaining_m < least_remaining_m_ - kProgressM) least_remaining_m_ = out.remaining_m, progressed_at_ = now;
    if (obstacles_robot) out.twist = drive(now, T_map_robot, *obstacles_robot);
  }
  out.state = path_ && !blocked_since_ ? PilotState::kDriving : PilotState::kBlocked;
  out.reason = reason_;
  const double patience_s = obstacles_robot ? params_.patience_s : params_.watch_patience_s;
  if (to_seconds(now - progressed_at_) > patience_s) {
    given_up_ = true;
    if (reason_.empty()) reason_ = "no progress for " + std::to_string(static_cast<int>(patience_s)) + " s";
    out.state = PilotState::kGivenUp, out.reason = reason_, out.twist = {};
  }
  return out;
}

}  // namespace smokemap
