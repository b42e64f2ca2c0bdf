#include "session/fleet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr double kRobotsMeetM = 3.0;  // farther away nobody has to give way
constexpr int kRobotOutline = 36;     // points on its circle: every 6 cm

}  // namespace

Result<Ok> FleetParams::validate() const {
  if (const auto valid = pilot.validate(); !valid) return valid.error();
  if (const auto valid = leader.validate(); !valid) return valid.error();
  return ParamCheck("FleetParams")
      .positive("stale_after_s", stale_after_s)
      .in_range("lost_after_s", lost_after_s, stale_after_s, 3600)
      .positive("look_again_s", look_again_s)
      .in_range("look_patience_s", look_patience_s, look_again_s, 36000)
      .in_range("look_limit_s", look_limit_s, look_again_s, 36000)
      .in_range("doubt_patience_s", doubt_patience_s, 0, 36000)
      .in_range("smoky_share", smoky_share, 0, 1)
      .in_range("clear_share", clear_share, 0, smoky_share)
      .in_range("explore_pause_s", explore_pause_s, 0, 60)
      .in_range("robot_radius_m", robot_radius_m, 0, 5)
      .result();
}

Fleet::Robot& Fleet::robot_of(const std::string& id) { return robots_.try_emplace(id, id, params_).first->second; }

void Fleet::heard(const std::string& robot, Stamp now) { robot_of(robot).status.last_heard = now; }

void Fleet::report(const PoseReport& report) {
  Robot& robot = robot_of(report.robot);
  robot.T_graph_robot = report.T_graph_robot;
  robot.obstacles_robot = report.obstacles_robot;
  robot.smoke_share = report.smoke_share;
  if (report.localized && report.smoke_share <= params_.clear_share)
    robot.p_graph_clear = report.T_graph_robot.translation();
  robot.ever_localized = robot.ever_localized || report.localized;
  robot.status.sigma_m = report.sigma_m;
  robot.status.sigma_rad = report.sigma_rad;
  robot.status.localized = report.localized;
  robot.status.speed_mps = report.speed_mps;
  robot.status.T_map_robot = robot.T_map_graph * robot.T_graph_robot;
}

void Fleet::set_correction(const std::string& id, const Pose2& T_map_graph) {
  Robot& robot = robot_of(id);
  robot.T_map_graph = T_map_graph;
  robot.status.T_map_robot = robot.T_map_graph * robot.T_graph_robot;
}

void Fleet::stop_now(const std::string& id) {
  for (auto& [name, robot] : robots_)
    if (id.empty() || name == id) commands_->stop(name);
}

void Fleet::tick(Stamp now, Whiteboard& board, const Carrier& carrier) {
  for (auto& [id, robot] : robots_) {
    RobotStatus& status = robot.status;
    const double age_s = to_seconds(now - status.last_heard);
    status.link = age_s <= params_.stale_after_s  ? LinkQuality::kFresh
                  : age_s <= params_.lost_after_s ? LinkQuality::kStale
                                                  : LinkQuality::kLost;
    status.stopped = board.is_stopped(id);
    status.exploring = board.explores(id);
    steer(robot, now, board, carrier);
  }
}

void Fleet::steer(Robot& robot, Stamp now, Whiteboard& board, const Carrier& carrier) {
  RobotStatus& status = robot.status;
  robot.last = {};
  status.note.clear();
  if (status.stopped) {
    robot.leader.reset();
    commands_->drive(status.id, 0, 0);
    status.note = "emergency stop";
    return;
  }
  if (status.link == LinkQuality::kLost) {
    status.note = "no signal from the robot";
    return;
  }
  if (!robot.ever_localized) {
    status.note = "the robot does not know where it is yet";
    return;
  }
  robot.pilot.set_map(map_);
  Goal* goal = next_goal(robot, board, carrier);
  take_target(robot, now, goal, carrier, status.exploring);
  commands_->navigates(status.id) ? lead(robot, now) : drive(robot, now);
  settle_goal(robot, now, goal, carrier);
  status.path_map = robot.last.path.points;
  if (status.note.empty()) status.note = robot.last.reason;
  if (!goal && robot.pilot.target() &&
      (robot.last.state == PilotState::kArrived || robot.last.state == PilotState::kGivenUp)) {
    if (!std::exchange(robot.p_map_retreat, std::nullopt)) robot.avoided.push_back(*robot.pilot.target());
    robot.pilot.set_target(std::nullopt);
    robot.idle_since = now;
  }
}

void Fleet::drive(Robot& robot, Stamp now) {
  robot.last = robot.pilot.step(now, robot.status.T_map_robot, obstacles_of(robot), robot.smoke_share);
  commands_->drive(robot.status.id, robot.last.twist.speed_mps, robot.last.twist.turn_rate_radps);
}

