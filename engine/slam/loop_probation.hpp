#pragma once

#include <vector>

#include "slam/node_scans.hpp"
#include "slam/slam_params.hpp"

namespace smokemap {

/// Where places look alike, one loop alone proves nothing, however well it fits: the wrong one of two like rooms fits
/// just as well, and once believed it keeps the right one from being looked for. A loop that would move the graph as
/// far as like places lie apart therefore waits until another one, found farther on than the gap is long, closes the
/// same gap: a row of rooms would have to repeat twice to deceive both. Smaller corrections, which no mistaken room
/// explains, need no witness. Loops that never find one are not believed. (Pairwise consistent loops: Mangelson et al.,
/// ICRA 2018, there for the largest set; here for two, at once.)
class LoopProbation {
 public:
  explicit LoopProbation(const LoopParams& params) : params_(params) {}

  /// The loops that may be believed now, of those just found and of those that waited. Cost O(waiting^2), of which
  /// there are few.
  std::vector<PoseEdge> admit(const PoseGraph& graph, const NodeScans& scans, const std::vector<PoseEdge>& found);
  int waiting() const { return static_cast<int>(waiting_.size()); }

 private:
  bool is_small(const PoseGraph& graph, const PoseEdge& loop) const;
  bool bear_out(const PoseGraph& graph, const NodeScans& scans, const PoseEdge& one, const PoseEdge& other) const;

  LoopParams params_;
  std::vector<PoseEdge> waiting_;
};

}  // namespace smokemap
