#include "slam/pair_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "slam/align.hpp"

namespace smokemap {
namespace {

constexpr double kTargetHalf_m = 20.0;
constexpr double kGate_m = 0.25;
constexpr double kLargestCorrection_m = 0.30;
constexpr double kLargestCorrection_rad = 0.09;
constexpr double kSigmaPair_m = 0.004, kSigmaPair_rad = 0.001;
constexpr int kRecentNodes = 20;
constexpr int kApartNodes = 3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Pairs are nearly right already.
AlignParams gentle(const SlamParams& params) {
  AlignParams align = params.align;
  align.gate_m = kGate_m;
  return align;
}

}  // namespace

PairMatcher::PairMatcher(const SlamParams& params)
    : params_(params),
      by_lidar_{gentle(params), params.graph.least_pair_score, SurfaceMap(params.front_end.cell_m)},
      by_radar_{gentle(params.for_radar()), params.radar.least_pair_score, SurfaceMap(params.radar.cell_m)} {}

/// Nearest first, in position and heading; neighbours of a chosen one add little and are passed over.
std::vector<int> PairMatcher::partners(const PoseGraph& graph, const NodeScans& scans, int node) const {
  const Pose2& here = graph.nodes[at(node)].T_map_robot;
  std::vector<std::pair<double, int>> near;
  for (int j = 0; j < node; ++j) {
    const Pose2& there = graph.nodes[at(j)].T_map_robot;
    const double away = (there.translation() - here.translation()).norm();
    if (away > params_.graph.pair_reach_m || scans.empty(j)) continue;
    near.emplace_back(away + 1.0 * std::abs(wrap_angle(there.heading() - here.heading())), j);
  }
  std::sort(near.begin(), near.end());
  std::vector<int> chosen;
  int recent = 0;
  for (const auto& [cost, j] : near) {
    const bool is_recent = node - j <= kRecentNodes;
    if (is_recent && recent >= params_.graph.pairs_per_node / 2) continue;
    const bool crowded = std::any_of(chosen.begin(), chosen.end(), [&, j = j](int other) {
      return node - j > kApartNodes && std::abs(other - j) < kApartNodes;
    });
    if (crowded) continue;
    chosen.push_back(j);
    recent += is_recent;
    if (chosen.size() == at(params_.graph.pairs_per_node)) break;
  }
  return chosen;
}

std::vector<PoseEdge> PairMatcher::match(const PoseGraph& graph, const NodeScans& scans, int first_node,
                                         const Progress& progress) {
  const int count = static_cast<int>(graph.nodes.size());
  std::vector<std::vector<int>> sources(graph.nodes.size());  // by target: each target's map is made once
  for (int i = std::max(1, first_node); i < count; ++i)
    for (const int j : partners(graph, scans, i)) sources[at(j)].push_back(i);
  std::vector<PoseEdge> edges;
  std::vector<int> lidar, radar;
  for (int j = 0; j < count && !progress.cancelled(); ++j) {
    lidar.clear();
    radar.clear();
    for (const int i : sources[at(j)]) (scans.either_by_radar(i, j) ? radar : lidar).push_back(i);
    match_target(graph, scans, j, lidar, by_lidar_, edges);
    match_target(graph, scans, j, radar, by_radar_, edges);
  }
  return edges;
}

void PairMatcher::match_target(const PoseGraph& graph, const NodeScans& scans, int target,
                               const std::vector<int>& sources, Matching& matching,
                               std::vector<PoseEdge>& edges) const {
  if (sources.empty()) return;
  const Pose2& T_map_target = graph.nodes[at(target)].T_map_robot;
  matching.target.reset(T_map_target.translation(), kTargetHalf_m);
  matching.target.add(scans.surface(target), T_map_target);
  for (const int i : sources) {
    const Pose2& guess = graph.nodes[at(i)].T_map_robot;
    const PosePrior prior{guess, Eigen::Vector3d(100, 100, 400).asDiagonal()};
    const ScanAlignment found = align(scans.surface(i), matching.target, guess, matching.align, prior);
    const Pose2 moved = guess.inverse() * found.T_map_robot;
    if (found.score < matching.least_score || moved.translation().norm() > kLargestCorrection_m ||
        std::abs(moved.heading()) > kLargestCorrection_rad)
      continue;
    const auto sqrt_info = edge_sqrt_information(params_.graph.pair_information * found.information,
                                                 T_map_target.heading(), kSigmaPair_m, kSigmaPair_rad);
    if (sqrt_info)
      edges.push_back(
          {target, i, T_map_target.inverse() * found.T_map_robot, *sqrt_info, EdgeKind::kMatched, LinkState::kKept});
  }
}

}  // namespace smokemap
