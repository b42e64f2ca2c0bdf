#pragma once

#include "slam/graph_solver.hpp"
#include "slam/loop_closer.hpp"
#include "slam/pair_matcher.hpp"

namespace smokemap {

/// The slow half: owns the graph, closes loops, solves, polishes. Edges of the graph are, in this order, the front
/// end's (one a node), loops, matched pairs.
class BackEnd {
 public:
  explicit BackEnd(const SlamParams& params);

  /// @param edge  from the last node to this one; ignored for the first
  int add_node(PoseNode node, std::vector<SurfacePoint> surface, const PoseEdge& edge);
  /// Loops for the nodes that were not searched yet, then a solve if there were any.
  bool optimize(const Progress& progress);
  void polish(const Progress& progress);

  const PoseGraph& graph() const { return graph_; }
  int loops_tried() const { return tried_; }
  int loops_closed() const { return static_cast<int>(loops_.size()) - outvoted_; }
  int loops_rejected() const { return refused_ + outvoted_; }

 private:
  bool solve(const Progress& progress);
  void compose_edges();

  SlamParams params_;
  PoseGraph graph_;
  NodeScans scans_;
  LoopCloser closer_;
  PairMatcher pairs_matcher_;
  std::vector<PoseEdge> steps_, loops_, pairs_;
  int searched_ = 0;  ///< nodes before this one were searched for loops
  double searched_way_m_ = 0;
  int tried_ = 0, refused_ = 0, outvoted_ = 0;
};

}  // namespace smokemap
