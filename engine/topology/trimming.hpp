#pragma once

#include <opencv2/core.hpp>

#include "topology/voronoi_graph.hpp"

namespace smokemap {

/// Leaves of a traced graph what a person would draw: dead ends draw back out of the corners of their room, branches
/// that hardly leave the disc of their junction go, junctions within each other's disc become one, and nodes that only
/// pass a way on vanish. Parts stay connected and every ring stays. Node kinds and edge lists are not filled in.
/// Cost: O(edges log edges + lengths of their paths).
VoronoiGraph trim(VoronoiGraph graph, const cv::Mat& clearance, const VoronoiParams& params);

}  // namespace smokemap
