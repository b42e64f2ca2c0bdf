#include "session/graph_union.hpp"

#include <algorithm>

namespace smokemap {
namespace {

/// Index of the node with this id; ids of one robot count up, usually without gaps.
std::optional<std::size_t> index_of(const PoseGraph& graph, int id) {
  const auto it = std::lower_bound(graph.nodes.begin(), graph.nodes.end(), id,
                                   [](const PoseNode& node, int wanted) { return node.id < wanted; });
  if (it == graph.nodes.end() || it->id != id) return std::nullopt;
  return static_cast<std::size_t>(it - graph.nodes.begin());
}

PoseEdge edge_of(const GraphLink& link, int own_in_union) {
  PoseEdge edge;
  edge.from = link.union_node;
  edge.to = own_in_union;
  edge.T_from_to = link.T_union_own;
  edge.sqrt_information.setZero();
  edge.sqrt_information.diagonal() << 1 / link.sigma_m, 1 / link.sigma_m, 1 / link.sigma_rad;
  edge.kind = EdgeKind::kMatched;
  return edge;
}

}  // namespace

void GraphUnion::update(const std::string& robot, const PoseGraph& graph) {
  if (first_.empty()) {
    first_ = robot;
    members_[robot] = {};
  }
  graphs_[robot] = graph;
  if (has(robot)) take_new_nodes(robot);
}

void GraphUnion::take_new_nodes(const std::string& robot) {
  Member& member = members_.at(robot);
  for (std::size_t i = member.union_ids.size(); i < graphs_.at(robot).nodes.size(); ++i) {
    member.union_ids.push_back(static_cast<int>(slots_.size()));
    slots_.push_back({robot, i});
  }
}

Result<Ok> GraphUnion::join(const std::string& robot, const GraphLink& link) {
  if (has(robot)) return Ok{};
  const auto it = graphs_.find(robot);
  if (it == graphs_.end()) return fail(Errc::kNotFound, "no graph of " + robot + " is known");
  if (!index_of(it->second, link.own_node)) return fail(Errc::kNotFound, "the joining node does not exist");
  if (link.union_node < 0 || link.union_node >= static_cast<int>(slots_.size()))
    return fail(Errc::kNotFound, "the node to join at does not exist");
  if (!link.T_union_own.is_finite() || !(link.sigma_m > 0) || !(link.sigma_rad > 0))
    return fail(Errc::kInvalidArgument, "a link needs a place and errors above zero");
  members_[robot].link = link;
  take_new_nodes(robot);
  return Ok{};
}

void GraphUnion::leave(const std::string& robot) {
  if (robot == first_ || members_.erase(robot) == 0) return;
  std::vector<int> new_id(slots_.size(), -1);
  std::vector<Slot> kept;
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].robot != robot) new_id[i] = static_cast<int>(kept.size()), kept.push_back(slots_[i]);
  slots_ = std::move(kept);
  ++generation_;
  std::vector<std::string> stranded;  // robots that hung on the one that left
  for (auto& [name, member] : members_) {
    for (int& id : member.union_ids) id = new_id[static_cast<std::size_t>(id)];
    if (!member.link) continue;
    int& hangs_on = member.link->union_node;  // less than 0: stranded already, and about to leave
    if (hangs_on >= 0) hangs_on = new_id[static_cast<std::size_t>(hangs_on)];
    if (hangs_on < 0) stranded.push_back(name);
  }
  for (const std::string& name : stranded) leave(name);
}

std::optional<Pose2> GraphUnion::T_union_slam(const std::string& robot) const {
  const auto it = members_.find(robot);
  if (it == members_.end()) return std::nullopt;
  if (!it->second.link) return Pose2();
  const GraphLink& link = *it->second.link;
  const PoseGraph& own = graphs_.at(robot);
  const Pose2& T_slam_own = own.nodes[*index_of(own, link.own_node)].T_map_robot;
  return pose_in_union(link.union_node) * link.T_union_own * T_slam_own.inverse();
}

/// Links point to older members, so this ends.
Pose2 GraphUnion::pose_in_union(int union_id) const {
  const Slot& slot = slots_[static_cast<std::size_t>(union_id)];
  return *T_union_slam(slot.robot) * graphs_.at(slot.robot).nodes[slot.index].T_map_robot;
}

PoseGraph GraphUnion::graph() const {
  PoseGraph all;
  all.nodes.reserve(slots_.size());
  std::map<std::string, Pose2> T_union_slam_of;
  for (const auto& [robot, member] : members_) T_union_slam_of[robot] = *T_union_slam(robot);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    PoseNode node = graphs_.at(slots_[i].robot).nodes[slots_[i].index];
    node.id = static_cast<int>(i);
    node.T_map_robot = T_union_slam_of.at(slots_[i].robot) * node.T_map_robot;
    all.nodes.push_back(std::move(node));
  }
  for (const auto& [robot, member] : members_) {
    const PoseGraph& own = graphs_.at(robot);
    for (PoseEdge edge : own.edges) {
      const auto from = index_of(own, edge.from), to = index_of(own, edge.to);
      if (!from || !to) continue;
      edge.from = member.union_ids[*from], edge.to = member.union_ids[*to];
      all.edges.push_back(edge);
    }
    if (member.link)
      all.edges.push_back(edge_of(*member.link, member.union_ids[*index_of(own, member.link->own_node)]));
  }
  return all;
}

}  // namespace smokemap
