#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/deformation.hpp"
#include "geometry/segment2.hpp"
#include "grids/occupancy_grid.hpp"
#include "maps/odometry.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

enum class WallState { kConfirmed, kMoved, kUnseen, kMissing, kNew };

const char* to_string(WallState state);

/// A wall of the corrected world. Centre line in `map`.
struct MergedWall {
  std::optional<int> layout_wall;  ///< index into LayoutMap::walls; none for a new wall
  Segment2 segment_map;
  WallState state = WallState::kUnseen;
  double confidence = 0;      ///< 0..1 in the state
  double evidence_m = 0;      ///< length of it that sensors spoke about
  double displacement_m = 0;  ///< how far the plan had it wrong, mean of both ends
};

struct MergedCorner {
  Point2 p_layout_px = Point2::Zero();
  Point2 p_map = Point2::Zero();
  double sigma_m = 0;  ///< one standard deviation per coordinate
  bool seen = false;   ///< by a sensor, itself or its walls
};

/// A link between what was seen and the plan, shown to the operator.
struct MapLink {
  Point2 p_map = Point2::Zero();
  int layout_corner = 0;
  LinkState state = LinkState::kKept;
};

/// What became of a pair that a person vouched for.
struct MergedAnchor {
  std::string id;
  double residual_m = 0;  ///< from where the person says the place is to where the merged map has it
  bool outlier = false;   ///< contradicts the other pairs; it was left out
};

/// Does this plan fit this building at all?
struct PlanFit {
  double score = 0;                 ///< 0..1: how far plan and sensors explain each other
  std::string verdict = "unknown";  ///< "fits", "doubtful", "does not fit", "unknown"

  /// Another building's plan, or laid wrong: nothing is to be reached by it.
  bool refuted() const { return verdict == "does not fit"; }
};

/// Plan and robot map after they corrected each other.
struct MergedMap {
  int revision = 0;
  std::vector<MergedWall> walls;
  std::vector<MergedCorner> corners;  ///< same order as LayoutMap::corners
  std::vector<MapLink> links;
  std::vector<MergedAnchor> anchors;  ///< by id
  Deformation layout_to_map;          ///< layout (metres) -> map; identity without a plan
  Trajectory trajectory;              ///< corrected, one per pose node
  PlanFit fit;
  /// One standard deviation per coordinate of where each robot's newest node is, against the first node of all: what
  /// drift left on the way there. Worked out anew every few updates, and kept between; empty before the plan was laid.
  std::map<std::string, double> robot_sigma_m;
};

}  // namespace smokemap
