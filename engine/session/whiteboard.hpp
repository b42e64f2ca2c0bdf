#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "session/commands.hpp"
#include "session/snapshot.hpp"

namespace smokemap {

/// Two places of which a person said whether they are the same.
struct PairVerdict {
  Point2 p_sketch_px = Point2::Zero();
  Point2 p_layout_px = Point2::Zero();
  Verdict verdict = Verdict::kConfirmed;
};

/// Counts changes, so that slow work knows what it has to do again.
struct WhiteboardRevisions {
  int layout_frame = 0;  ///< another picture or size: places on the old one have no meaning any more
  int plan = 0;          ///< walls, start, anchors, judgements
  int sketch = 0;        ///< strokes and verdicts on pairs, or the plan's walls
  int goals = 0;
};

/// What people did, and nothing else: replaying the commands gives the same whiteboard. No threads, no clock.
class Whiteboard {
 public:
  /// Validates, then changes. An error changes nothing. The same command a second time changes nothing, but for a plan
  /// (its walls are counted anew) and a start (said again, it is meant anew).
  Result<Ok> apply(const Command& command);

  std::shared_ptr<const LayoutView> layout;
  std::optional<SetStart> start;
  std::map<std::string, AddAnchor> anchors;
  std::map<int, WallVerdict> wall_verdicts;
  std::map<int, double> wall_lengths_m;  ///< measured by people
  std::map<int, Point2> corner_pins;     ///< layout corner -> place in `map`
  std::vector<PairVerdict> pair_verdicts;
  std::map<std::string, PointOfInterest> pois;
  std::vector<Goal> goals;        ///< in the order in which they are to be driven
  std::set<std::string> stopped;  ///< robots under emergency stop
  bool all_stopped = false;
  std::map<std::string, bool> exploring;
  WhiteboardRevisions revisions;

  bool is_stopped(const std::string& robot) const { return all_stopped || stopped.contains(robot); }
  bool explores(const std::string& robot) const {
    const auto it = exploring.find(robot);
    return it != exploring.end() && it->second;
  }
  /// The strokes that are neither erased nor cleared.
  SketchMap sketch() const;
  Goal* find_goal(const std::string& id);

 private:
  Result<Ok> do_apply(const SetLayout& command);
  Result<Ok> do_apply(const SetStart& command);
  Result<Ok> do_apply(const AddAnchor& command);
  Result<Ok> do_apply(const RemoveAnchor& command);
  Result<Ok> do_apply(const JudgeWall& command);
  Result<Ok> do_apply(const MeasureWall& command);
  Result<Ok> do_apply(const PinCorner& command);
  Result<Ok> do_apply(const AddStroke& command);
  Result<Ok> do_apply(const EraseStroke& command);
  Result<Ok> do_apply(const ClearSketch& command);
  Result<Ok> do_apply(const SetSketchSheet& command);
  Result<Ok> do_apply(const JudgePair& command);
  Result<Ok> do_apply(const PlacePoi& command);
  Result<Ok> do_apply(const RemovePoi& command);
  Result<Ok> do_apply(const SetGoal& command);
  Result<Ok> do_apply(const CancelGoal& command);
  Result<Ok> do_apply(const EmergencyStop& command);
  Result<Ok> do_apply(const SetExploring& command);
  Result<Ok> stamp_frame(Place& place) const;
  void forget_erased_strokes();

  int sheet_width_px_ = 1024;
  int sheet_height_px_ = 768;
  std::vector<Stroke> strokes_;
  std::set<std::string> erased_;
};

}  // namespace smokemap