void Fleet::lead(Robot& robot, Stamp now) {
  const RobotStatus& status = robot.status;
  robot.last = robot.pilot.watch(now, status.T_map_robot);
  const bool has_way = robot.last.state == PilotState::kDriving && !robot.last.path.points.empty();
  if (has_way) {
    if (const auto place = robot.leader.next(robot.last.path, status.T_map_robot, robot.pilot.heading_rad(),
                                             commands_->errand(status.id)))
      commands_->lead(status.id, status.T_map_robot.inverse() * *place);
    if (!robot.leader.gave_up()) return;
    robot.last.state = PilotState::kGivenUp;
    robot.last.reason = "the robot's own navigator does not get there";
    robot.pilot.give_up(robot.last.reason);
  } else if (robot.last.state == PilotState::kDriving) {
    return;  // it stands at the place and turns
  }
  if (robot.leader.leads()) commands_->stop(status.id);
  robot.leader.reset();
}

std::vector<Point2> Fleet::avoided_by(const Robot& robot) const {
  std::vector<Point2> avoided = robot.avoided;
  for (const auto& [id, other] : robots_)
    if (&other != &robot && other.status.link != LinkQuality::kLost && !other.status.stopped && other.pilot.target())
      avoided.push_back(*other.pilot.target());
  return avoided;
}

std::vector<Point2> Fleet::obstacles_of(const Robot& robot) const {
  std::vector<Point2> obstacles = robot.obstacles_robot;
  const Pose2 T_robot_map = robot.status.T_map_robot.inverse();
  for (const auto& [id, other] : robots_) {
    if (&other == &robot || !other.ever_localized) continue;
    const Point2 p_robot = T_robot_map * other.status.T_map_robot.translation();
    if (p_robot.norm() > kRobotsMeetM) continue;
    for (int i = 0; i < kRobotOutline; ++i) {
      const double angle = 2 * kPi * i / kRobotOutline;
      obstacles.push_back(p_robot + params_.robot_radius_m * Point2(std::cos(angle), std::sin(angle)));
    }
  }
  return obstacles;
}

Goal* Fleet::next_goal(Robot& robot, Whiteboard& board, const Carrier& carrier) {
  for (Goal& goal : board.goals) {
    if (goal.robot != robot.status.id || is_final(goal.state)) continue;
    const Transferred place = carrier.to_map(goal.place);
    if (place.p) return &goal;
    goal.state = GoalState::kRefused;
    goal.reason = place.reason;
  }
  return nullptr;
}

void Fleet::take_target(Robot& robot, Stamp now, Goal* goal, const Carrier& carrier, bool explores) {
  if (goal) {
    const Point2 p = *carrier.to_map(goal->place).p;
    if (robot.status.goal_id != goal->id || !robot.pilot.target())
      take_goal(robot, *goal, p);
    else if (robot.detour)
      (void)look_for_way(robot, now, *goal, p);
    else
      robot.pilot.move_target(p);
    return;
  }
  robot.detour = false;
  if (!robot.status.goal_id.empty()) {  // the goal is done, cancelled or gone
    robot.status.goal_id.clear();
    robot.pilot.set_target(std::nullopt);
    robot.idle_since = now;
  }
  if (robot.p_map_retreat) return go_back(robot, now);
  if (!explores) {
    robot.pilot.set_target(std::nullopt);
    return;
  }
  if (robot.pilot.target() || !map_ || to_seconds(now - robot.idle_since) < params_.explore_pause_s) return;
  robot.idle_since = now;
  if (const auto frontier =
          best_frontier(*map_, robot.status.T_map_robot.translation(), avoided_by(robot), params_.frontier))
    robot.pilot.set_target(frontier->target);
  else
    robot.status.note = "everything that can be reached was seen";
}

void Fleet::go_back(Robot& robot, Stamp now) {
  robot.idle_since = now;
  robot.status.note = "it could not get on in the smoke and goes back to where it can see";
  if (!robot.pilot.target()) robot.pilot.set_target(*robot.p_map_retreat);
}

void Fleet::take_goal(Robot& robot, Goal& goal, const Point2& p_map) {
  if (robot.status.goal_id != goal.id)
    goal.state = GoalState::kSent, robot.avoided.clear(), robot.looking_s = robot.looked_s = robot.doubted_s = 0,
    robot.looked_at.reset();
  robot.status.goal_id = goal.id;
  robot.detour = false;
  robot.p_map_retreat.reset();
  robot.pilot.set_target(p_map, goal.heading_rad);
}

