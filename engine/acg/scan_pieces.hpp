#pragma once

#include <vector>

#include "acg/acg_params.hpp"
#include "features/corners.hpp"
#include "geometry/segment2.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

/// A straight run of neighbouring hits of one scan, robot frame; free space (the robot) lies on its left.
struct ScanPiece {
  Segment2 segment;
  int hits = 0;
};

/// A beam by direction: where it ended, or how far it was free.
struct ScanRay {
  double bearing_rad = 0;
  Point2 way = Point2::UnitX();  ///< unit vector of the bearing
  double range_m = 0;
  bool hit = false;  ///< false: free up to range_m
};

/// What one node has to say, prepared once.
struct NodeView {
  int id = 0;
  int robot = 0;  ///< which of the robots, counted in the order in which they came
  std::vector<ScanPiece> pieces;
  std::vector<ScanRay> rays;    ///< ascending bearing
  std::vector<Corner> corners;  ///< where faces meet, robot frame
};

/// Splits the hits, ordered by bearing, where neighbours are far apart and where they bend (recursive split, total
/// least squares fit). Cost: O(n log n). Deterministic.
NodeView view_of(const PoseNode& node, const AcgParams& params);

}  // namespace smokemap
