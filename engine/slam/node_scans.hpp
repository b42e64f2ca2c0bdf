#pragma once

#include <cstdint>
#include <vector>

#include "maps/pose_graph.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// What the back end knows of each node beyond the graph, by node id. Points are kept in single precision (a
/// micrometre at 10 m), directions to a twentieth of a milliradian: with everything else of the graph they are most of
/// what a long run needs.
class NodeScans {
 public:
  /// @param surface  robot frame
  /// @param way_m    driven until the node
  /// @param by_radar  points of the radar alone: matching with them allows for it
  void add(const std::vector<SurfacePoint>& surface, double way_m, bool by_radar);

  std::size_t size() const { return scans_.size(); }
  std::vector<SurfacePoint> surface(int node) const;
  bool empty(int node) const { return scan(node).points.empty(); }
  double way_m(int node) const { return scan(node).way_m; }
  bool either_by_radar(int a, int b) const { return scan(a).by_radar || scan(b).by_radar; }

 private:
  struct Packed {
    float x, y, weight;
    std::int16_t normal_x, normal_y;  ///< in steps of 1 / kNormalSteps
  };
  struct Scan {
    std::vector<Packed> points;
    double way_m = 0;
    bool by_radar = false;
  };
  const Scan& scan(int node) const { return scans_[static_cast<std::size_t>(node)]; }

  std::vector<Scan> scans_;
};

/// Covariance of a match as an edge needs it: information of (x, y, heading) given in the map frame, turned into the
/// frame of a node with heading `heading`, and softened by sigmas that stand for the target's own errors.
Result<Eigen::Matrix3d> edge_sqrt_information(const Eigen::Matrix3d& information_map, double heading, double sigma_m,
                                              double sigma_rad);

/// How far apart two nodes are in the graph, and how far their relative pose may be wrong.
struct GraphDistance {
  double way_m = 0;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();  ///< about the map's origin: x, y, heading of a rigid displacement

  /// Covariance of the other node's pose (x, y, heading; map frame) when the first is held, at the place `p_map`.
  Eigen::Matrix3d covariance_at(const Point2& p_map) const;
};

/// The shortest way through the graph from one node to every other: what drift grows with. Edges count by the way
/// driven between their ends, loops and matches between visits as `jump_m`; rejected edges not at all. The covariances
/// of the edges on that way are summed as displacements of everything behind them, which is what they are: an error of
/// heading moves far nodes more. Unreached nodes get an infinite way. Cost O(edges log nodes).
std::vector<GraphDistance> graph_distances(const PoseGraph& graph, const NodeScans& scans, int from, double jump_m);

}  // namespace smokemap