bool Fleet::look_for_way(Robot& robot, Stamp now, const Goal& goal, const Point2& p_map) {
  const Point2 here = robot.status.T_map_robot.translation();
  const bool there =
      robot.detour && (robot.last_detour == PilotState::kArrived || robot.last_detour == PilotState::kGivenUp);
  if (!there && robot.looked_at && to_seconds(now - *robot.looked_at) < params_.look_again_s) return robot.detour;
  robot.looked_at = now;
  if (!map_) return false;
  if (robot.detour && plan_path(*map_, here, p_map, params_.pilot.planner)) {
    robot.detour = false;
    robot.pilot.set_target(p_map, goal.heading_rad);
    return true;
  }
  if (robot.detour && !there) return true;
  if (there && robot.pilot.target()) robot.avoided.push_back(*robot.pilot.target());
  if (there && robot.last_detour == PilotState::kArrived) robot.looking_s = 0;
  const auto frontier = best_frontier(*map_, here, avoided_by(robot), params_.frontier, p_map);
  robot.last_detour = PilotState::kDriving;
  if (!frontier && !robot.detour) return false;  // a target set anew would begin its patience anew
  robot.detour = frontier.has_value();
  robot.pilot.set_target(frontier ? frontier->target : p_map);
  return robot.detour;
}

void Fleet::settle_goal(Robot& robot, Stamp now, Goal* goal, const Carrier& carrier) {
  const double passed_s = std::min(1.0, to_seconds(now - std::exchange(robot.steered_at, now)));
  if (!goal) return;
  if (robot.detour) {
    robot.looking_s += passed_s, robot.looked_s += passed_s;
    if (robot.looking_s > params_.look_patience_s)
      return give_up(robot, *goal, "no way there was found, and nothing new was seen for a minute");
    if (robot.looked_s > params_.look_limit_s)
      return give_up(robot, *goal, "no way there was found; send the robot again once more has been seen");
    robot.last_detour = robot.last.state;
    goal->state = GoalState::kDriving;
    goal->reason = "no way is known yet: looking for one";
    return;
  }
  const bool no_way = robot.last.state == PilotState::kBlocked && robot.last.path.points.empty() && map_;
  if (no_way && robot.last.reason == kNoWayKnown && look_for_way(robot, now, *goal, *carrier.to_map(goal->place).p))
    return;
  switch (robot.last.state) {
    case PilotState::kArrived:
      arrive(robot, *goal, carrier, passed_s);
      break;
    case PilotState::kGivenUp:
      give_up(robot, *goal, robot.last.reason);
      break;
    case PilotState::kDriving:
      goal->state = GoalState::kDriving, goal->reason.clear();
      break;
    default:
      goal->reason = robot.last.reason;
      break;
  }
}

void Fleet::arrive(Robot& robot, Goal& goal, const Carrier& carrier, double passed_s) {
  goal.reason = carrier.to_map(goal.place).reason;
  goal.state = GoalState::kArrived;
  if (goal.reason.empty() || carrier.plan_fits()) return;
  robot.doubted_s += passed_s;
  if (robot.doubted_s > params_.doubt_patience_s) return give_up(robot, goal, goal.reason);
  goal.state = GoalState::kDriving;
}

void Fleet::give_up(Robot& robot, Goal& goal, const std::string& reason) {
  goal.state = goal.state == GoalState::kSent ? GoalState::kRefused : GoalState::kFailed;
  const bool smoky = robot.smoke_share >= params_.smoky_share;
  goal.reason = smoky ? "the robot cannot get on in the smoke: " + reason : reason;
  robot.detour = false;
  if (smoky && robot.p_graph_clear) robot.p_map_retreat = robot.T_map_graph * *robot.p_graph_clear;
}

std::vector<RobotStatus> Fleet::status() const {
  std::vector<RobotStatus> all;
  for (const auto& [id, robot] : robots_) all.push_back(robot.status);
  return all;
}

GoalView Fleet::view(const Goal& goal, const Carrier& carrier) const {
  GoalView view{goal, carrier.to_map(goal.place), 0, 0};
  const auto it = robots_.find(goal.robot);
  if (it == robots_.end() || it->second.status.goal_id != goal.id || is_final(goal.state)) return view;
  view.remaining_m = it->second.last.remaining_m;
  view.eta_s = view.remaining_m / (0.8 * params_.pilot.follower.max_speed_mps);
  return view;
}

Result<WayQuestion> Fleet::way_question(const std::string& id, const Point2& p_map) const {
  const auto robot = robots_.find(id);
  if (robot == robots_.end()) return fail(Errc::kNotFound, "there is no robot " + id);
  if (!robot->second.ever_localized) return fail(Errc::kNotFound, id + " does not know where it is yet");
  if (!map_) return fail(Errc::kDegenerate, "there is no map yet");
  return WayQuestion{map_, robot->second.status.T_map_robot.translation(), p_map, params_.pilot.planner};
}

std::optional<Pose2> Fleet::T_graph_robot(const std::string& id) const {
  const auto it = robots_.find(id);
  if (it == robots_.end() || !it->second.ever_localized) return std::nullopt;
  return it->second.T_graph_robot;
}

}  // namespace smokemap
