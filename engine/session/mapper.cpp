#include "session/mapper.hpp"

#include <cmath>
#include <unordered_set>

namespace smokemap {
namespace {

constexpr double kConfirmM = 0.12;

std::int64_t bucket(double x, double y) {
  return static_cast<std::int64_t>(std::floor(x / kConfirmM)) * 1'000'003 + static_cast<std::int64_t>(std::floor(y / kConfirmM));
}

}  // namespace

std::vector<Point2> confirmed_hits(const std::vector<Point2>& hits, const std::vector<Point2>& before) {
  std::unordered_set<std::int64_t> taken;
  for (const Point2& p : before)
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) taken.insert(bucket(p.x() + dx * kConfirmM, p.y() + dy * kConfirmM));
  std::vector<Point2> confirmed;
  for (const Point2& p : hits)
    if (taken.contains(bucket(p.x(), p.y()))) confirmed.push_back(p);
  return confirmed;
}

Mapper::Track& Mapper::track_of(const std::string& robot) {
  if (map_maker_.empty()) map_maker_ = robot;
  return tracks_.try_emplace(robot).first->second;
}

std::optional<PoseReport> Mapper::report(const std::string& robot, Track& track, const Result<ScanOutcome>& outcome) {
  if (!outcome) {
    trouble_ = robot + ": " + outcome.error().message;
    return std::nullopt;
  }
  if (outcome->node && robot == map_maker_) changed_ = true;
  PoseReport report;
  report.robot = robot;
  report.T_slam_robot = outcome->pose.T_map_robot;
  report.sigma_m = std::sqrt(std::max(0.0, 0.5 * outcome->pose.covariance.topLeftCorner<2, 2>().trace()));
  report.sigma_rad = std::sqrt(std::max(0.0, outcome->pose.covariance(2, 2)));
  report.localized = robot == map_maker_ && (outcome->fate == ScanFate::kMatched || outcome->fate == ScanFate::kFirst);
  report.speed_mps = track.speed_mps;
  return report;
}

std::optional<PoseReport> Mapper::add(const SensorItem& item) {
  if (const auto* odometry = std::get_if<Odometry>(&item)) {
    Track& track = track_of(odometry->robot);
    track.slam.add_odometry(*odometry);
    track.T_odom_robot = odometry->T_odom_robot;
    track.speed_mps = odometry->speed_mps;
    return std::nullopt;
  }
  if (const auto* sweep = std::get_if<RadarSweep>(&item)) {
    Track& track = track_of(sweep->robot);
    (void)track.slam.add_sweep(*sweep);
    return std::nullopt;
  }
  const auto& scan = std::get<LaserScan>(item);
  Track& track = track_of(scan.robot);
  auto made = report(scan.robot, track, track.slam.add_scan(scan));
  if (!made) return made;
  std::vector<Point2> hits_odom;
  for (const Point2& p : hit_points(scan, {})) hits_odom.push_back(track.T_odom_robot * (scan.T_robot_laser * p));
  const Pose2 T_robot_odom = track.T_odom_robot.inverse();
  for (const Point2& p : confirmed_hits(hits_odom, track.last_hits_odom)) made->obstacles_robot.push_back(T_robot_odom * p);
  track.last_hits_odom = std::move(hits_odom);
  return made;
}

bool Mapper::optimize(const Progress& progress) {
  const auto it = tracks_.find(map_maker_);
  if (it == tracks_.end()) return false;
  const bool solved = it->second.slam.optimize(progress);
  const bool changed = changed_ || solved;
  changed_ = false;
  if (changed) graph_ = std::make_shared<const PoseGraph>(it->second.slam.graph());
  return changed;
}

std::shared_ptr<const PoseGraph> Mapper::graph() { return graph_; }

}  // namespace smokemap
