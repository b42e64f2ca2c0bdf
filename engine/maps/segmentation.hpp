#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "geometry/polygon.hpp"
#include "geometry/segment2.hpp"

namespace smokemap {

enum class MapKind { kSketch, kRobot, kLayout };

enum class RegionKind { kRoom, kCorridor };

struct Region {
  int label = 0;  ///< value in Segmentation::labels, from 1
  double area_px = 0;
  Point2 centroid_px = Point2::Zero();
  Point2 anchor_px = Point2::Zero();  ///< a point surely inside, farthest from walls
  double clearance_px = 0;            ///< of the anchor
  RegionKind kind = RegionKind::kRoom;
  double confidence = 1;  ///< of its least sure border, 0.5..1; 1 where nobody doubts it (closed in, or given)
};

/// Where two regions touch: a door, a passage or a cut through open space.
struct RegionBorder {
  int label_a = 0;
  int label_b = 0;
  Segment2 line_px;  ///< straight boundary
  double width_px = 0;
  double confidence = 1;  ///< that it is a boundary at all, 0.5..1
  bool is_door = true;    ///< or the mouth of a place that is no wider than the opening
};

/// Free space split into regions. Pixels as in the picture given (y down).
struct Segmentation {
  cv::Mat labels;               ///< CV_16UC1; 0 = not free, otherwise Region::label
  std::vector<Region> regions;  ///< descending area; regions[i].label == i + 1
  std::vector<RegionBorder> borders;
};

}  // namespace smokemap
