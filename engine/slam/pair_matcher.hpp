#pragma once

#include "core/progress.hpp"
#include "slam/node_scans.hpp"
#include "slam/surface_map.hpp"

namespace smokemap {

/// Matches nodes directly with nodes that stand near and see the same: the many small measurements that make the map
/// crisp once it is roughly right. Errors inside submaps, which a graph of submaps cannot correct, disappear here.
class PairMatcher {
 public:
  explicit PairMatcher(const SlamParams& params);
  /// Edges of every pair with `to >= first_node`, by their poses in the graph. Small corrections only.
  std::vector<PoseEdge> match(const PoseGraph& graph, const NodeScans& scans, int first_node, const Progress& progress);

 private:
  std::vector<int> partners(const PoseGraph& graph, const NodeScans& scans, int node) const;
  struct Matching {
    AlignParams align;
    double least_score;
    SurfaceMap target;
  };
  void match_target(const PoseGraph& graph, const NodeScans& scans, int target, const std::vector<int>& sources,
                    Matching& matching, std::vector<PoseEdge>& edges) const;

  SlamParams params_;
  Matching by_lidar_, by_radar_;  ///< the second where either node is the radar's
};

}  // namespace smokemap
