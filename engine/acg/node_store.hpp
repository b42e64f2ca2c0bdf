#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "acg/scan_pieces.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

enum class GraphChange {
  kGrown,    ///< the old nodes are where SLAM had them
  kMoved,    ///< SLAM moved them (a loop was closed)
  kAnother,  ///< nothing known about the old nodes holds
};

/// The nodes of SLAM's graph as the solver keeps them: prepared scans, edges by position, poses carried over.
class NodeStore {
 public:
  explicit NodeStore(const AcgParams& params) : params_(params) {}

  /// Takes over nodes and edges; new nodes get the correction of their robot's node before them. When SLAM moved its
  /// own poses (a loop was closed), the poses in `state` are started again from SLAM's if they fit its edges better.
  GraphChange take(const PoseGraph& graph, GraphState& state);

  const std::vector<NodeView>& views() const { return views_; }
  const std::vector<PoseEdge>& edges() const { return edges_; }
  /// Nodes that say enough new to be asked about walls.
  const std::vector<bool>& spaced() const { return spaced_; }
  /// Metres driven up to each node, by all robots together.
  const std::vector<double>& way_m() const { return way_m_; }
  std::size_t size() const { return views_.size(); }
  /// The poses as SLAM has them, without any correction.
  std::vector<std::array<double, 3>> slam_poses() const;

 private:
  void take_edges(const PoseGraph& graph);
  void mark_spaced(const GraphState& state);
  double edge_cost(const GraphState& state) const;

  AcgParams params_;
  std::vector<NodeView> views_;
  std::vector<Pose2> slam_poses_;  ///< as SLAM had them at the last taking over
  std::map<std::string, int> robots_;
  std::vector<PoseEdge> edges_;
  std::vector<bool> spaced_;
  std::vector<double> way_m_;
};

}  // namespace smokemap
