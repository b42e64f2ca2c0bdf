#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "maps/laser_scan.hpp"
#include "maps/merged_map.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"
#include "navigation/obstacle_watch.hpp"
#include "session/fleet.hpp"
#include "session/graph_union.hpp"
#include "session/locator.hpp"
#include "slam/motion_model.hpp"
#include "slam/slam.hpp"

namespace smokemap {

using SensorItem = std::variant<LaserScan, Odometry, RadarSweep>;

/// "This robot stands here now", said by a person on the plan.
struct StandHint {
  Pose2 T_layout_robot;
  double sigma_m = 0.3;
  double sigma_rad = 0.08;
  int revision = 0;  ///< counts up with every hint for this robot
};

/// What the mapper needs to know of the floor.
struct FloorView {
  std::shared_ptr<const MergedMap> merged = std::make_shared<const MergedMap>();  ///< never null
  int generation = 0;                                                             ///< of the graph that `merged` is of
  std::map<std::string, StandHint> hints;
};

/// SLAM of every robot. The first robot heard makes the map. Every other one first builds a map of its own, is looked
/// for in the walls of the merged map (from a person's hint, or anywhere), and once that is sure its graph joins the
/// floor's; until then it is reported as not localised. A new hint takes it out again and looks anew.
/// Runs on one thread; no other state.
class Mapper {
 public:
  /// @param work who closes loops and solves: inside optimize (deterministic), or a thread a robot
  explicit Mapper(GraphWork work = GraphWork::kWhenAsked) : work_(work) {}

  /// @return what the fleet should know, if the item said something new
  std::optional<PoseReport> add(const SensorItem& item);
  /// What merging made of the floor. Cheap when it is the same object as before.
  void take(std::shared_ptr<const FloorView> floor);
  /// Closes loops and solves; true when the floor's graph changed since the last call.
  bool optimize(const Progress& progress = {});
  /// As of the last `optimize`.
  const FloorGraph& graph() const { return graph_; }

 private:
  struct Track {
    explicit Track(GraphWork work) : slam(SlamParams{}, work) {}
    Pose2 T_odom_at(Stamp stamp) const { return odometry.at(stamp).value_or(T_odom_robot); }

    Slam slam;
    ObstacleWatch watch;
    OdometryBuffer odometry;
    Pose2 T_odom_robot;
    double speed_mps = 0;
    Locator locator;
    bool locating = false;    ///< a search runs
    int hint_revision = 0;    ///< of the hint that was followed last
    Pose2 T_slam_at_step;     ///< where the locator was moved last
    double join_sigma_m = 0;  ///< how exactly it was placed when it joined
  };
  Track& track_of(const std::string& robot);
  std::optional<PoseReport> report(const std::string& robot, Track& track, const Result<ScanOutcome>& outcome);
  void follow_hint(const std::string& robot, Track& track);
  /// A step of the search for a robot that did not join yet, at a new node of its own graph.
  void locate(const std::string& robot, Track& track);
  void join(const std::string& robot, Track& track, const PoseNode& node);

  const GraphWork work_;
  std::map<std::string, Track> tracks_;
  std::string map_maker_;
  GraphUnion union_;
  std::shared_ptr<const FloorView> floor_ = std::make_shared<const FloorView>();
  bool changed_ = false;
  FloorGraph graph_;
};

/// The walls of the merged map that a robot may be looked for in: all but the missing ones.
std::vector<LocalizerWall> walls_to_localize_in(const MergedMap& merged);

}  // namespace smokemap
