#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

/// The graph of everybody on the floor, as handed from sensing to merging.
struct FloorGraph {
  std::shared_ptr<const PoseGraph> graph = std::make_shared<const PoseGraph>();  ///< never null
  int generation = 0;  ///< changes when node ids lost their meaning
};

/// How the graph of a robot that joins hangs on what is there: its node, seen from a node of the union.
struct GraphLink {
  int union_node = 0;  ///< id in the union
  int own_node = 0;    ///< id in the joining robot's own graph
  Pose2 T_union_own;   ///< pose of the own node in the frame of the union's node
  double sigma_m = 0.2;
  double sigma_rad = 0.05;
};

/// The pose graphs of several robots on a floor as one. Its frame is that of the first robot's graph; the graph of a
/// robot that joins later is moved there as a whole. Nodes are only appended while nobody leaves, so ids stay; poses
/// and edges follow the robots' own graphs (loops, robust states). Cost of an update: O(nodes + edges), scans shared.
class GraphUnion {
 public:
  /// The first robot's graph, or the newer graph of a robot that joined. Graphs of others are kept until they join.
  void update(const std::string& robot, const PoseGraph& graph);
  /// kNotFound for a robot without a graph or for nodes that do not exist, kInvalidArgument for a link that says
  /// nothing. A robot that joined already is left alone.
  Result<Ok> join(const std::string& robot, const GraphLink& link);
  /// Takes a robot's nodes out again; ids are counted anew (`generation`). The first robot cannot leave.
  void leave(const std::string& robot);

  bool has(const std::string& robot) const { return members_.contains(robot); }
  /// Changes whenever ids lost their meaning.
  int generation() const { return generation_; }
  /// The robot's own graph frame in the union's; nothing for a robot that did not join.
  std::optional<Pose2> T_union_slam(const std::string& robot) const;
  /// Built anew at every call.
  PoseGraph graph() const;

 private:
  struct Member {
    std::vector<int> union_ids;  ///< by index into its own nodes
    std::optional<GraphLink> link;
  };
  struct Slot {
    std::string robot;
    std::size_t index = 0;
  };
  void take_new_nodes(const std::string& robot);
  Pose2 pose_in_union(int union_id) const;

  std::string first_;
  std::map<std::string, PoseGraph> graphs_;
  std::map<std::string, Member> members_;
  std::vector<Slot> slots_;  ///< by id in the union
  int generation_ = 0;
};

}  // namespace smokemap
