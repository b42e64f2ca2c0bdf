#include "navigation/obstacle_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "slam/radar_points.hpp"
#include "slam/slam_params.hpp"
#include "slam/smoke.hpp"

namespace smokemap {
namespace {

constexpr double kShareMemory = 0.2;  // share of the newest scan in the estimate of smoke
constexpr std::size_t kBearings = 120;
constexpr double kTogetherM = 0.12;  // echoes of a surface
constexpr int kLeastTogether = 3;

std::size_t bearing_of(const Point2& p) {
  return static_cast<std::size_t>((std::atan2(p.y(), p.x()) + kPi) / (2 * kPi) * kBearings) % kBearings;
}

}  // namespace

Result<Ok> ObstacleParams::validate() const {
  return ParamCheck("ObstacleParams")
      .positive("near_m", near_m)
      .in_range("body_m", body_m, 0, near_m)
      .positive("together_m", together_m)
      .in_range("least_together", least_together, 1, 1000)
      .positive("half_width_m", half_width_m)
      .positive("behind_m", behind_m)
      .in_range("most_through", most_through, 0, 1)
      .in_range("scans", scans, 1, 100)
      .positive("sweep_valid_s", sweep_valid_s)
      .in_range("smoky_share", smoky_share, 0, 1)
      .in_range("sweeps", sweeps, 1, 100)
      .in_range("sweep_every_m", sweep_every_m, 0, 10)
      .positive("radar_behind_m", radar_behind_m)
      .result();
}

void ObstacleWatch::add_sweep(const RadarSweep& sweep, const Pose2& T_odom_robot, const Twist2& twist) {
  sweep_ = sweep;
  T_odom_sweep_ = T_odom_robot;
  Turn turn{T_odom_robot, std::vector<double>(kBearings, 0.0), {}};
  std::vector<Point2> nearest;  // of each azimuth: what is behind may be a mirror's image
  int azimuth = -1;
  for (const RadarEcho& echo : strongest_echoes(sweep, twist, RadarParams{})) {
    if (echo.azimuth == azimuth) continue;
    azimuth = echo.azimuth;
    nearest.push_back(echo.p);
    double& range = turn.nearest_m[bearing_of(echo.p)];
    if (range == 0 || echo.p.norm() < range) range = echo.p.norm();
  }
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].norm() > params_.near_m) continue;
    const auto together = std::count_if(nearest.begin(), nearest.end(),
                                        [&](const Point2& q) { return (q - nearest[i]).norm() < kTogetherM; });
    if (together >= kLeastTogether) turn.near_odom.push_back(T_odom_robot * nearest[i]);
  }
  if (turns_.size() > 1 && (turns_[turns_.size() - 2].T_odom_robot.translation() - T_odom_robot.translation()).norm() <
                               params_.sweep_every_m)
    turns_.pop_back();
  turns_.push_back(std::move(turn));
  while (turns_.size() > static_cast<std::size_t>(params_.sweeps)) turns_.pop_front();
}

void ObstacleWatch::add_scan(const LaserScan& scan, const Pose2& T_odom_robot, const Twist2& twist) {
  const BeamConvention convention;
  const std::size_t beams = distinct_beams(scan);
  SmokeView view{std::vector<bool>(scan.ranges_m.size(), false), 0};
  if (sweep_ && std::abs(to_seconds(scan.stamp - sweep_->stamp)) < params_.sweep_valid_s)
    view = look_for_smoke(scan, convention, *sweep_, T_odom_robot.inverse() * T_odom_sweep_, RadarParams{});
  smoke_share_ += kShareMemory * (view.share - smoke_share_);
  Look look{T_odom_robot * scan.T_robot_laser, scan.angle_min_rad, scan.angle_increment_rad, {}, {}};
  look.range_m.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = scan.ranges_m[i];
    const bool echo = classify(range, scan, convention) == BeamKind::kHit && !view.beams[i];
    look.range_m.push_back(echo ? range : 0.0F);
    if (!echo || static_cast<double>(range) > params_.near_m || static_cast<double>(range) < params_.body_m) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    const Point2 p_robot = scan.T_robot_laser * (static_cast<double>(range) * Point2(std::cos(angle), std::sin(angle)));
    look.near_odom.push_back(T_odom_robot * (twist.after(static_cast<double>(i) * scan.time_increment_s) * p_robot));
  }
  looks_.push_back(std::move(look));
  while (looks_.size() > static_cast<std::size_t>(params_.scans)) looks_.pop_front();
}

