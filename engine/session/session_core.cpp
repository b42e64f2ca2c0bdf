#include "session/session_core.hpp"

namespace smokemap {
namespace {

/// Of a finger on a plan.
constexpr double kStartSigmaM = 0.3;
constexpr double kStartSigmaRad = 0.08;

std::shared_ptr<const SketchView> empty_sketch() {
  static const auto kEmpty = std::make_shared<const SketchView>();
  return kEmpty;
}

}  // namespace

SessionCore::SessionCore(const FleetParams& params, std::shared_ptr<RobotCommands> commands)
    : fleet_(params, commands), commands_(std::move(commands)) {}

Result<Ok> SessionCore::apply(const Command& command, Origin origin) {
  const auto layout_before = board_.layout;
  const int frame_before = board_.revisions.layout_frame;
  if (const auto ok = board_.apply(command); !ok) return ok;
  if (board_.revisions.layout_frame != frame_before) forget_starts();
  if (const auto* start = std::get_if<SetStart>(&command)) return note_start(*start, origin);
  if (const auto* stop = std::get_if<EmergencyStop>(&command); stop && stop->engaged) fleet_.stop_now(stop->robot);
  if (const auto* set = std::get_if<PlacePoi>(&command); set && origin == Origin::kHistory) {
    Place& place = board_.pois.at(set->poi.id).place;
    if (place.frame == PlaceFrame::kMap) place.revision = kEarlierMap;
  }
  if (const auto* set = std::get_if<SetGoal>(&command); set && origin == Origin::kHistory) {
    Goal* goal = board_.find_goal(set->goal.id);
    if (goal && !is_final(goal->state)) {
      goal->state = GoalState::kCancelled;
      goal->reason = "the server was restarted";
    }
  }
  return Ok{};
}

Result<Ok> SessionCore::note_start(const SetStart& start, Origin origin) {
  if (origin == Origin::kHistory) {
    board_.start.reset();
    start_is_old_ = true;
    return Ok{};
  }
  const Point2 p_layout = board_.layout->layout.frame().to_metres(start.p_layout_px);
  const Pose2 T_layout_robot(p_layout, start.heading_rad);
  // The robot may have moved since its first pose, which is the origin of the map.
  const Pose2 T_graph_robot = fleet_.T_graph_robot(start.robot).value_or(Pose2());
  starts_[start.robot] = PlanStart{T_layout_robot * T_graph_robot.inverse(), kStartSigmaM, kStartSigmaRad};
  newest_start_ = start.robot;
  start_is_old_ = false;
  FloorView view = *floor_;
  StandHint& hint = view.hints[start.robot];
  hint = {T_layout_robot, kStartSigmaM, kStartSigmaRad, hint.revision + 1};
  floor_ = std::make_shared<const FloorView>(std::move(view));
  return Ok{};
}

void SessionCore::tick(Stamp now) { fleet_.tick(now, board_, Carrier(board_, *merged_, sketch_)); }

void SessionCore::forget_starts() {
  starts_.clear();
  start_is_old_ = false;
  FloorView view = *floor_;
  view.hints.clear();
  floor_ = std::make_shared<const FloorView>(std::move(view));
}

MergeInput SessionCore::merge_input(FloorGraph floor) const {
  const auto& nodes = floor.graph->nodes;
  const auto start = starts_.find(nodes.empty() ? newest_start_ : nodes.front().robot);
  MergeInput input{std::move(floor),     board_.layout,         std::nullopt,      board_.anchors,
                   board_.wall_verdicts, board_.wall_lengths_m, board_.corner_pins};
  if (start != starts_.end()) input.start = start->second;
  return input;
}

void SessionCore::take(const MergeResult& result) {
  merged_ = result.merged;
  sensed_ = result.sensed;
  merge_complaint_ = result.complaint;
  fleet_.set_map(result.cost_map);
  for (const auto& [robot, T_map_graph] : result.T_map_graph) fleet_.set_correction(robot, T_map_graph);
  floor_ = std::make_shared<const FloorView>(FloorView{merged_, result.generation, floor_->hints});
}

SessionCore::SketchOrder SessionCore::sketch_order() const {
  return {board_.revisions.sketch, board_.sketch(), board_.layout, board_.pair_verdicts};
}

std::optional<Point2> SessionCore::place_on_plan(const Point2& p_map) const {
  if (!board_.layout || merged_->corners.empty() || merged_->fit.refuted() || !p_map.allFinite()) return std::nullopt;
  return board_.layout->layout.frame().to_pixels(merged_->layout_to_map.inverse(p_map));
}

Result<WayQuestion> SessionCore::way_question(const std::string& robot, const Point2& p_map) const {
  return fleet_.way_question(robot, p_map);
}

std::vector<Alert> SessionCore::alerts() const {
  std::vector<Alert> alerts;
  if (start_is_old_ && starts_.empty())
    alerts.push_back(
        {"old-start", "Where the robot stands on the plan is only known from before the restart: say it again.", true});
  if (board_.layout && !board_.layout->layout.scale)
    alerts.push_back({"no-scale", "The plan has no scale yet: a guess is used.", false});
  if (merged_->fit.refuted()) alerts.push_back({"no-fit", "This plan does not seem to fit this building.", true});
  if (sketch_.match && sketch_.to_plan && sketch_.match->matching.same_building < kFitsFrom)
    alerts.push_back({"sketch-no-fit", "The sketch does not seem to show the building of the plan.", false});
  if (!merge_complaint_.empty())
    alerts.push_back({"merge", "The map could not be corrected just now: " + merge_complaint_, false});
  return alerts;
}

Snapshot SessionCore::snapshot(Stamp now) const {
  Snapshot snapshot;
  snapshot.time = now;
  snapshot.layout = board_.layout;
  snapshot.merged = merged_;
  snapshot.sensed = sensed_;
  snapshot.sketch = sketch_.sketch ? sketch_.sketch : empty_sketch();
  snapshot.match = sketch_.match;
  snapshot.robots = fleet_.status();
  const Carrier carrier(board_, *merged_, sketch_);
  for (const auto& [id, poi] : board_.pois)
    if (!poi.removed) snapshot.pois.push_back({poi, carrier.to_map(poi.place)});
  for (const Goal& goal : board_.goals) snapshot.goals.push_back(fleet_.view(goal, carrier));
  snapshot.alerts = alerts();
  return snapshot;
}

}  // namespace smokemap
