#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "maps/correspondence.hpp"
#include "maps/goal.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"
#include "maps/point_of_interest.hpp"
#include "maps/segmentation.hpp"
#include "maps/sketch_map.hpp"

namespace smokemap {

enum class LinkQuality { kFresh, kStale, kLost };  ///< reception younger than 1 s, 5 s, older

struct RobotStatus {
  std::string id;
  Pose2 T_map_robot;
  double sigma_m = 0;  ///< of the position
  double sigma_rad = 0;
  bool localized = false;  ///< false: the pose is odometry only, shown as such
  LinkQuality link = LinkQuality::kLost;
  Stamp last_heard = 0;  ///< server clock
  double speed_mps = 0;
  bool stopped = false;  ///< emergency stop engaged
  bool exploring = false;
  std::string goal_id;
  std::vector<Point2> path_map;
  std::string note;  ///< why it stands still, for people
};

struct PoiView {
  PointOfInterest poi;
  Transferred in_map;
};

struct GoalView {
  Goal goal;
  Transferred in_map;
  double remaining_m = 0;
  double eta_s = 0;
};

/// Regions of one map as polygons, for showing.
struct RegionView {
  int label = 0;
  Polygon outline_px;
  RegionKind kind = RegionKind::kRoom;
};

struct SketchView {
  SketchMap sketch;
  std::vector<RegionView> regions;  ///< sketch_px
  std::vector<SketchGap> gaps;
  std::string warning;
};

/// Sketch against the plan (rooms of the plan in layout_px).
struct MatchView {
  Matching matching;
  std::vector<RegionView> map_regions;  ///< layout_px
};

struct Alert {
  std::string id;
  std::string text;
  bool urgent = false;
};

struct LayoutView {
  std::string plan_id;
  LayoutMap layout;
};

/// Everything there is to show, at one moment. Immutable; parts that did not change are shared with the snapshot
/// before.
struct Snapshot {
  std::uint64_t revision = 0;
  Stamp time = 0;                               ///< server clock
  std::shared_ptr<const LayoutView> layout;     ///< null without a plan
  std::shared_ptr<const MergedMap> merged;      ///< never null
  std::shared_ptr<const OccupancyGrid> sensed;  ///< what sensors saw, corrected; never null, may be empty
  std::shared_ptr<const SketchView> sketch;     ///< never null
  std::shared_ptr<const MatchView> match;       ///< null without sketch or plan
  std::vector<RobotStatus> robots;
  std::vector<PoiView> pois;
  std::vector<GoalView> goals;
  std::vector<Alert> alerts;
};

}  // namespace smokemap
