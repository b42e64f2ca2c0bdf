#pragma once

#include <memory>
#include <optional>
#include <string>

#include "session/carrier.hpp"
#include "session/fleet.hpp"
#include "session/mapper.hpp"
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

  /// Where the plan starts is what was said of the robot that comes first in the graph.
  MergeInput merge_input(FloorGraph floor) const;
  void take(const MergeResult& result);
  /// For the mapper; the same object until something in it changed.
  std::shared_ptr<const FloorView> floor() const { return floor_; }
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
  Result<WayQuestion> way_question(const std::string& robot, const Point2& p_map) const;

 private:
  void forget_starts();
  Result<Ok> note_start(const SetStart& start, Origin origin);
  std::vector<Alert> alerts() const;

  Whiteboard board_;
  Fleet fleet_;
  std::shared_ptr<RobotCommands> commands_;
  std::shared_ptr<const MergedMap> merged_ = std::make_shared<const MergedMap>();
  std::shared_ptr<const OccupancyGrid> sensed_ = std::make_shared<const OccupancyGrid>();
  SketchReading sketch_;
  std::shared_ptr<const FloorView> floor_ = std::make_shared<const FloorView>();  ///< hints of people in it too
  std::map<std::string, PlanStart> starts_;  ///< per robot: where its graph starts if it is the first in the graph
  std::string newest_start_;                 ///< the robot of which a start was said last
  bool start_is_old_ = false;                ///< known only from the log: the robot may stand elsewhere by now
  std::string merge_complaint_;
};

}  // namespace smokemap
