#pragma once

#include <opencv2/core.hpp>

#include "topology/voronoi_graph.hpp"

namespace smokemap {

/// Reads nodes and edges off one pixel wide lines (CV_8UC1, 255 = line). Node kinds and edge lists are not filled in
/// yet.
VoronoiGraph trace_lines(const cv::Mat& line, const cv::Mat& clearance);

/// Fills length and clearances from the path.
void measure(VoronoiEdge& edge, const cv::Mat& clearance);

}  // namespace smokemap
