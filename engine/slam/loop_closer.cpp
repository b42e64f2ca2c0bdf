#include "slam/loop_closer.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slam/pose_search.hpp"

namespace smokemap {
namespace {

constexpr double kTargetHalfSize_m = 25.0;
constexpr int kTargetNodes = 12;  ///< each way along the old visit
constexpr double kTargetReach_m = 5.0;
constexpr std::size_t kMostCandidates = 2;
constexpr double kAgree_m = 0.20;
constexpr double kAgree_rad = 0.035;
constexpr double kSigmaLoop_m = 0.03, kSigmaLoop_rad = 0.006;
constexpr std::size_t kSearchPoints = 200;
constexpr int kSearchLevels = 6;
constexpr double kRegion_m = 4.0;      ///< between the middles of regions that are searched as a whole
constexpr double kWideReach_m = 8.0;   ///< points farther away need finer angles
constexpr int kWideJoint = 8;          ///< nodes that look for their place together
constexpr double kAloneWithin = 0.85;  ///< a second place this good: nothing is said

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Points for a search: near ones, an even share of them.
std::vector<Point2> thinned(const std::vector<SurfacePoint>& joint, double reach_m) {
  std::vector<Point2> points;
  const std::size_t stride = std::max<std::size_t>(1, joint.size() / kSearchPoints);
  for (std::size_t i = 0; i < joint.size(); i += stride)
    if (joint[i].p.norm() < reach_m) points.push_back(joint[i].p);
  return points;
}

/// Along the longest axis of the ellipse of positions.
double largest_sigma_m(const Eigen::Matrix3d& covariance) {
  const double half_gap = std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  return std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)) + half_gap);
}

/// How many standard deviations a correction of a node's pose is.
double sigmas_of(const Pose2& T_map_before, const Pose2& T_map_after, const Eigen::Matrix3d& covariance) {
  Eigen::Vector3d moved = T_map_after.vector() - T_map_before.vector();
  moved.z() = wrap_angle(moved.z());
  return std::sqrt(std::max(0.0, moved.dot(covariance.ldlt().solve(moved))));
}

}  // namespace

LoopCloser::LoopCloser(const SlamParams& params)
    : by_lidar_(params), by_radar_(params.for_radar()), params_(params), target_(params.front_end.cell_m) {}

void LoopCloser::match_as(bool radar) {
  if (radar == as_radar_) return;
  as_radar_ = radar;
  params_ = radar ? by_radar_ : by_lidar_;
  target_ = SurfaceMap(params_.front_end.cell_m);
}

LoopCloser::Found LoopCloser::close(const PoseGraph& graph, const NodeScans& scans, int node) {
  Found found;
  for (const Candidate& candidate : candidates(graph, scans, node)) {
    ++found.tried;
    if (try_candidate(graph, scans, node, candidate, found)) break;
  }
  return found;
}

