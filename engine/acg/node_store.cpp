#include "acg/node_store.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kSpacingTurn_rad = 0.35;
constexpr double kMoved_m = 0.05, kMoved_rad = 0.01;  ///< smaller changes of SLAM's own poses are polish

std::array<double, 3> block(const Pose2& pose) { return {pose.x(), pose.y(), pose.heading()}; }

}  // namespace

GraphChange NodeStore::take(const PoseGraph& graph, GraphState& state) {
  GraphChange change = GraphChange::kGrown;
  const bool shrunk = graph.nodes.size() < views_.size();
  if (!views_.empty() && (shrunk || graph.nodes.front().id != views_.front().id)) {
    change = GraphChange::kAnother;
    views_.clear();
    slam_poses_.clear();
    state.poses.clear();
  }
  for (std::size_t i = 0; i < slam_poses_.size(); ++i) {
    const Pose2 step = slam_poses_[i].inverse() * graph.nodes[i].T_map_robot;
    if (step.translation().norm() > kMoved_m || std::abs(step.heading()) > kMoved_rad) change = GraphChange::kMoved;
  }
  for (std::size_t i = views_.size(); i < graph.nodes.size(); ++i) {
    views_.push_back(view_of(graph.nodes[i], params_));
    views_.back().robot = robots_.try_emplace(graph.nodes[i].robot, static_cast<int>(robots_.size())).first->second;
  }
  // An update that failed may have left nodes here that the state does not know yet.
  const std::size_t known = std::min(state.poses.size(), graph.nodes.size());
  state.poses.resize(known);
  std::map<int, std::size_t> last;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const auto before = last.find(views_[i].robot);
    if (i >= known) {
      Pose2 pose = graph.nodes[i].T_map_robot;
      if (before != last.end())
        pose = state.pose(before->second) * (graph.nodes[before->second].T_map_robot.inverse() * pose);
      state.poses.push_back(block(pose));
    }
    last[views_[i].robot] = i;
  }
  take_edges(graph);
  slam_poses_.clear();
  GraphState fresh;
  for (const PoseNode& node : graph.nodes) {
    slam_poses_.push_back(node.T_map_robot);
    fresh.poses.push_back(block(node.T_map_robot));
  }
  if (change == GraphChange::kMoved && edge_cost(fresh) < 0.5 * edge_cost(state)) state.poses = fresh.poses;
  mark_spaced(state);
  return change;
}

std::vector<std::array<double, 3>> NodeStore::slam_poses() const {
  std::vector<std::array<double, 3>> out;
  for (const Pose2& pose : slam_poses_) out.push_back(block(pose));
  return out;
}

void NodeStore::take_edges(const PoseGraph& graph) {
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
  struct Track {
    std::size_t before = 0, spaced = 0;
  };
  std::map<int, Track> tracks;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const auto [track, first] = tracks.try_emplace(views_[i].robot, Track{i, i});
    const Pose2 way = state.pose(track->second.before).inverse() * state.pose(i);
    const Pose2 step = state.pose(track->second.spaced).inverse() * state.pose(i);
    way_m_[i] = (i > 0 ? way_m_[i - 1] : 0) + way.translation().norm();
    track->second.before = i;
    if (!first && step.translation().norm() < params_.node_spacing_m && std::abs(step.heading()) < kSpacingTurn_rad)
      continue;
    spaced_[i] = true;
    track->second.spaced = i;
  }
}

}  // namespace smokemap
