#include "session/mapper.hpp"

#include <cmath>

namespace smokemap {
namespace {

/// SLAM's covariance counts from the last node; the map under that node has an error too. Measured over the demo's
/// seeds (./run bench demo): 0.02 to 0.07 m after a minute.
constexpr double kMapSigmaM = 0.05;
constexpr double kWallThicknessM = 0.15;
/// A robot is looked for only where this much wall was seen: a plan that nobody checked proves nothing.
constexpr double kSeenWallM = 10;

double seen_wall_m(const MergedMap& merged) {
  double sum = 0;
  for (const MergedWall& wall : merged.walls) sum += wall.state == WallState::kMissing ? 0 : wall.evidence_m;
  return sum;
}

/// A pose on the plan in `map`: the place carried by the deformation, the heading by a step of half a metre.
Pose2 carried(const Deformation& layout_to_map, const Pose2& T_layout_robot) {
  const Point2 p = layout_to_map(T_layout_robot.translation());
  const Point2 ahead = layout_to_map(T_layout_robot * Point2(0.5, 0)) - p;
  return {p, std::atan2(ahead.y(), ahead.x())};
}

int nearest(const Trajectory& trajectory, const Point2& p_map) {
  int best = 0;
  const auto away = [&](int i) {
    return (trajectory[static_cast<std::size_t>(i)].T_map_robot.translation() - p_map).squaredNorm();
  };
  for (int i = 1; i < static_cast<int>(trajectory.size()); ++i)
    if (away(i) < away(best)) best = i;
  return best;
}

}  // namespace

std::vector<LocalizerWall> walls_to_localize_in(const MergedMap& merged) {
  std::vector<LocalizerWall> walls;
  for (const MergedWall& wall : merged.walls)
    if (wall.state != WallState::kMissing) walls.push_back({wall.segment_map, kWallThicknessM});
  return walls;
}

Mapper::Track& Mapper::track_of(const std::string& robot) {
  if (map_maker_.empty()) map_maker_ = robot;
  return tracks_.try_emplace(robot, work_).first->second;
}

std::optional<PoseReport> Mapper::report(const std::string& robot, Track& track, const Result<ScanOutcome>& outcome) {
  if (!outcome) return std::nullopt;  // malformed: SLAM counted it
  if (outcome->node && robot != map_maker_ && !union_.has(robot)) locate(robot, track);
  const bool joined = robot == map_maker_ || union_.has(robot);
  if (outcome->node && joined) changed_ = true;
  PoseReport report;
  report.robot = robot;
  report.T_graph_robot = union_.T_union_slam(robot).value_or(Pose2()) * outcome->pose.T_map_robot;
  const double since_node_m = std::sqrt(std::max(0.0, 0.5 * outcome->pose.covariance.topLeftCorner<2, 2>().trace()));
  const auto in_graph = floor_->merged->robot_sigma_m.find(robot);
  const bool counted = joined && in_graph != floor_->merged->robot_sigma_m.end();
  report.sigma_m = std::hypot(since_node_m, kMapSigmaM, counted ? in_graph->second : track.join_sigma_m);
  report.sigma_rad = std::sqrt(std::max(0.0, outcome->pose.covariance(2, 2)));
  report.localized = joined && (outcome->fate == ScanFate::kMatched || outcome->fate == ScanFate::kFirst);
  report.speed_mps = track.speed_mps;
  return report;
}

std::optional<PoseReport> Mapper::add(const SensorItem& item) {
  if (const auto* odometry = std::get_if<Odometry>(&item)) {
    Track& track = track_of(odometry->robot);
    track.slam.add_odometry(*odometry);
    track.odometry.add(*odometry);
    track.T_odom_robot = odometry->T_odom_robot;
    track.speed_mps = odometry->speed_mps;
    return std::nullopt;
  }
  if (const auto* sweep = std::get_if<RadarSweep>(&item)) {
    Track& track = track_of(sweep->robot);
    (void)track.slam.add_sweep(*sweep);
    track.watch.add_sweep(*sweep, track.T_odom_at(sweep->stamp), track.odometry.twist().value_or(Twist2{}));
    return std::nullopt;
  }
  const auto& scan = std::get<LaserScan>(item);
  Track& track = track_of(scan.robot);
  auto made = report(scan.robot, track, track.slam.add_scan(scan));
  if (!made) return made;
  track.watch.add_scan(scan, track.T_odom_at(scan.stamp), track.odometry.twist().value_or(Twist2{}));
  made->obstacles_robot = track.watch.obstacles_robot(track.T_odom_robot);
  made->smoke_share = track.watch.smoke_share();
  return made;
}

void Mapper::take(std::shared_ptr<const FloorView> floor) {
  if (floor == floor_) return;
  const bool new_walls = floor->merged != floor_->merged;
  floor_ = std::move(floor);
  for (auto& [robot, track] : tracks_) {
    if (robot == map_maker_) continue;
    if (new_walls && track.locating) track.locator.set_walls(walls_to_localize_in(*floor_->merged));
    follow_hint(robot, track);
  }
}

void Mapper::follow_hint(const std::string& robot, Track& track) {
  const auto hint = floor_->hints.find(robot);
  if (hint == floor_->hints.end() || hint->second.revision == track.hint_revision) return;
  if (floor_->merged->corners.empty() || track.slam.graph().nodes.empty()) return;  // not yet
  track.hint_revision = hint->second.revision;
  if (union_.has(robot)) {
    union_.leave(robot);
    changed_ = true;
  }
  const StandHint& h = hint->second;
  const double plan_sigma_m = floor_->merged->layout_to_map.sigma_m(h.T_layout_robot.translation());
  track.locator.set_walls(walls_to_localize_in(*floor_->merged));
  track.locator.start_at(carried(floor_->merged->layout_to_map, h.T_layout_robot), std::hypot(h.sigma_m, plan_sigma_m),
                         h.sigma_rad);
  track.T_slam_at_step = track.slam.latest_pose().T_map_robot;
  track.locating = true;
}

void Mapper::locate(const std::string& robot, Track& track) {
  follow_hint(robot, track);
  const PoseNode& node = track.slam.graph().nodes.back();
  if (!track.locating) {
    if (seen_wall_m(*floor_->merged) < kSeenWallM) return;
    track.locator.set_walls(walls_to_localize_in(*floor_->merged));
    track.locator.start_anywhere();
    track.T_slam_at_step = node.T_map_robot;
    track.locating = true;
  }
  track.locator.step(track.T_slam_at_step.inverse() * node.T_map_robot, *node.hits_robot);
  track.T_slam_at_step = node.T_map_robot;
  if (track.locator.sure()) join(robot, track, node);
}

void Mapper::join(const std::string& robot, Track& track, const PoseNode& node) {
  const Trajectory& trajectory = floor_->merged->trajectory;
  if (trajectory.empty() || floor_->generation != union_.generation()) return;  // the map is being made
  const LocalizerEstimate found = track.locator.estimate();
  GraphLink link;
  link.union_node = nearest(trajectory, found.T_map_robot.translation());
  link.own_node = node.id;
  link.T_union_own = trajectory[static_cast<std::size_t>(link.union_node)].T_map_robot.inverse() * found.T_map_robot;
  link.sigma_m = std::sqrt(0.5 * (found.covariance(0, 0) + found.covariance(1, 1)));
  link.sigma_rad = std::sqrt(found.covariance(2, 2));
  union_.update(robot, track.slam.graph());
  if (!union_.join(robot, link)) return;
  track.join_sigma_m = link.sigma_m;
  track.locating = false;
  changed_ = true;
}

bool Mapper::optimize(const Progress& progress) {
  bool changed = changed_;
  changed_ = false;
  for (auto& [robot, track] : tracks_) {
    const bool solved = track.slam.optimize(progress);
    if (robot != map_maker_ && !union_.has(robot)) continue;
    changed = changed || solved;
    if (changed) union_.update(robot, track.slam.graph());
  }
  if (changed) graph_ = {std::make_shared<const PoseGraph>(union_.graph()), union_.generation()};
  return changed;
}

}  // namespace smokemap
