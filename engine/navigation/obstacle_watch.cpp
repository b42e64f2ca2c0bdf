#include "navigation/obstacle_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "slam/slam_params.hpp"
#include "slam/smoke.hpp"

namespace smokemap {

Result<Ok> ObstacleParams::validate() const {
  return ParamCheck("ObstacleParams")
      .positive("near_m", near_m)
      .positive("half_width_m", half_width_m)
      .positive("behind_m", behind_m)
      .in_range("most_through", most_through, 0, 1)
      .in_range("scans", scans, 1, 100)
      .positive("sweep_valid_s", sweep_valid_s)
      .result();
}

void ObstacleWatch::add_sweep(const RadarSweep& sweep, const Pose2& T_odom_robot) {
  sweep_ = sweep;
  T_odom_sweep_ = T_odom_robot;
}

void ObstacleWatch::add_scan(const LaserScan& scan, const Pose2& T_odom_robot) {
  T_odom_robot_ = T_odom_robot;
  const BeamConvention convention;
  const std::size_t beams = distinct_beams(scan);
  std::vector<bool> smoke(scan.ranges_m.size(), false);
  if (sweep_ && std::abs(to_seconds(scan.stamp - sweep_->stamp)) < params_.sweep_valid_s)
    smoke = look_for_smoke(scan, convention, *sweep_, T_odom_robot.inverse() * T_odom_sweep_, RadarParams{}).beams;
  Look look{T_odom_robot * scan.T_robot_laser, scan.angle_min_rad, scan.angle_increment_rad, {}};
  look.beams.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = scan.ranges_m[i];
    const bool echo = classify(range, scan, convention) == BeamKind::kHit;
    look.beams.push_back({scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad,
                          echo ? static_cast<double>(range) : 0.0, echo && !smoke[i]});
  }
  looks_.push_back(std::move(look));
  while (looks_.size() > static_cast<std::size_t>(params_.scans)) looks_.pop_front();
}

bool ObstacleWatch::is_solid(const Point2& p_odom) const {
  int through = 0, ended = 0;
  for (const Look& look : looks_) {
    const Point2 p_laser = look.T_odom_laser.inverse() * p_odom;
    const double away = p_laser.norm(), angle = std::atan2(p_laser.y(), p_laser.x());
    if (away < 0.05 || look.beams.empty()) continue;
    const double window = std::min(0.5, std::atan2(params_.half_width_m, away));
    for (const Beam& beam : look.beams) {
      if (beam.range_m <= 0 || std::abs(wrap_angle(beam.angle_rad - angle)) > window) continue;
      if (beam.range_m > away + params_.behind_m)
        ++through;
      else if (beam.range_m > away - params_.behind_m)
        beam.echo ? ++ended : ++through;  // smoke: the radar went on
    }
  }
  return ended > 0 && through <= params_.most_through * (through + ended);
}

std::vector<Point2> ObstacleWatch::obstacles_robot() const {
  std::vector<Point2> obstacles;
  if (looks_.empty()) return obstacles;
  const Look& now = looks_.back();
  const Pose2 T_robot_odom = T_odom_robot_.inverse();
  for (const Beam& beam : now.beams) {
    if (!beam.echo || beam.range_m > params_.near_m) continue;
    const Point2 p_odom =
        now.T_odom_laser * Point2(beam.range_m * std::cos(beam.angle_rad), beam.range_m * std::sin(beam.angle_rad));
    if (is_solid(p_odom)) obstacles.push_back(T_robot_odom * p_odom);
  }
  return obstacles;
}

}  // namespace smokemap
