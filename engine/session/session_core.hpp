#pragma once

#include <memory>
#include <optional>
#include <string>

#include "session/carrier.hpp"
#include "session/fleet.hpp"
#include "session/merger.hpp"
#include "session/sketch_reader.hpp"
#include "session/snapshot.hpp"
#include "session/whiteboard.hpp"

namespace smokemap {

enum class Origin { kLive, kHistory };

/// The state of a session and the order of its stages, without threads: commands, sensor reports and results of slow
/// work in, work orders and snapshots out. Engine runs it behind threads; tests run it step by step.
class SessionCore {
 public:
  SessionCore(const FleetParams& params, std::shared_ptr<RobotCommands> commands);

  Result<Ok> apply(const Command& command, Origin origin);

  void heard(const std::string& robot, Stamp now) { fleet_.heard(robot, now); }
  void report(const PoseReport& report) { fleet_.report(report); }
  /// Steers the robots.
  void tick(Stamp now);

  /// @param graph  of the map-making robot; @param map_maker its id, empty while there is none
  MergeInput merge_input(std::shared_ptr<const PoseGraph> graph) const;
  void take(const MergeResult& result, const std::string& map_maker);
  /// Counts up whenever the plan, its start, anchors or judgements changed.
  int plan_revision() const { return board_.revisions.plan; }

  struct SketchOrder {
    int revision = 0;
    SketchMap sketch;
    std::shared_ptr<const LayoutView> layout;
    std::vector<PairVerdict> verdicts;
  };
  SketchOrder sketch_order() const;
  int sketch_revision() const { return board_.revisions.sketch; }
  void take(SketchReading reading) { sketch_ = std::move(reading); }

  Snapshot snapshot(Stamp now) const;
  std::optional<Point2> place_on_plan(const Point2& p_map) const;

 private:
  Result<Ok> note_start(const SetStart& start, Origin origin);
  std::vector<Alert> alerts() const;

  Whiteboard board_;
  Fleet fleet_;
  std::shared_ptr<RobotCommands> commands_;
  std::shared_ptr<const MergedMap> merged_ = std::make_shared<const MergedMap>();
  std::shared_ptr<const OccupancyGrid> sensed_ = std::make_shared<const OccupancyGrid>();
  SketchReading sketch_;
  std::optional<PlanStart> start_;
  bool start_is_old_ = false;  ///< known only from the log: the robot may stand elsewhere by now
  std::string merge_complaint_;
};

}  // namespace smokemap
