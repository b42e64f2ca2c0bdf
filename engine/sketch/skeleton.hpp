#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace smokemap {

/// A line of a skeleton between two junctions or ends.
struct SkeletonBranch {
  std::vector<cv::Point> points;
  bool free_a = false;  ///< nothing else begins at its first point
  bool free_b = false;
};

/// Thins the mask (255 = ink) to one pixel and walks it from junction to junction; closed loops come as one branch
/// whose ends meet. Branches shorter than `min_branch_px` that end in nothing are hairs of the thinning and left out.
/// Reading order.
std::vector<SkeletonBranch> trace_skeleton(const cv::Mat& mask, double min_branch_px);

}  // namespace smokemap