/// Where the last scans looked at the place: did beams end there rather than go on?
/// @param says_radar  somebody else says that something stands there: it is enough that beams do not go on
bool ObstacleWatch::lidar_stops_at(const Point2& p_odom, bool says_radar) const {
  int through = 0, ended = 0;
  for (const Look& look : looks_) {
    const Point2 p_laser = look.T_odom_laser.inverse() * p_odom;
    const double away = p_laser.norm(), step = look.angle_increment_rad;
    const auto beams = static_cast<std::ptrdiff_t>(look.range_m.size());
    if (away < 0.05 || beams == 0) continue;
    const auto turn = std::max<std::ptrdiff_t>(beams, std::lround(2 * kPi / std::abs(step)));
    const double at = std::remainder(std::atan2(p_laser.y(), p_laser.x()) - look.angle_min_rad, 2 * kPi) / step;
    const double half = std::min(0.5, std::atan2(params_.half_width_m, away)) / std::abs(step);
    for (auto i = std::lround(std::ceil(at - half)); i <= std::lround(std::floor(at + half)); ++i) {
      const std::ptrdiff_t beam = (i % turn + turn) % turn;
      if (beam >= beams) continue;
      const auto range = static_cast<double>(look.range_m[static_cast<std::size_t>(beam)]);
      through += range > away + params_.behind_m;
      ended += range > away - params_.behind_m && range <= away + params_.behind_m;
    }
  }
  return (says_radar || ended > 0) && through <= params_.most_through * (through + ended);
}

bool ObstacleWatch::radar_saw_through(const Point2& p_odom, std::size_t after_turn) const {
  for (std::size_t i = after_turn + 1; i < turns_.size(); ++i) {
    const Point2 p_robot = turns_[i].T_odom_robot.inverse() * p_odom;
    const double away = p_robot.norm();
    if (away < RadarParams{}.nearest_m + 0.1) continue;  // too near to be seen
    bool seen = false, through = true;
    const std::size_t bearing = bearing_of(p_robot);
    for (const std::size_t b : {(bearing + kBearings - 1) % kBearings, bearing, (bearing + 1) % kBearings}) {
      const double range = turns_[i].nearest_m[b];
      seen = seen || range > 0;
      through = through && (range == 0 || range > away + params_.radar_behind_m);
    }
    if (seen && through) return true;
  }
  return false;
}

std::vector<Point2> ObstacleWatch::solid_echoes() const {
  std::vector<Point2> solid, together;
  for (const Look& look : looks_)
    for (const Point2& p : look.near_odom)
      if (lidar_stops_at(p, false)) solid.push_back(p);
  const int least = std::min(params_.least_together, static_cast<int>(looks_.size()));
  for (const Point2& p : solid)
    if (std::count_if(solid.begin(), solid.end(),
                      [&](const Point2& q) { return (q - p).norm() < params_.together_m; }) >= least)
      together.push_back(p);
  return together;
}

std::vector<Point2> ObstacleWatch::obstacles_robot(const Pose2& T_odom_robot) const {
  std::vector<Point2> obstacles;
  const Pose2 T_robot_odom = T_odom_robot.inverse();
  const auto take = [&](const Point2& p_odom) {
    const Point2 p = T_robot_odom * p_odom;
    if (p.norm() >= params_.body_m && p.norm() <= params_.near_m) obstacles.push_back(p);
  };
  for (const Point2& p : solid_echoes()) take(p);
  if (smoke_share_ < params_.smoky_share) return obstacles;
  for (std::size_t i = 0; i < turns_.size(); ++i)
    for (const Point2& p : turns_[i].near_odom)
      if (lidar_stops_at(p, true) && !radar_saw_through(p, i)) take(p);
  return obstacles;
}

}  // namespace smokemap
