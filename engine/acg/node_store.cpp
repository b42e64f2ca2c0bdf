#include "acg/node_store.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kSpacingTurn_rad = 0.35;

std::array<double, 3> block(const Pose2& pose) { return {pose.x(), pose.y(), pose.heading()}; }

}  // namespace

void NodeStore::take(const PoseGraph& graph, GraphState& state) {
  const bool same_start = !graph.nodes.empty() && !views_.empty() && graph.nodes.front().id == views_.front().id;
  if (graph.nodes.size() < views_.size() || !same_start) {
    views_.clear();
    state.poses.clear();
  }
  for (std::size_t i = views_.size(); i < graph.nodes.size(); ++i) views_.push_back(view_of(graph.nodes[i], params_));
  // An update that failed may have left nodes here that the state does not know yet.
  const std::size_t known = std::min(state.poses.size(), graph.nodes.size());
  state.poses.resize(known);
  for (std::size_t i = known; i < graph.nodes.size(); ++i) {
    Pose2 pose = graph.nodes[i].T_map_robot;
    if (known > 0) pose = state.pose(known - 1) * (graph.nodes[known - 1].T_map_robot.inverse() * pose);
    state.poses.push_back(block(pose));
  }
  std::unordered_map<int, int> position;
  for (std::size_t i = 0; i < views_.size(); ++i) position[views_[i].id] = static_cast<int>(i);
  edges_.clear();
  for (PoseEdge edge : graph.edges) {
    const auto from = position.find(edge.from), to = position.find(edge.to);
    if (from == position.end() || to == position.end() || from == to || edge.state == LinkState::kRejected) continue;
    if (!edge.sqrt_information.allFinite() || !edge.T_from_to.is_finite()) continue;
    edge.from = from->second;
    edge.to = to->second;
    edges_.push_back(edge);
  }
  GraphState fresh;
  for (const PoseNode& node : graph.nodes) fresh.poses.push_back(block(node.T_map_robot));
  if (edge_cost(fresh) < 0.5 * edge_cost(state)) state.poses = fresh.poses;
  mark_spaced(state);
}

double NodeStore::edge_cost(const GraphState& state) const {
  double cost = 0;
  for (const PoseEdge& e : edges_) {
    const Pose2 between =
        state.pose(static_cast<std::size_t>(e.from)).inverse() * state.pose(static_cast<std::size_t>(e.to));
    Eigen::Vector3d error = between.vector() - e.T_from_to.vector();
    error[2] = wrap_angle(error[2]);
    cost += std::min(100.0, (e.sqrt_information * error).squaredNorm());
  }
  return cost;
}

void NodeStore::mark_spaced(const GraphState& state) {
  spaced_.assign(views_.size(), false);
  way_m_.assign(views_.size(), 0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (i > 0) way_m_[i] = way_m_[i - 1] + (state.pose(i).translation() - state.pose(i - 1).translation()).norm();
    const Pose2 step = state.pose(last).inverse() * state.pose(i);
    if (i > 0 && step.translation().norm() < params_.node_spacing_m && std::abs(step.heading()) < kSpacingTurn_rad)
      continue;
    spaced_[i] = true;
    last = i;
  }
}

}  // namespace smokemap
