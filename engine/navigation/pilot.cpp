#include "navigation/pilot.hpp"

#include <algorithm>
#include <limits>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr double kProgressM = 0.15;  // less way made is standing still
constexpr double kOtherWayM = 0.5;   // so much more to go from one moment to the next is another way
constexpr double kBackUpS = 1.5;
constexpr double kPastM = 0.3;    // so far from where it was held up the robot got past
constexpr double kAheadM = 0.15;  // what stands beside the robot leaves it a way back
constexpr const char* kInTheWay = "something stands in the way";

}  // namespace

Result<Ok> PilotParams::validate() const {
  if (const auto valid = follower.validate(); !valid) return valid.error();
  if (const auto valid = planner.validate(); !valid) return valid.error();
  return ParamCheck("PilotParams")
      .positive("arrival_m", arrival_m)
      .positive("arrival_rad", arrival_rad)
      .positive("replan_period_s", replan_period_s)
      .positive("patience_s", patience_s)
      .in_range("stuck_patience_s", stuck_patience_s, patience_s, 36000)
      .positive("watch_patience_s", watch_patience_s)
      .positive("back_up_after_s", back_up_after_s)
      .in_range("back_up_speed_mps", back_up_speed_mps, 0, 1)
      .positive("met_valid_s", met_valid_s)
      .in_range("smoke_speed_mps", smoke_speed_mps, 0.01, 3)
      .in_range("clear_share", clear_share, 0, 1)
      .in_range("blind_share", blind_share, clear_share, 1)
      .in_range("most_ways", most_ways, 0, 1000)
      .result();
}

void Pilot::set_target(const std::optional<Point2>& p_map, std::optional<double> heading_rad) {
  target_ = p_map;
  heading_rad_ = heading_rad;
  path_.reset(), planned_at_.reset(), held_up_.reset(), progressed_at_.reset();
  standing_ = false;
  reason_.clear();
  given_up_ = false;
  ways_ = 0;
  least_remaining_m_ = last_remaining_m_ = std::numeric_limits<double>::infinity();
}

void Pilot::move_target(const Point2& p_map) {
  if (!target_ || (*target_ - p_map).norm() < 0.05) return;
  target_ = p_map;
  planned_at_.reset();
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
  planned_at_ = now;
  if (!map_) {
    reason_ = "there is no map yet";
    path_.reset();
    return;
  }
  auto planned = plan(now, p);
  if (planned) {
    path_ = std::move(*planned);
    reason_.clear();
  } else {
    path_.reset();
    reason_ = planned.error().message;
  }
}

/// Around what was met, too.
Result<Path> Pilot::plan(Stamp now, const Point2& p) {
  if (to_seconds(now - met_at_) > params_.met_valid_s) met_map_.clear();
  auto planned = plan_path(*map_, p, *target_, params_.planner);
  if (!planned || met_map_.empty()) return planned;
  auto around = plan_path(map_->with_blocked(met_map_), p, *target_, params_.planner);
  return around ? around : fail(Errc::kDegenerate, kInTheWay);
}

void Pilot::remember_obstacles(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot) {
  met_at_ = now;
  for (const Point2& p : obstacles_robot)
    if (p.x() > kAheadM) met_map_.push_back(T_map_robot * p);
}

/// A longer way that was taken instead of one that turned out closed begins afresh: a few times, and only after some
/// way was made on the one before.
void Pilot::note_progress(Stamp now, double remaining_m) {
  const bool other_way = remaining_m > last_remaining_m_ + kOtherWayM && ways_ < params_.most_ways &&
                         (ways_ == 0 || least_remaining_m_ < begun_remaining_m_ - kOtherWayM);
  if (other_way || ways_ == 0) begun_remaining_m_ = remaining_m;
  ways_ += other_way;
  if (other_way || remaining_m < least_remaining_m_ - kProgressM)
    least_remaining_m_ = remaining_m, progressed_at_ = now;
  last_remaining_m_ = remaining_m;
}

