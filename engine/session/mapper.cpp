#include "session/mapper.hpp"

#include <cmath>

namespace smokemap {
namespace {

/// SLAM's covariance counts from the last node; the map under that node has an error too. Measured over the demo's
/// seeds
/// (./run bench demo): 0.02 to 0.07 m after a minute.
constexpr double kMapSigmaM = 0.05;

}  // namespace

Mapper::Track& Mapper::track_of(const std::string& robot) {
  if (map_maker_.empty()) map_maker_ = robot;
  return tracks_.try_emplace(robot).first->second;
}

std::optional<PoseReport> Mapper::report(const std::string& robot, Track& track, const Result<ScanOutcome>& outcome) {
  if (!outcome) return std::nullopt;  // malformed: SLAM counted it
  if (outcome->node && robot == map_maker_) changed_ = true;
  PoseReport report;
  report.robot = robot;
  report.T_slam_robot = outcome->pose.T_map_robot;
  const double since_node_m = std::sqrt(std::max(0.0, 0.5 * outcome->pose.covariance.topLeftCorner<2, 2>().trace()));
  report.sigma_m = std::hypot(since_node_m, kMapSigmaM);
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
    track.watch.add_sweep(*sweep, track.T_odom_robot);
    return std::nullopt;
  }
  const auto& scan = std::get<LaserScan>(item);
  Track& track = track_of(scan.robot);
  auto made = report(scan.robot, track, track.slam.add_scan(scan));
  if (!made) return made;
  track.watch.add_scan(scan, track.T_odom_robot);
  made->obstacles_robot = track.watch.obstacles_robot();
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
