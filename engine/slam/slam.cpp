#include "slam/slam.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/covariance.hpp"
#include "maps/radar_image.hpp"
#include "slam/radar_points.hpp"
#include "slam/smoke.hpp"
#include "slam/walkers.hpp"

namespace smokemap {
namespace {

constexpr double kSweepIsFresh_s = 1.0;
constexpr double kLidarIsSilent_s = 2.0;
constexpr double kSmokeMemory = 0.3;  ///< share of the newest scan in the estimate of smoke
constexpr double kClearShare = 0.35;  ///< radar and lidar disagree on so many beams in clear air
constexpr double kSmokeIsAll = 0.75;

/// Joins a radar's points to a scan's: as exact as they are compared with a lidar's, times `weight`.
void add_radar(ScanPoints& points, const ScanPoints& radar, const Pose2& T_now_then, double weight,
               const SlamParams& params) {
  const double exactness = params.align.sigma_point_m / params.radar.align.sigma_point_m;
  const Eigen::Matrix2d R = T_now_then.rotation();
  for (const SurfacePoint& point : radar.surface)
    points.surface.push_back({T_now_then * point.p, R * point.normal, weight * exactness * exactness * point.weight});
  if (weight < 1) return;
  std::vector<Point2> hits;
  for (const Point2& p : *radar.hits_robot) hits.push_back(T_now_then * p);
  points.radar_hits_robot = std::make_shared<const std::vector<Point2>>(std::move(hits));
}

/// Where a scan stands relative to the graph.
struct Anchor {
  Stamp stamp = 0;
  Pose2 T_track_robot;
  int node = 0;  ///< last node at or before the scan
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

}  // namespace

const char* to_string(ScanFate fate) {
  switch (fate) {
    case ScanFate::kMatched:
      return "matched";
    case ScanFate::kFirst:
      return "first";
    case ScanFate::kTooFewPoints:
      return "too_few_points";
    case ScanFate::kPoorMatch:
      return "poor_match";
    case ScanFate::kNewPiece:
      return "new_piece";
    case ScanFate::kDuplicate:
      return "duplicate";
  }
  broken_promise("a known ScanFate", __FILE__, __LINE__);
}

class Slam::Impl {
 public:
  Impl(const SlamParams& params, GraphWork work)
      : params_(params), work_(work), walkers_(params.walkers), radar_walkers_(params.radar.walkers) {}

  void add_odometry(const Odometry& reading) {
    ++counters_.odometry;
    odometry_.add(reading);
  }
  Result<ScanOutcome> add_scan(const LaserScan& scan);
  Result<ScanOutcome> add_sweep(const RadarSweep& sweep);
  Pose2 T_map_track() const;
  Pose2 T_map_odom() const;
  StampedPose latest() const;
  Trajectory trajectory() const;

  bool take_over(const GraphUpdate* update);

  SlamParams params_;
  GraphWork work_;
  PoseGraph graph_;  ///< nodes and the front end's edges as they come, the rest as of the newest update
  SlamCounters counters_;
  std::optional<FrontEnd> front_;  ///< with the first scan or sweep
  std::unique_ptr<GraphWorker> worker_;

 private:
  ScanOutcome add_points(Stamp stamp, const std::string& robot, const ScanPoints& points, const PredictedStep& step);
  PredictedStep predict(Stamp stamp);
  void begin();
  ScanPoints points_of(const LaserScan& scan, std::vector<BeamUse> uses);
  bool is_sparse(const PredictedStep& step, double gate_m) const;
  std::vector<double> walkers_in(const RadarSweep& sweep, const Pose2& T_way_robot);
  std::vector<BeamUse> without_walkers(const LaserScan& scan, const HitRanges& hits, const PredictedStep& step);
  Pose2 track_pose() const { return front_ ? front_->T_track_robot() : Pose2(); }
  Pose2 pose_of(const Anchor& anchor) const;
  void keep_node(Stamp stamp, const std::string& robot, const ScanPoints& points, const FrontEnd::Tracked& tracked);
  void count(ScanFate fate);
  Twist2 twist_for_straightening() const {
    if (const auto by_wheels = odometry_.twist())
      return twist_ ? wheel_error_.corrected(*by_wheels, *twist_) : *by_wheels;
    return twist_.value_or(Twist2{});
  }

