#include "slam/front_end.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "slam/pose_search.hpp"

namespace smokemap {
namespace {

constexpr double kMapHalfSize_m = 40.0;
constexpr int kRebuildEveryNodes = 10;
constexpr double kScoreMemory = 0.1;  ///< share of the newest score in the usual one
constexpr double kUsualShare = 0.6;
constexpr double kScoreGain = 0.02;  ///< by how much a place that was searched for has to fit better ...
/// ... and, where the place next to the prediction fits well, by how much for every squared sigma that it is less
/// likely than that: one in ten of 180 points tells something of its own (GraphParams::pair_information), two nats
/// each. Without it a scan that looks ahead slips back along a corridor, to where more of it is on the map. Where
/// nothing near the prediction fits, the wheels were wrong, and their errors have heavy tails.
constexpr double kScorePerSquaredSigma = 1.0 / 72;

Eigen::Matrix3d spread(const PredictedStep& step) {
  return Eigen::Vector3d(step.sigma_m * step.sigma_m, step.sigma_m * step.sigma_m, step.sigma_rad * step.sigma_rad)
      .asDiagonal();
}

double squared_sigmas(const Pose2& T_map_robot, const PosePrior& prior) {
  Eigen::Vector3d away = T_map_robot.vector() - prior.T_map_robot.vector();
  away.z() = wrap_angle(away.z());
  return away.dot(prior.information * away);
}

}  // namespace

FrontEnd::FrontEnd(const SlamParams& params)
    : by_lidar_(params), by_radar_(params.for_radar()), params_(params), map_(params.front_end.cell_m) {}

/// The local map is made anew with the cells of the sensor that is to be matched.
void FrontEnd::match_as(bool radar) {
  if (radar == as_radar_) return;
  as_radar_ = radar;
  params_ = radar ? by_radar_ : by_lidar_;
  usual_score_ = 0;  // scores of the two do not compare
  map_ = SurfaceMap(params_.front_end.cell_m);
  if (started_) rebuild_map();
}

FrontEnd::Tracked FrontEnd::track(const ScanPoints& points, const PredictedStep& step) {
  match_as(points.by_radar);
  const bool too_few = points.surface.size() < static_cast<std::size_t>(params_.points.least_points);
  if (!started_) return too_few ? answer(ScanFate::kTooFewPoints, 0) : begin_piece(points, ScanFate::kFirst);

  const Pose2 predicted = T_track_robot_ * step.T_before_now;
  blind_covariance_ += spread(step);
  predicted_covariance_ += spread(step);
  if (too_few) {
    T_track_robot_ = predicted;
    return answer(ScanFate::kTooFewPoints, 0);
  }
  const ScanAlignment found = match(points.surface, predicted, step);
  if (!believable(found, predicted, step)) return go_on_blindly(points, predicted, step, found.score);
  poor_in_a_row_ = 0;
  usual_score_ += kScoreMemory * (found.score - usual_score_);
  T_track_robot_ = found.T_map_robot;
  blind_covariance_ = match_covariance(found);
  Tracked tracked = answer(ScanFate::kMatched, found.score);
  if (far_from_last_node()) keep(points, tracked);
  return tracked;
}

/// A score as good as usual is proof; a fair one, as when most of the scan looks into a new room, is believed where the
/// prediction agrees.
bool FrontEnd::believable(const ScanAlignment& found, const Pose2& predicted, const PredictedStep& step) const {
  if (found.score >= std::max(params_.front_end.least_score, kUsualShare * usual_score_)) return true;
  if (!step.by_odometry) return false;  // agreeing with a guess would mean nothing
  const Pose2 moved = predicted.inverse() * found.T_map_robot;
  return found.score >= params_.front_end.fair_score && moved.translation().norm() < 3 * step.sigma_m &&
         std::abs(moved.heading()) < 3 * step.sigma_rad;
}

/// The prediction stands. Odometry carries nodes over a while of this; after that the old map is given up.
FrontEnd::Tracked FrontEnd::go_on_blindly(const ScanPoints& points, const Pose2& predicted, const PredictedStep& step,
                                          double score) {
  T_track_robot_ = predicted;
  if (++poor_in_a_row_ >= params_.front_end.lost_after_scans) return begin_piece(points, ScanFate::kNewPiece);
  Tracked tracked = answer(ScanFate::kPoorMatch, score);
  if (step.by_odometry && far_from_last_node()) {
    tracked.kind = EdgeKind::kOdometry;
    keep(points, tracked);
  }
  return tracked;
}

ScanAlignment FrontEnd::match(const std::vector<SurfacePoint>& surface, const Pose2& predicted,
                              const PredictedStep& step) {
  PosePrior prior{predicted, Eigen::Matrix3d::Zero()};
  prior.information.diagonal() << 1 / (step.sigma_m * step.sigma_m), 1 / (step.sigma_m * step.sigma_m),
      1 / (step.sigma_rad * step.sigma_rad);
  const ScanAlignment refined = align(surface, map_, predicted, params_.align, prior);
  return search_needed(step, refined.score) ? search(surface, prior, step, refined) : refined;
}

bool FrontEnd::search_needed(const PredictedStep& step, double score) const {
  const FrontEndParams& limits = params_.front_end;
  return score < limits.good_score || step.jumped || step.T_before_now.translation().norm() > limits.sparse_step_m ||
         std::abs(step.T_before_now.heading()) > limits.sparse_step_rad;
}

/// Looks for a better start than the prediction, refines from there, and keeps the better of both.
ScanAlignment FrontEnd::search(const std::vector<SurfacePoint>& surface, const PosePrior& prior,
                               const PredictedStep& step, const ScanAlignment& so_far) {
  std::vector<Point2> known, points;
  map_.for_each([&](const SurfaceMap::Surface& s) {
    if ((s.p - prior.T_map_robot.translation()).norm() < params_.points.farthest_m) known.push_back(s.p);
  });
  if (known.empty()) return so_far;
  for (const SurfacePoint& point : surface) points.push_back(point.p);
  const LikelihoodGrid grid(known, 0.1, 0.1, 3);
  const SearchWindow window{prior.T_map_robot, std::max(params_.front_end.search_m, std::min(1.5, 2.5 * step.sigma_m)),
                            std::max(params_.front_end.search_rad, std::min(1.0, 2.5 * step.sigma_rad))};
  const auto found = search_pose(points, grid, window, 0.25);
  if (!found) return so_far;
  PosePrior loose = prior;
  loose.information *= 0.25;
  const ScanAlignment refined = align(surface, map_, found->T_map_robot, params_.align, loose);
  double gain = kScoreGain;
  if (so_far.score >= params_.front_end.good_score)
    gain += kScorePerSquaredSigma *
            std::max(0.0, squared_sigmas(refined.T_map_robot, prior) - squared_sigmas(so_far.T_map_robot, prior));
  return refined.score > so_far.score + gain ? refined : so_far;
}

bool FrontEnd::far_from_last_node() const {
  const Pose2 moved = nodes_.back().T_track_node.inverse() * T_track_robot_;
  return moved.translation().norm() >= params_.front_end.node_every_m ||
         std::abs(moved.heading()) >= params_.front_end.node_every_rad;
}

void FrontEnd::keep(const ScanPoints& points, Tracked& tracked) {
  tracked.node = true;
  tracked.hits_robot = points.by_radar ? lasting(points.hits_robot) : points.hits_robot;
  tracked.radar_hits_robot = lasting(points.radar_hits_robot);
  nodes_.push_back({T_track_robot_, points.surface, points.by_radar});
  while (nodes_.size() > static_cast<std::size_t>(params_.front_end.map_nodes)) nodes_.pop_front();
  blind_covariance_.setZero();
  predicted_covariance_.setZero();
  if (++nodes_since_rebuild_ >= kRebuildEveryNodes || !map_.covers(T_track_robot_.translation(), 0.7 * kMapHalfSize_m))
    rebuild_map();
  else
    add_to_map(nodes_.back());
}

void FrontEnd::rebuild_map() {
  nodes_since_rebuild_ = 0;
  map_.reset(T_track_robot_.translation(), kMapHalfSize_m);
  for (const Node& node : nodes_)
    if ((node.T_track_node.translation() - T_track_robot_.translation()).norm() <= params_.front_end.map_reach_m)
      add_to_map(node);
}

/// Beside a lidar's points a radar's count as much as they are exact.
void FrontEnd::add_to_map(const Node& node) {
  if (!node.by_radar || as_radar_) return map_.add(node.surface, node.T_track_node);
  const double exactness = by_lidar_.align.sigma_point_m / by_radar_.align.sigma_point_m;
  std::vector<SurfacePoint> light = node.surface;
  for (SurfacePoint& point : light) point.weight *= exactness * exactness;
  map_.add(light, node.T_track_node);
}

/// Ghosts of multi-path do not stay in place: an echo is drawn once the local map, seen from elsewhere, has a surface
/// there. The first node knows no other place and draws nothing.
std::shared_ptr<const std::vector<Point2>> FrontEnd::lasting(
    const std::shared_ptr<const std::vector<Point2>>& hits) const {
  if (!hits) return nullptr;
  std::vector<Point2> kept;
  SurfaceMap::Surface surface;
  for (const Point2& p : *hits)
    if (map_.nearest(T_track_robot_ * p, Point2::Zero(), by_radar_.radar.lasting_within_m, -1, surface))
      kept.push_back(p);
  return std::make_shared<const std::vector<Point2>>(std::move(kept));
}

FrontEnd::Tracked FrontEnd::begin_piece(const ScanPoints& points, ScanFate fate) {
  Tracked tracked = answer(fate, 0);
  tracked.kind = EdgeKind::kOdometry;
  started_ = true;
  poor_in_a_row_ = 0;
  nodes_.clear();
  map_.reset(T_track_robot_.translation(), kMapHalfSize_m);
  keep(points, tracked);
  rebuild_map();
  return tracked;
}

/// The way since the last node as predicted, and the match. Where a corridor says nothing along itself the first
/// decides.
Eigen::Matrix3d FrontEnd::match_covariance(const ScanAlignment& alignment) const {
  const Eigen::Matrix3d information =
      params_.graph.pair_information * alignment.information + Eigen::Matrix3d(predicted_covariance_.inverse());
  return information.inverse();
}

FrontEnd::Tracked FrontEnd::answer(ScanFate fate, double score) const {
  Tracked tracked;
  tracked.fate = fate;
  tracked.score = score;
  tracked.T_track_robot = T_track_robot_;
  if (nodes_.empty()) return tracked;
  const Pose2& T_track_node = nodes_.back().T_track_node;
  tracked.T_node_robot = T_track_node.inverse() * T_track_robot_;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = T_track_node.rotation().transpose();
  tracked.covariance = turn * blind_covariance_ * turn.transpose();
  return tracked;
}

}  // namespace smokemap
