#pragma once

#include <opencv2/core.hpp>

#include "topology/voronoi_graph.hpp"

namespace smokemap {

/// Usual clearance in the narrower part of free space, half the width of its corridors: a quarter of the middle between
/// opposite walls is narrower. Counted by length, not by area, so that a large hall hardly changes it. 0 if no walls
/// face each other more than a few pixels apart.
double usual_clearance(const cv::Mat& clearance);

/// Clearance of free space as the graph sees it: obstacles that stand free and are small beside the room round
/// them are looked through; what is too narrow for a way, and specks of free space of their own, are not
/// free. CV_32FC1, 0 where not free.
cv::Mat walkable_clearance(const cv::Mat& free_space, const VoronoiParams& params);

}  // namespace smokemap
