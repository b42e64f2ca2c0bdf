#include "slam/loop_closer.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/panorama.hpp"
#include "slam/pose_search.hpp"

namespace smokemap {
namespace {

constexpr double kTargetHalfSize_m = 25.0;
constexpr double kTargetWay_m = 4.0;    ///< each way along the old visit ...
constexpr double kTargetReach_m = 5.0;  ///< ... and as the crow flies; both and the radius of the search
constexpr std::size_t kMostCandidates = 2;
constexpr double kAgree_m = 0.20;
constexpr double kAgree_rad = 0.035;
constexpr double kSigmaLoop_m = 0.03, kSigmaLoop_rad = 0.006;
constexpr int kVisitNodes = 12;  ///< of the newer visit whose rays are compared with the older one
constexpr int kRayNodesEvery = 2;
constexpr double kRayMargin_m = 0.3;
constexpr int kLeastTelling = 20;
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

/// Along which positions are measured least: along a corridor.
Point2 weakest_direction(const Eigen::Matrix3d& information) {
  const double half_gap = 0.5 * (information(0, 0) - information(1, 1));
  const double strong = 0.5 * std::atan2(information(0, 1), half_gap);
  return {-std::sin(strong), std::cos(strong)};
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

LoopCloser::Found LoopCloser::close(const PoseGraph& graph, const NodeScans& scans, int node, int piece_begin) {
  piece_begin_ = piece_begin;
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
  const double sigmas = sigmas_of(graph.nodes[index(node)].T_map_robot, fine.T_map_robot, candidate.covariance);
  if (sigmas > limits.within_sigmas || !holds_up(graph, scans, node, fine, sigmas)) return false;
  const auto edge = verified(graph, scans, node, candidate.node, fine);
  if (!edge) return false;
  --found.rejected;
  found.edges.push_back(*edge);
  return true;
}

/// The farther a loop would move the graph, the less there must be to say against it. Along a corridor nearly all rays
/// agree wherever one stands: there only those count that end on door frames, pillars and far walls.
bool LoopCloser::holds_up(const PoseGraph& graph, const NodeScans& scans, int node, const ScanAlignment& fine,
                          double sigmas) const {
  const LoopParams& limits = params_.loops;
  const bool bold = sigmas > limits.bold_sigmas;
  if (bold && fine.score < limits.least_align_score + limits.bold_score_more) return false;
  if (as_radar_) return true;  // it sees through thin walls: rays prove nothing
  const Rays rays = rays_between(graph, scans, node, fine);
  if (bold)
    return rays.telling >= kLeastTelling && rays.through <= limits.most_through_bold * (rays.telling + rays.through);
  return rays.through <= limits.most_through * (rays.agree + rays.through);
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
  piece_begin_ = piece_begin;
  const std::vector<SurfacePoint> joint = joint_scan(graph, scans, node, kWideJoint);
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
  const ScanAlignment fine = align(joint, target_, best->found.T_map_robot, params_.align);
  if (!holds_up(graph, scans, node, fine, std::numeric_limits<double>::infinity())) return std::nullopt;
  return verified(graph, scans, node, best->around, fine);
}

/// Everything seen around a node before the node `end`.
void LoopCloser::draw_region(const PoseGraph& graph, const NodeScans& scans, int around, int end) {
  const Point2 middle = graph.nodes[index(around)].T_map_robot.translation();
  target_.reset(middle, kTargetHalfSize_m);
  target_nodes_.clear();
  for (int j = 0; j < end; ++j) {
    if ((graph.nodes[index(j)].T_map_robot.translation() - middle).norm() >= 1.5 * kRegion_m) continue;
    target_.add(scans.surface(j), graph.nodes[index(j)].T_map_robot);
    target_nodes_.push_back(j);
  }
}

LikelihoodGrid LoopCloser::target_grid() const {
  std::vector<Point2> known;
  target_.for_each([&](const SurfaceMap::Surface& s) { known.push_back(s.p); });
  return {known, params_.loops.cell_m, 1.2 * params_.loops.cell_m, kSearchLevels};
}

/// The old visit: nodes driven before and after `around`, never near `node` itself; as much of it as the window may
/// lead to. A shorter piece would leave out the true place where the window is wide, and another that is like it would
/// be alone.
void LoopCloser::draw_target(const PoseGraph& graph, const NodeScans& scans, int node, int around, double radius_m) {
  const Point2 middle = graph.nodes[index(around)].T_map_robot.translation();
  target_.reset(middle, std::min(60.0, kTargetHalfSize_m + radius_m));
  target_nodes_.clear();
  for (int j = 0; j < node; ++j) {
    if (std::abs(scans.way_m(j) - scans.way_m(around)) > kTargetWay_m + radius_m) continue;
    if ((graph.nodes[index(j)].T_map_robot.translation() - middle).norm() > kTargetReach_m + radius_m) continue;
    if (scans.way_m(node) - scans.way_m(j) < 0.5 * params_.loops.least_way_m) continue;
    target_.add(scans.surface(j), graph.nodes[index(j)].T_map_robot);
    target_nodes_.push_back(j);
  }
}

std::vector<SurfacePoint> LoopCloser::joint_scan(const PoseGraph& graph, const NodeScans& scans, int node,
                                                 int count) const {
  std::vector<SurfacePoint> joint;
  const Pose2 T_node_map = graph.nodes[index(node)].T_map_robot.inverse();
  for (int i = node; i >= std::max(piece_begin_, node - count + 1); --i) {
    const Pose2 T_node_i = T_node_map * graph.nodes[index(i)].T_map_robot;
    const Eigen::Matrix2d R = T_node_i.rotation();
    for (const SurfacePoint& s : scans.surface(i)) joint.push_back({T_node_i * s.p, R * s.normal, s.weight});
  }
  return joint;
}

LoopCloser::Rays LoopCloser::rays_between(const PoseGraph& graph, const NodeScans& scans, int node,
                                          const ScanAlignment& fine) const {
  Rays rays;
  const Pose2& T_map_node = fine.T_map_robot;
  const Point2 weak = weakest_direction(fine.information);
  const auto compare = [&](const SurfaceMap& surfaces, int from, const Pose2& T_map_from) {
    Panorama panorama(T_map_from.translation(), kRayMargin_m);
    surfaces.for_each([&](const SurfaceMap::Surface& s) { panorama.add(s.p, s.normal); });
    for (const SurfacePoint& point : scans.surface(from)) {
      Point2 normal = Point2::Zero();
      const Panorama::Sight sight = panorama.look(T_map_from * point.p, normal);
      rays.telling += std::abs(normal.dot(weak)) > 0.5;
      rays.agree += sight == Panorama::Sight::kAgrees;
      rays.through += sight == Panorama::Sight::kThrough;
    }
  };
  const Pose2 T_new_old = T_map_node * graph.nodes[index(node)].T_map_robot.inverse();
  SurfaceMap visit(params_.front_end.cell_m);
  visit.reset(T_map_node.translation(), kTargetHalfSize_m);
  for (int i = node; i >= std::max(piece_begin_, node - kVisitNodes + 1); --i) {
    const Pose2 T_map_i = T_new_old * graph.nodes[index(i)].T_map_robot;
    visit.add(scans.surface(i), T_map_i);
    if ((node - i) % kRayNodesEvery == 0) compare(target_, i, T_map_i);
  }
  for (std::size_t k = 0; k < target_nodes_.size(); k += kRayNodesEvery)
    compare(visit, target_nodes_[k], graph.nodes[index(target_nodes_[k])].T_map_robot);
  return rays;
}

bool LoopCloser::singles_agree(const PoseGraph& graph, const NodeScans& scans, int node,
                               const Pose2& T_map_node) const {
  int agree = 0, asked = 0;
  for (int i = node; i >= std::max(piece_begin_, node - params_.loops.joint_nodes + 1); i -= 2) {
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
