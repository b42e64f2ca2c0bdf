#pragma once

#include <optional>
#include <vector>

#include "slam/align.hpp"
#include "slam/likelihood_grid.hpp"
#include "slam/node_scans.hpp"
#include "slam/surface_map.hpp"

namespace smokemap {

/// Finds where a node sees what much older nodes saw. The last few nodes are searched as one scan, by branch and bound,
/// inside a window that grows with the error that the way through the graph between the two visits can have gathered,
/// in all that the older visit saw within that window. A find counts only if it fits well, fits in one place only, lies
/// where that error can have led, and if single scans of the group, matched alone, agree with it. Offices are built
/// alike, and corridors are alike all along: a find that would move the graph much must fit better, and hardly any ray
/// of either visit may pass through what the other saw, counted among those that tell places along a corridor apart.
class LoopCloser {
 public:
  explicit LoopCloser(const SlamParams& params);

  struct Found {
    std::vector<PoseEdge> edges;
    int tried = 0;
    int rejected = 0;  ///< good search score, refused by verification
  };
  /// Loops of one node, at most a few; the graph is not changed.
  /// @param piece_begin  nodes before it are not tied to this one yet: they are searched in, but not joined to its scan
  Found close(const PoseGraph& graph, const NodeScans& scans, int node, int piece_begin = 0);
  /// Where a robot that may be anywhere is: the nodes from `piece_begin` on, as one scan, searched in everything seen
  /// before. Stricter than a loop: it must fit well and nowhere else. About 10 ms for each 5 m of map.
  std::optional<PoseEdge> find_anywhere(const PoseGraph& graph, const NodeScans& scans, int node, int piece_begin);

 private:
  struct Candidate {
    int node = 0;
    double radius_m = 0;
    double half_rad = 0;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the searching node's pose when `node` is held
  };
  std::vector<Candidate> candidates(const PoseGraph& graph, const NodeScans& scans, int node) const;
  bool try_candidate(const PoseGraph& graph, const NodeScans& scans, int node, const Candidate& candidate,
                     Found& found);
  void draw_target(const PoseGraph& graph, const NodeScans& scans, int node, int around, double radius_m);
  void draw_region(const PoseGraph& graph, const NodeScans& scans, int around, int end);
  LikelihoodGrid target_grid() const;
  std::optional<PoseEdge> verified(const PoseGraph& graph, const NodeScans& scans, int node, int around,
                                   const ScanAlignment& fine) const;
  std::vector<SurfacePoint> joint_scan(const PoseGraph& graph, const NodeScans& scans, int node, int count) const;
  /// Rays of either visit among the surfaces of the other.
  struct Rays {
    int agree = 0;    ///< end on a surface ...
    int telling = 0;  ///< ... that faces along the direction in which the match is weakest: along a corridor
    int through = 0;  ///< pass through one
  };
  Rays rays_between(const PoseGraph& graph, const NodeScans& scans, int node, const ScanAlignment& fine) const;
  bool holds_up(const PoseGraph& graph, const NodeScans& scans, int node, const ScanAlignment& fine,
                double sigmas) const;
  bool singles_agree(const PoseGraph& graph, const NodeScans& scans, int node, const Pose2& T_map_node) const;

  /// Where either side is the radar's, its gates and scores hold.
  void match_as(bool radar);

  SlamParams by_lidar_, by_radar_;
  bool as_radar_ = false;
  SlamParams params_;  ///< one of the two
  SurfaceMap target_;
  std::vector<int> target_nodes_;  ///< that were drawn into it
  int piece_begin_ = 0;
};

}  // namespace smokemap
