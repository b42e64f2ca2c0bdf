#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// Ratios to what is around or usual, so that neither resolution nor the largest hall matters.
struct VoronoiParams {
  double trim_ratio = 0.5;        ///< a branch sticks out of its junction's disc by this share of its radius, or goes
  double merge_ratio = 0.5;       ///< junctions nearer than this share of their clearance are one
  double clutter_ratio = 0.5;     ///< obstacles standing free are looked through if smaller than this share of the
                                  ///< clearance there without them, or of the usual one; 0 gives every one its ring
  double narrow_ratio = 0.1;      ///< rays of a laser, narrower than this share of what is usual, are no ways
  double part_ratio = 0.2;        ///< specks of free space nowhere wider than this share of what is usual are noise
  double min_clearance_px = 1.0;  ///< nothing narrower is part of the graph

  Result<Ok> validate() const;
};

enum class VoronoiNodeKind {
  kDeadEnd,   ///< one edge
  kJunction,  ///< three or more
  kIsolated,  ///< none: a single open space
  kLoop,      ///< an arbitrary point of a ring without junction
};

struct VoronoiNode {
  Point2 p_px = Point2::Zero();  ///< picture given, y down
  double clearance_px = 0;       ///< distance to the nearest obstacle, clutter aside
  VoronoiNodeKind kind = VoronoiNodeKind::kDeadEnd;
  std::vector<int> edges;  ///< indices into VoronoiGraph::edges, counter-clockwise as seen (y down: by falling atan2)
};

struct VoronoiEdge {
  int from = 0;  ///< indices into VoronoiGraph::nodes; equal for a ring
  int to = 0;
  double length_px = 0;
  double min_clearance_px = 0;  ///< of the narrowest place: half the width of the door on the way
  double mean_clearance_px = 0;
  std::vector<Point2> path_px;  ///< pixel by pixel, from `from` to `to`, ends included
};

/// Junctions, dead ends and the ways between them along the middle of free space.
struct VoronoiGraph {
  std::vector<VoronoiNode> nodes;  ///< ordered by row, then column
  std::vector<VoronoiEdge> edges;  ///< ordered by (from, to, length)
};

/// Trimmed Voronoi graph of free space.
///
/// @param free_space  CV_8UC1, 255 = free; untouched
/// @return one connected graph for each connected part of free space, and a ring for each obstacle in it, as far as
/// they
///         are neither noise nor clutter. kDegenerate if there is no free cell, kInvalidArgument for another pixel type
///         or parameters out of range, kTooLarge over 64 megapixels.
/// Cost: O(pixels log pixels); a megapixel takes about a third of a second. Deterministic.
/// Source: Mielle et al., "Using sketch-maps for robot navigation: interpretation and matching", SSRR 2016, sect. III;
/// differs: ridges are thinned in the order of the distance image (homotopic), not by a Laplacian threshold, so the
/// graph never tears; trimming compares a branch with the clearance of the junction it starts from, not with the
/// strongest ridge of the picture, so one large hall does not erase small rooms; dead ends stand in the middle of their
/// room's end, not in its corner; furniture makes no rings.
Result<VoronoiGraph> voronoi_graph(const cv::Mat& free_space, const VoronoiParams& params = {});

/// The graph over a dimmed copy of the free space: edges by clearance, junctions and dead ends marked. CV_8UC3, BGR.
cv::Mat draw_voronoi_graph(const VoronoiGraph& graph, const cv::Mat& free_space);

}  // namespace smokemap