Twist Pilot::drive(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot,
                   double smoke_share) {
  Twist wanted = follow(*path_, T_map_robot, params_.follower);
  const double blind =
      std::clamp((smoke_share - params_.clear_share) / (params_.blind_share - params_.clear_share + 1e-9), 0.0, 1.0);
  wanted.speed_mps =
      std::min(wanted.speed_mps, std::lerp(params_.follower.max_speed_mps, params_.smoke_speed_mps, blind));
  return get_past(now, T_map_robot, wanted, obstacles_robot);
}

/// Steers round what stands there; what holds the robot up in one place for a while is backed off from, remembered and
/// planned around.
Twist Pilot::get_past(Stamp now, const Pose2& T_map_robot, const Twist& wanted,
                      const std::vector<Point2>& obstacles_robot) {
  const auto clear = steer_clear(wanted, obstacles_robot, params_.follower);
  const bool free = clear && clear->speed_mps == wanted.speed_mps && clear->turn_rate_radps == wanted.turn_rate_radps;
  standing_ = !clear;
  if (held_up_ && (held_up_->p_map - T_map_robot.translation()).norm() > kPastM) held_up_.reset();
  if (!free && !held_up_) held_up_ = HeldUp{now, T_map_robot.translation()};
  const double held_up_s = held_up_ ? to_seconds(now - held_up_->since) : 0;
  if (free) return wanted;
  if (clear && held_up_s < params_.back_up_after_s) return *clear;
  reason_ = kInTheWay;
  standing_ = true;
  if (held_up_s < params_.back_up_after_s) return {0, wanted.turn_rate_radps};
  if (held_up_s >= params_.back_up_after_s + kBackUpS) {
    remember_obstacles(now, T_map_robot, obstacles_robot);
    held_up_.reset(), planned_at_.reset();
    return {};
  }
  const Twist back{-params_.back_up_speed_mps, 0};
  return is_clear(back, obstacles_robot, params_.follower) ? back : Twist{0, wanted.turn_rate_radps};
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

PilotOutput Pilot::step(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>& obstacles_robot,
                        double smoke_share) {
  return advance(now, T_map_robot, &obstacles_robot, smoke_share);
}

PilotOutput Pilot::watch(Stamp now, const Pose2& T_map_robot) { return advance(now, T_map_robot, nullptr, 0); }

PilotOutput Pilot::advance(Stamp now, const Pose2& T_map_robot, const std::vector<Point2>* obstacles_robot,
                           double smoke_share) {
  PilotOutput out;
  if (!target_) return out;
  if (given_up_) {
    out.state = PilotState::kGivenUp;
    out.reason = reason_;
    return out;
  }
  if (at_target(T_map_robot)) return turn_to_heading(T_map_robot);
  if (!progressed_at_) progressed_at_ = now;
  plan_if_due(now, T_map_robot.translation());
  if (path_) {
    out.path = *path_;
    out.remaining_m = progress_on(*path_, T_map_robot.translation()).remaining_m;
    note_progress(now, out.remaining_m);
    if (obstacles_robot) out.twist = drive(now, T_map_robot, *obstacles_robot, smoke_share);
  }
  out.state = path_ && !standing_ ? PilotState::kDriving : PilotState::kBlocked;
  out.reason = reason_;
  const double patience_s = !obstacles_robot                ? params_.watch_patience_s
                            : path_ || reason_ == kInTheWay ? params_.stuck_patience_s
                                                            : params_.patience_s;
  if (to_seconds(now - *progressed_at_) > patience_s) {
    given_up_ = true;
    if (reason_.empty()) reason_ = "no progress for " + std::to_string(static_cast<int>(patience_s)) + " s";
    out.state = PilotState::kGivenUp, out.reason = reason_, out.twist = {};
  }
  return out;
}

}  // namespace smokemap