/// Nearest old visits first, measured in radii; one candidate per visit.
std::vector<LoopCloser::Candidate> LoopCloser::candidates(const PoseGraph& graph, const NodeScans& scans,
                                                          int node) const {
  const LoopParams& limits = params_.loops;
  const std::vector<GraphDistance> distance = graph_distances(graph, scans, node, 1.0);
  const Point2 here = graph.nodes[index(node)].T_map_robot.translation();
  std::vector<std::pair<double, Candidate>> near;
  for (int j = 0; j < node; ++j) {
    const double way = std::min(distance[index(j)].way_m, scans.way_m(node) - scans.way_m(j));
    if (way < limits.least_way_m) continue;
    Candidate candidate{j, 0, 0, distance[index(j)].covariance_at(here)};
    const double sigma_m = limits.sigma_base_m + limits.drift_share * way, sigma_rad = limits.sigma_base_rad;
    candidate.covariance.diagonal() += Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
    candidate.radius_m = std::min(limits.search_most_m, limits.within_sigmas * largest_sigma_m(candidate.covariance));
    candidate.half_rad = std::min(limits.search_rad, limits.within_sigmas * std::sqrt(candidate.covariance(2, 2)));
    const double away = (graph.nodes[index(j)].T_map_robot.translation() - here).norm();
    if (away > candidate.radius_m + 2.0) continue;
    near.emplace_back(away / (candidate.radius_m + 2.0), candidate);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Candidate> chosen;
  for (const auto& [share, candidate] : near) {
    const bool same_visit = std::any_of(chosen.begin(), chosen.end(), [&, j = candidate.node](const Candidate& other) {
      return std::abs(scans.way_m(other.node) - scans.way_m(j)) < 2 * limits.least_way_m;
    });
    if (!same_visit) chosen.push_back(candidate);
    if (chosen.size() == kMostCandidates) break;
  }
  return chosen;
}

bool LoopCloser::try_candidate(const PoseGraph& graph, const NodeScans& scans, int node, const Candidate& candidate,
                               Found& found) {
  match_as(scans.either_by_radar(node, candidate.node));
  const LoopParams& limits = params_.loops;
  draw_target(graph, scans, node, candidate.node, candidate.radius_m);
  const std::vector<SurfacePoint> joint = joint_scan(graph, scans, node, limits.joint_nodes);
  if (joint.size() < index(params_.points.least_points) || target_.empty()) return false;
  const SearchWindow window{graph.nodes[index(node)].T_map_robot, candidate.radius_m, candidate.half_rad};
  const auto coarse = search_pose(thinned(joint, 1e9), target_grid(), window, limits.least_search_score, 0.6);
  if (!coarse) return false;

  ++found.rejected;  // until it has passed everything
  if (coarse->runner_up_score > limits.unique_within * coarse->score) return false;
  const ScanAlignment fine = align(joint, target_, coarse->T_map_robot, params_.align);
  if (sigmas_of(graph.nodes[index(node)].T_map_robot, fine.T_map_robot, candidate.covariance) > limits.within_sigmas)
    return false;
  const auto edge = verified(graph, scans, node, candidate.node, fine);
  if (!edge) return false;
  --found.rejected;
  found.edges.push_back(*edge);
  return true;
}

/// The edge from an old node, if the group of nodes and each of its scans alone say the same.
std::optional<PoseEdge> LoopCloser::verified(const PoseGraph& graph, const NodeScans& scans, int node, int around,
                                             const ScanAlignment& fine) const {
  if (fine.score < params_.loops.least_align_score || !singles_agree(graph, scans, node, fine.T_map_robot))
    return std::nullopt;
  const Pose2& T_map_old = graph.nodes[index(around)].T_map_robot;
  const auto sqrt_info = edge_sqrt_information(params_.graph.pair_information * fine.information, T_map_old.heading(),
                                               kSigmaLoop_m, kSigmaLoop_rad);
  if (!sqrt_info) return std::nullopt;
  return PoseEdge{around, node, T_map_old.inverse() * fine.T_map_robot, *sqrt_info, EdgeKind::kLoop, LinkState::kKept};
}

std::optional<PoseEdge> LoopCloser::find_anywhere(const PoseGraph& graph, const NodeScans& scans, int node,
                                                  int piece_begin) {
  const std::vector<SurfacePoint> joint = joint_scan(graph, scans, node, std::min(kWideJoint, node - piece_begin + 1));
  const std::vector<Point2> points = thinned(joint, kWideReach_m);
  if (points.size() < index(params_.points.least_points)) return std::nullopt;
  std::vector<Point2> centers;
  struct Place {
    int around;
    SearchResult found;
  };
  std::vector<Place> places;
  for (int j = 0; j < piece_begin; ++j) {
    const Point2 here = graph.nodes[index(j)].T_map_robot.translation();
    if (std::any_of(centers.begin(), centers.end(), [&](const Point2& c) { return (c - here).norm() < kRegion_m; }))
      continue;
    centers.push_back(here);
    match_as(scans.either_by_radar(node, j));
    draw_region(graph, scans, j, piece_begin);
    if (target_.empty()) continue;
    const SearchWindow window{Pose2(here, 0), 0.75 * kRegion_m, kPi};
    if (const auto found = search_pose(points, target_grid(), window, params_.loops.least_search_score, 0.6))
      places.push_back({j, *found});
  }
  const auto best = std::max_element(places.begin(), places.end(),
                                     [](const Place& a, const Place& b) { return a.found.score < b.found.score; });
  if (best == places.end()) return std::nullopt;
  double second = best->found.runner_up_score;
  for (const Place& other : places) {
    const Pose2 apart = best->found.T_map_robot.inverse() * other.found.T_map_robot;
    if (apart.translation().norm() > 0.6 || std::abs(apart.heading()) > 0.3)
      second = std::max(second, other.found.score);
  }
  if (second > kAloneWithin * best->found.score) return std::nullopt;
  match_as(scans.either_by_radar(node, best->around));
  draw_region(graph, scans, best->around, piece_begin);
  return verified(graph, scans, node, best->around, align(joint, target_, best->found.T_map_robot, params_.align));
}

/// Everything seen around a node before the node `end`.
void LoopCloser::draw_region(const PoseGraph& graph, const NodeScans& scans, int around, int end) {
  const Point2 middle = graph.nodes[index(around)].T_map_robot.translation();
  target_.reset(middle, kTargetHalfSize_m);
  for (int j = 0; j < end; ++j)
    if ((graph.nodes[index(j)].T_map_robot.translation() - middle).norm() < 1.5 * kRegion_m)
      target_.add(scans.surface(j), graph.nodes[index(j)].T_map_robot);
}

LikelihoodGrid LoopCloser::target_grid() const {
  std::vector<Point2> known;
  target_.for_each([&](const SurfaceMap::Surface& s) { known.push_back(s.p); });
  return {known, params_.loops.cell_m, 1.2 * params_.loops.cell_m, kSearchLevels};
}

/// The old visit: nodes driven just before and after `around`, never near `node` itself.
void LoopCloser::draw_target(const PoseGraph& graph, const NodeScans& scans, int node, int around, double radius_m) {
  const Point2 middle = graph.nodes[index(around)].T_map_robot.translation();
  target_.reset(middle, std::min(60.0, kTargetHalfSize_m + radius_m));
  const int last = std::min(around + kTargetNodes, node - 1);
  for (int j = std::max(0, around - kTargetNodes); j <= last; ++j) {
    if ((graph.nodes[index(j)].T_map_robot.translation() - middle).norm() > kTargetReach_m) continue;
    if (scans.way_m(node) - scans.way_m(j) < 0.5 * params_.loops.least_way_m) continue;
    target_.add(scans.surface(j), graph.nodes[index(j)].T_map_robot);
  }
}

std::vector<SurfacePoint> LoopCloser::joint_scan(const PoseGraph& graph, const NodeScans& scans, int node,
                                                 int count) const {
  std::vector<SurfacePoint> joint;
  const Pose2 T_node_map = graph.nodes[index(node)].T_map_robot.inverse();
  for (int i = node; i > std::max(-1, node - count); --i) {
    const Pose2 T_node_i = T_node_map * graph.nodes[index(i)].T_map_robot;
    const Eigen::Matrix2d R = T_node_i.rotation();
    for (const SurfacePoint& s : scans.surface(i)) joint.push_back({T_node_i * s.p, R * s.normal, s.weight});
  }
  return joint;
}

bool LoopCloser::singles_agree(const PoseGraph& graph, const NodeScans& scans, int node,
                               const Pose2& T_map_node) const {
  int agree = 0, asked = 0;
  for (int i = node; i > std::max(-1, node - params_.loops.joint_nodes); i -= 2) {
    const Pose2 expected =
        T_map_node * (graph.nodes[index(node)].T_map_robot.inverse() * graph.nodes[index(i)].T_map_robot);
    const ScanAlignment alone = align(scans.surface(i), target_, expected, params_.align);
    const Pose2 off = expected.inverse() * alone.T_map_robot;
    // Along a corridor a single scan may slide: only what its points measure can disagree.
    Eigen::Vector3d error = (alone.T_map_robot.vector() - expected.vector());
    error.z() = wrap_angle(error.z());
    const double pull = std::sqrt(std::max(0.0, error.dot(alone.information * error)) / std::max(1, alone.matched)) *
                        params_.align.sigma_point_m;
    ++asked;
    agree += alone.score >= 0.8 * params_.loops.least_align_score && pull < 0.5 * kAgree_m &&
             off.translation().norm() < 2 * kAgree_m && std::abs(off.heading()) < kAgree_rad;
  }
  return agree == asked;
}

}  // namespace smokemap
