#include "navigation/follower.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.hpp"
#include "geometry/segment2.hpp"

namespace smokemap {

Result<Ok> FollowerParams::validate() const {
  return ParamCheck("FollowerParams")
      .in_range("max_speed_mps", max_speed_mps, 0.01, 3)
      .in_range("max_turn_rate_radps", max_turn_rate_radps, 0.05, 6)
      .positive("lookahead_m", lookahead_m)
      .in_range("turn_in_place_rad", turn_in_place_rad, 0.1, kPi)
      .positive("robot_radius_m", robot_radius_m)
      .in_range("margin_m", margin_m, 0, 1)
      .positive("stop_time_s", stop_time_s)
      .in_range("stop_points", stop_points, 1, 100)
      .result();
}

PathProgress progress_on(const Path& path, const Point2& p) {
  ENGINE_EXPECT(path.points.size() >= 2);
  PathProgress best;
  best.off_path_m = std::numeric_limits<double>::infinity();
  double after = 0;  // length of the pieces behind the one looked at, from the end
  for (std::size_t i = path.points.size() - 1; i-- > 0;) {
    const Segment2 piece{path.points[i], path.points[i + 1]};
    const Point2 foot = closest_point(piece, p);
    const double away = (foot - p).norm();
    if (away < best.off_path_m - 1e-9) best = {i, after + (piece.b - foot).norm(), away};
    after += piece.length();
  }
  return best;
}

Pose2 pose_ahead(const Path& path, const Point2& p, double ahead_m) {
  const PathProgress at = progress_on(path, p);
  Point2 from = closest_point({path.points[at.piece], path.points[at.piece + 1]}, p);
  double heading = Segment2{path.points[at.piece], path.points[at.piece + 1]}.heading();
  for (std::size_t i = at.piece + 1; i < path.points.size(); ++i) {
    const Point2 piece = path.points[i] - from;
    const double length = piece.norm();
    if (length > 0) heading = Segment2{from, path.points[i]}.heading();
    if (length > 0 && length >= ahead_m) return Pose2(from + ahead_m / length * piece, heading);
    ahead_m -= length;
    from = path.points[i];
  }
  return Pose2(path.points.back(), heading);
}

Twist follow(const Path& path, const Pose2& T_map_robot, const FollowerParams& params) {
  const double remaining = progress_on(path, T_map_robot.translation()).remaining_m;
  const Point2 ahead =
      T_map_robot.inverse() * pose_ahead(path, T_map_robot.translation(), params.lookahead_m).translation();
  const double error = std::atan2(ahead.y(), ahead.x());
  const double turn = std::clamp(2.0 * error, -params.max_turn_rate_radps, params.max_turn_rate_radps);
  if (std::abs(error) > params.turn_in_place_rad) return {0, turn};
  const double straight = std::cos(std::min(kPi / 2, 1.5 * std::abs(error)));
  const double at_end = std::clamp(remaining / 0.6, 0.15, 1.0);
  return {params.max_speed_mps * std::min(straight, at_end), turn};
}

bool is_clear(const Twist& twist, const std::vector<Point2>& obstacles_robot, const FollowerParams& params) {
  constexpr int kSteps = 7;
  constexpr double kNearer = 1e-3;
  const double keep = params.robot_radius_m + params.margin_m;
  const double reach = keep + std::abs(twist.speed_mps) * params.stop_time_s;
  std::array<Point2, kSteps> centers;
  for (int i = 0; i < kSteps; ++i) {
    const double t = params.stop_time_s * (i + 1) / kSteps, turn = twist.turn_rate_radps * t;
    const double chord = twist.speed_mps * t * (std::abs(turn) < 1e-6 ? 1 : std::sin(turn / 2) / (turn / 2));
    centers[static_cast<std::size_t>(i)] = {chord * std::cos(turn / 2), chord * std::sin(turn / 2)};
  }
  int touched = 0;
  for (const Point2& p : obstacles_robot) {
    const double now = p.norm();
    if (now > reach) continue;
    touched += std::any_of(centers.begin(), centers.end(), [&](const Point2& center) {
      const double then = (p - center).norm();
      return then < keep && then < now - kNearer;
    });
  }
  return touched < params.stop_points;
}

std::optional<Twist> steer_clear(const Twist& wanted, const std::vector<Point2>& obstacles_robot,
                                 const FollowerParams& params) {
  constexpr double kLeastSpeed = 0.08, kPerTurn = 0.8;  // a slow creep with a turn gets out of corners
  if (wanted.speed_mps == 0 || is_clear(wanted, obstacles_robot, params)) return wanted;
  std::optional<Twist> best;
  double least = 0;
  for (const double share : {1.0, 0.5, 0.25})
    for (const double more : {0.0, 0.15, -0.15, 0.3, -0.3, 0.5, -0.5, 0.8, -0.8}) {
      const double cost = 1 - share + kPerTurn * std::abs(more);
      if (best && cost >= least) continue;
      const Twist twist{
          std::max(share * wanted.speed_mps, std::min(kLeastSpeed, wanted.speed_mps)),
          std::clamp(wanted.turn_rate_radps + more, -params.max_turn_rate_radps, params.max_turn_rate_radps)};
      if (is_clear(twist, obstacles_robot, params)) best = twist, least = cost;
    }
  return best;
}

}  // namespace smokemap