  OdometryBuffer odometry_;
  std::optional<Pose2> T_odom_last_;  ///< odometry at the last scan
  std::optional<Twist2> twist_;       ///< of the last matched step
  WheelError wheel_error_;
  std::optional<Stamp> last_stamp_;
  std::vector<float> last_ranges_;
  std::optional<RadarSweep> last_sweep_;
  std::optional<Pose2> T_odom_sweep_;
  std::vector<double> sweep_walkers_m_;  ///< of the newest sweep, see walkers_in
  bool sweep_is_new_ = false;
  Walkers walkers_, radar_walkers_;
  Pose2 T_way_robot_;       ///< by the wheels' way and the matched headings
  ScanMemory scan_memory_;  ///< of scans beside a radar
  double smoke_share_ = 0;
  std::optional<Stamp> lidar_stamp_;  ///< of the newest scan
  std::vector<Anchor> anchors_;       ///< one per scan
  std::vector<Pose2> T_track_nodes_;  ///< where the front end put each node
  Pose2 T_odom_robot_;
};

Result<ScanOutcome> Slam::Impl::add_scan(const LaserScan& scan) {
  if (const Result<Ok> sound = check(scan); !sound) {
    ++counters_.malformed;
    return sound.error();
  }
  ++counters_.scans;
  lidar_stamp_ = scan.stamp;
  if (last_stamp_ == scan.stamp && last_ranges_ == scan.ranges_m && !anchors_.empty()) {
    ++counters_.duplicates;
    anchors_.push_back(anchors_.back());
    return ScanOutcome{scan.stamp, ScanFate::kDuplicate, latest(), std::nullopt, 0};
  }
  last_ranges_ = scan.ranges_m;
  begin();
  const PredictedStep step = predict(scan.stamp);
  HitRanges hits(scan, params_.beams);
  ScanOutcome outcome = add_points(scan.stamp, scan.robot, points_of(scan, without_walkers(scan, hits, step)), step);
  walkers_.remember(scan, std::move(hits), T_way_robot_);
  return outcome;
}

Result<ScanOutcome> Slam::Impl::add_sweep(const RadarSweep& sweep) {
  if (const Result<Ok> sound = check(sweep); !sound) {
    ++counters_.malformed;
    return sound.error();
  }
  ++counters_.sweeps;
  if (lidar_stamp_ && to_seconds(sweep.stamp - *lidar_stamp_) < kLidarIsSilent_s) {
    last_sweep_ = sweep;
    sweep_walkers_m_ = walkers_in(sweep, T_way_robot_);
    sweep_is_new_ = true;
    T_odom_sweep_ = odometry_.at(sweep.stamp);
    return ScanOutcome{sweep.stamp, ScanFate::kMatched, latest(), std::nullopt, 0};
  }
  begin();
  const PredictedStep step = predict(sweep.stamp);
  std::vector<double> walkers_m = walkers_in(sweep, T_way_robot_ * step.T_before_now);
  if (is_sparse(step, params_.radar.align.gate_m)) walkers_m.clear();
  return add_points(sweep.stamp, sweep.robot,
                    surface_points(sweep, twist_for_straightening(), params_.radar, params_.points, walkers_m), step);
}

void Slam::Impl::begin() {
  if (front_) return;
  front_.emplace(params_);
  worker_ = std::make_unique<GraphWorker>(params_, work_);
}

/// Who has walked on so far since the scan before misleads no match.
bool Slam::Impl::is_sparse(const PredictedStep& step, double gate_m) const {
  return step.T_before_now.translation().norm() > gate_m ||
         std::abs(step.T_before_now.heading()) > params_.front_end.sparse_step_rad;
}

/// Of each azimuth the range at which somebody may be who walks. The radar's nearest surfaces are a scan, too.
std::vector<double> Slam::Impl::walkers_in(const RadarSweep& sweep, const Pose2& T_way_robot) {
  const LaserScan nearest = nearest_surfaces(sweep, params_.radar);
  HitRanges hits(nearest, {});
  const WalkerView seen = radar_walkers_.look(nearest, hits, T_way_robot);
  std::vector<double> walkers_m(nearest.ranges_m.size(), 0);
  for (std::size_t i = 0; i < walkers_m.size(); ++i)
    if (seen.unproven[i]) walkers_m[i] = hits.at(static_cast<std::ptrdiff_t>(i));
  radar_walkers_.remember(nearest, std::move(hits), T_way_robot);
  return walkers_m;
}

std::vector<BeamUse> Slam::Impl::without_walkers(const LaserScan& scan, const HitRanges& hits,
                                                 const PredictedStep& step) {
  std::vector<BeamUse> uses(scan.ranges_m.size(), BeamUse::kAll);
  if (is_sparse(step, params_.align.gate_m)) return uses;
  const WalkerView seen = walkers_.look(scan, hits, T_way_robot_ * step.T_before_now);
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (seen.unproven[i]) uses[i] = seen.moving[i] ? BeamUse::kNothing : BeamUse::kDrawing;
  counters_.walker_beams += std::count(seen.moving.begin(), seen.moving.end(), true);
  return uses;
}

/// The lidar's points; beams that the newest sweep calls smoke left out. The thicker the smoke, the more the radar's
/// own points count: none in clear air, all there is where the lidar sees nothing. Each sweep is used once.
ScanPoints Slam::Impl::points_of(const LaserScan& scan, std::vector<BeamUse> uses) {
  const Twist2 twist = twist_for_straightening();
  if (!last_sweep_ || std::abs(to_seconds(scan.stamp - last_sweep_->stamp)) > kSweepIsFresh_s)
    return surface_points(scan, params_.beams, twist, params_.points, uses);
  const std::optional<Pose2> T_odom_now = odometry_.at(scan.stamp);
  const Pose2 T_now_then = T_odom_now && T_odom_sweep_ ? T_odom_now->inverse() * *T_odom_sweep_ : Pose2();
  const EarlierScans earlier{T_odom_now ? &scan_memory_ : nullptr, T_odom_now.value_or(Pose2())};
  const SmokeView view = look_for_smoke(scan, params_.beams, *last_sweep_, T_now_then, params_.radar, earlier);
  if (T_odom_now) scan_memory_.remember(scan, params_.beams, *T_odom_now);
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (view.beams[i]) uses[i] = BeamUse::kNothing;
  counters_.smoke_beams += std::count(view.beams.begin(), view.beams.end(), true);
  smoke_share_ += kSmokeMemory * (view.share - smoke_share_);
  counters_.smoke_share = smoke_share_;
  ScanPoints points = surface_points(scan, params_.beams, twist, params_.points, uses);
  const double weight = std::clamp((smoke_share_ - kClearShare) / (kSmokeIsAll - kClearShare), 0.0, 1.0);
  if (!std::exchange(sweep_is_new_, false) || weight <= 0) return points;
  add_radar(points, surface_points(*last_sweep_, twist, params_.radar, params_.points, sweep_walkers_m_), T_now_then,
            weight, params_);
  return points;
}

PredictedStep Slam::Impl::predict(Stamp stamp) {
  const double seconds = last_stamp_ ? to_seconds(stamp - *last_stamp_) : 0;
  if (seconds < 0) ++counters_.stamps_back;
  const std::optional<Pose2> T_odom_now = odometry_.at(stamp);
  const PredictedStep step = predict_step(T_odom_last_, T_odom_now, seconds, twist_, params_.front_end);
  counters_.jumps += step.jumped;
  counters_.without_odometry += last_stamp_ && !T_odom_now;
  T_odom_last_ = T_odom_now;
  if (T_odom_now) T_odom_robot_ = *T_odom_now;
  return step;
}

ScanOutcome Slam::Impl::add_points(Stamp stamp, const std::string& robot, const ScanPoints& points,
                                   const PredictedStep& step) {
  const double seconds = last_stamp_ ? to_seconds(stamp - *last_stamp_) : 0;
  const Pose2 T_track_before = track_pose();
  const FrontEnd::Tracked tracked = front_->track(points, step);
  const Pose2 tracked_step = T_track_before.inverse() * tracked.T_track_robot;
  T_way_robot_ = T_way_robot_ * Pose2(step.by_odometry ? step.T_before_now.translation() : tracked_step.translation(),
                                      tracked_step.heading());
  last_stamp_ = stamp;
  if (tracked.fate == ScanFate::kMatched && seconds > 1e-3) {
    twist_ = smoothed(twist_, twist_of(tracked_step, seconds), seconds);
    if (step.by_odometry) wheel_error_.learn(step.T_before_now, tracked_step, seconds);
  }
  if (tracked.fate == ScanFate::kNewPiece) twist_.reset();  // it led astray
  count(tracked.fate);
  ScanOutcome outcome{stamp, tracked.fate, {}, std::nullopt, tracked.score};
  if (tracked.node) {
    keep_node(stamp, robot, points, tracked);
    outcome.node = graph_.nodes.back().id;
  }
  anchors_.push_back(
      {stamp, tracked.T_track_robot, std::max(0, static_cast<int>(T_track_nodes_.size()) - 1), tracked.covariance});
  outcome.pose = latest();
  return outcome;
}

void Slam::Impl::keep_node(Stamp stamp, const std::string& robot, const ScanPoints& points,
                           const FrontEnd::Tracked& tracked) {
  PoseNode node;
  node.id = static_cast<int>(graph_.nodes.size());
  node.robot = robot;
  node.stamp = stamp;
  node.T_map_robot =
      graph_.nodes.empty() ? params_.T_map_start : graph_.nodes.back().T_map_robot * tracked.T_node_robot;
  node.T_odom_robot = T_odom_robot_;
  node.hits_robot = tracked.hits_robot;
  node.radar_hits_robot = tracked.radar_hits_robot;
  node.free_ends_robot = points.free_ends_robot;
  PoseEdge edge;
  edge.from = node.id - 1;
  edge.to = node.id;
  edge.T_from_to = tracked.T_node_robot;
  edge.kind = tracked.kind;
  Eigen::Matrix3d covariance = 0.5 * (tracked.covariance + tracked.covariance.transpose());
  covariance.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-7);
  if (const auto sqrt_info = sqrt_information(covariance)) edge.sqrt_information = *sqrt_info;
  if (node.id > 0) {
    graph_.edges.insert(graph_.edges.begin() + node.id - 1, edge);
  }
  graph_.nodes.push_back(node);
  worker_->add({std::move(node), points.surface, edge, tracked.fate == ScanFate::kNewPiece, points.by_radar});
  T_track_nodes_.push_back(tracked.T_track_robot);
}

void Slam::Impl::count(ScanFate fate) {
  counters_.too_few_points += fate == ScanFate::kTooFewPoints;
  counters_.poor_matches += fate == ScanFate::kPoorMatch;
  counters_.lost += fate == ScanFate::kNewPiece;
}

/// Nodes the back end has not seen yet follow the last one it has.
bool Slam::Impl::take_over(const GraphUpdate* update) {
  if (!update) return false;
  counters_.loops_tried = update->tried;
  counters_.loops_closed = update->closed;
  counters_.loops_rejected = update->rejected;
  counters_.relocated = update->relocated;
  const std::size_t known = update->T_map_nodes.size();
  std::vector<PoseEdge> edges = update->steps;
  for (std::size_t i = edges.size(); i + 1 < graph_.nodes.size(); ++i) edges.push_back(graph_.edges[i]);
  for (std::size_t i = 0; i < graph_.nodes.size(); ++i)
    graph_.nodes[i].T_map_robot =
        i < known ? update->T_map_nodes[i] : graph_.nodes[i - 1].T_map_robot * edges[i - 1].T_from_to;
  edges.insert(edges.end(), update->links.begin(), update->links.end());
  graph_.edges = std::move(edges);
  return update->moved;
}

/// Between two nodes the correction of each is blended in, so that a scan next to a node moves with it.
Pose2 Slam::Impl::pose_of(const Anchor& anchor) const {
  if (T_track_nodes_.empty()) return params_.T_map_start * anchor.T_track_robot;
  const auto i = static_cast<std::size_t>(anchor.node);
  const Pose2 from_last = graph_.nodes[i].T_map_robot * (T_track_nodes_[i].inverse() * anchor.T_track_robot);
  if (i + 1 >= T_track_nodes_.size()) return from_last;
  const Pose2 from_next = graph_.nodes[i + 1].T_map_robot * (T_track_nodes_[i + 1].inverse() * anchor.T_track_robot);
  const auto away = [&](std::size_t node) {
    const Pose2 step = T_track_nodes_[node].inverse() * anchor.T_track_robot;
    return step.translation().norm() + 0.5 * std::abs(step.heading());
  };
  const double last = away(i), next = away(i + 1);
  return last + next > 0 ? interpolate(from_last, from_next, last / (last + next)) : from_last;
}

Pose2 Slam::Impl::T_map_track() const {
  if (T_track_nodes_.empty()) return params_.T_map_start;
  return graph_.nodes.back().T_map_robot * T_track_nodes_.back().inverse();
}

StampedPose Slam::Impl::latest() const {
  StampedPose pose;
  pose.stamp = last_stamp_.value_or(0);
  pose.T_map_robot = T_map_track() * track_pose();
  if (!anchors_.empty()) pose.covariance = anchors_.back().covariance;
  return pose;
}

Pose2 Slam::Impl::T_map_odom() const {
  return T_odom_last_ ? T_map_track() * track_pose() * T_odom_last_->inverse() : Pose2();
}

Trajectory Slam::Impl::trajectory() const {
  Trajectory poses;
  poses.reserve(anchors_.size());
  for (const Anchor& anchor : anchors_) poses.push_back({anchor.stamp, pose_of(anchor), anchor.covariance});
  return poses;
}

Slam::Slam(const SlamParams& params, GraphWork work) : impl_(std::make_unique<Impl>(params, work)) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

void Slam::add_odometry(const Odometry& odometry) { impl_->add_odometry(odometry); }
Result<ScanOutcome> Slam::add_scan(const LaserScan& scan) { return impl_->add_scan(scan); }
Result<ScanOutcome> Slam::add_sweep(const RadarSweep& sweep) { return impl_->add_sweep(sweep); }

bool Slam::optimize(const Progress& progress) {
  return impl_->worker_ && impl_->take_over(impl_->worker_->catch_up(progress).get());
}
void Slam::polish(const Progress& progress) {
  if (impl_->worker_) impl_->take_over(impl_->worker_->polish(progress).get());
}

StampedPose Slam::latest_pose() const { return impl_->latest(); }
Pose2 Slam::T_map_odom() const { return impl_->T_map_odom(); }
const PoseGraph& Slam::graph() const { return impl_->graph_; }
Trajectory Slam::trajectory() const { return impl_->trajectory(); }
const SlamCounters& Slam::counters() const { return impl_->counters_; }

}  // namespace smokemap
