#pragma once

#include <opencv2/core.hpp>

#include "maps/merged_map.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap::app {

/// The merged map for people, y up, CV_8UC3: hits grey, way light green; walls green confirmed, orange moved, blue
/// unseen, red missing, magenta new; corners with a circle of two sigma.
cv::Mat draw_merged(const MergedMap& merged, const PoseGraph& graph, double pixels_per_metre = 40);

}  // namespace smokemap::app
