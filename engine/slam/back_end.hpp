#pragma once

#include "slam/graph_solver.hpp"
#include "slam/loop_closer.hpp"
#include "slam/loop_probation.hpp"
#include "slam/pair_matcher.hpp"

namespace smokemap {

/// A node as the front end hands it over.
struct NewNode {
  PoseNode node;
  std::vector<SurfacePoint> surface;
  PoseEdge edge;           ///< from the last node; ignored for the first
  bool new_piece = false;  ///< nothing had fitted for a while: the robot may be anywhere
  bool by_radar = false;
};

/// What the back end made of the nodes it was given so far.
struct GraphUpdate {
  std::vector<Pose2> T_map_nodes;
  std::vector<PoseEdge> steps;  ///< the front end's edges, one between each node and the next
  std::vector<PoseEdge> links;  ///< loops, then matched pairs
  int tried = 0, closed = 0, rejected = 0, relocated = 0;
  bool moved = false;  ///< poses changed since the update before
};

/// The slow half: owns the graph, closes loops, solves, polishes. Every node is worked off completely before the next:
/// what comes out depends on the nodes and their order alone, never on when they came. Edges of the graph are, in this
/// order, the front end's (one a node), loops, matched pairs.
class BackEnd {
 public:
  explicit BackEnd(const SlamParams& params);

  /// Takes in a node, searches its loops, solves if there were any.
  /// @return true when poses changed
  bool add(NewNode node, const Progress& progress);
  void polish(const Progress& progress);

  const PoseGraph& graph() const { return graph_; }
  GraphUpdate update(bool moved) const;

 private:
  void append(NewNode added);
  bool search_due(int node);
  bool relocate(int node);
  void tie_piece(const PoseEdge& found);
  bool solve(const Progress& progress);
  void compose_edges();

  SlamParams params_;
  PoseGraph graph_;
  NodeScans scans_;
  LoopCloser closer_;
  LoopProbation probation_;
  PairMatcher pairs_matcher_;
  std::vector<PoseEdge> steps_, loops_, pairs_;
  double searched_way_m_ = 0;
  int piece_begin_ = -1;  ///< first node of a piece that nothing ties to the nodes before yet
  double relocation_way_m_ = 0;
  int tried_ = 0, refused_ = 0, outvoted_ = 0, relocated_ = 0;
};

}  // namespace smokemap
