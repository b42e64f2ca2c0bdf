#include "slam/loop_probation.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kSharesNone_m = 2.0;    ///< way between two finds that share no scans ...
constexpr double kSameVisit_m = 15.0;    ///< ... and between finds of which drift leaves a common gap
constexpr double kGapAgrees_m = 0.30;    ///< between the gaps that two loops close ...
constexpr double kGapAgrees_rad = 0.05;  ///< ... and this much more for every metre between them
constexpr double kGapDrift = 0.02;

const Pose2& pose(const PoseGraph& graph, int node) { return graph.nodes[static_cast<std::size_t>(node)].T_map_robot; }

/// By which a loop would move the newer visit, in the map frame.
Pose2 correction(const PoseGraph& graph, const PoseEdge& loop) {
  return pose(graph, loop.from) * loop.T_from_to * pose(graph, loop.to).inverse();
}

double shift_m(const PoseGraph& graph, const PoseEdge& loop) {
  return ((pose(graph, loop.from) * loop.T_from_to).translation() - pose(graph, loop.to).translation()).norm();
}

}  // namespace

std::vector<PoseEdge> LoopProbation::admit(const PoseGraph& graph, const NodeScans& scans,
                                           const std::vector<PoseEdge>& found) {
  std::vector<PoseEdge> believed;
  waiting_.insert(waiting_.end(), found.begin(), found.end());
  std::vector<bool> borne_out(waiting_.size());
  for (std::size_t i = 0; i < waiting_.size(); ++i)
    borne_out[i] = is_small(graph, waiting_[i]) ||
                   std::any_of(waiting_.begin(), waiting_.end(),
                               [&, i](const PoseEdge& other) { return bear_out(graph, scans, waiting_[i], other); });
  std::vector<PoseEdge> still;
  for (std::size_t i = 0; i < waiting_.size(); ++i) (borne_out[i] ? believed : still).push_back(waiting_[i]);
  waiting_ = std::move(still);
  return believed;
}

bool LoopProbation::is_small(const PoseGraph& graph, const PoseEdge& loop) const {
  return shift_m(graph, loop) < params_.alike_apart_m;
}

bool LoopProbation::bear_out(const PoseGraph& graph, const NodeScans& scans, const PoseEdge& one,
                             const PoseEdge& other) const {
  const double way = std::abs(scans.way_m(one.to) - scans.way_m(other.to));
  const double apart = (pose(graph, one.to).translation() - pose(graph, other.to).translation()).norm();
  if (apart < std::max(kSharesNone_m, shift_m(graph, one)) || way > kSameVisit_m) return false;
  // What the one loop says about where the other's newer node is, against the other.
  const Pose2 T_off =
      (correction(graph, one) * pose(graph, other.to)).inverse() * pose(graph, other.from) * other.T_from_to;
  return T_off.translation().norm() < kGapAgrees_m + kGapDrift * way && std::abs(T_off.heading()) < kGapAgrees_rad;
}

}  // namespace smokemap
