#include "session/whiteboard.hpp"

#include <algorithm>

#include "core/text.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kMostStrokes = 5000;
constexpr double kShortestWallM = 0.1, kLongestWallM = 500;
constexpr std::size_t kMostPois = 5000;
constexpr std::size_t kMostGoals = 1000;
constexpr std::size_t kMostAnchors = 1000;
constexpr std::size_t kMostPairVerdicts = 5000;
constexpr double kWidestPlanM = 2000;  // as wide as the map that robots plan on

Result<Ok> finite(const Point2& p, const char* what) {
  if (p.allFinite() && p.cwiseAbs().maxCoeff() < 1e6) return Ok{};
  return fail(Errc::kInvalidArgument, std::string(what) + " is not a place");
}

Result<Ok> named(const std::string& id, const char* what) {
  if (!id.empty() && id.size() <= 64) return Ok{};
  return fail(Errc::kInvalidArgument, std::string(what) + " needs an id of 1 to 64 characters");
}

double width_of_corners_px(const LayoutMap& layout) {
  if (layout.corners.empty()) return 0;
  Point2 low = layout.corners.front().p_px, high = low;
  for (const LayoutCorner& corner : layout.corners) low = low.cwiseMin(corner.p_px), high = high.cwiseMax(corner.p_px);
  return (high - low).maxCoeff();
}

Result<Ok> check_layout(const LayoutMap& layout) {
  if (layout.width_px <= 0 || layout.height_px <= 0) return fail(Errc::kInvalidArgument, "the plan has no size");
  const auto corners = static_cast<int>(layout.corners.size());
  for (const LayoutCorner& corner : layout.corners)
    if (const auto ok = finite(corner.p_px, "a corner of the plan"); !ok) return ok;
  for (const LayoutWall& wall : layout.walls)
    if (wall.corner_a < 0 || wall.corner_b < 0 || wall.corner_a >= corners || wall.corner_b >= corners)
      return fail(Errc::kInvalidArgument, "a wall of the plan ends at a corner that is not there");
  if (!layout.scale) return Ok{};
  if (!(layout.scale->metres_per_pixel > 0 && layout.scale->metres_per_pixel < 10))
    return fail(Errc::kInvalidArgument, "the plan's scale is not between 0 and 10 metres per pixel");
  if (width_of_corners_px(layout) * layout.scale->metres_per_pixel > kWidestPlanM)
    return fail(Errc::kInvalidArgument, "with this scale the plan is more than 2 km wide");
  return Ok{};
}

/// False when it is there already: the same command again changes nothing.
template <typename Map, typename Value>
bool put(Map& map, const typename Map::key_type& key, const Value& value) {
  const auto it = map.find(key);
  if (it != map.end() && it->second == value) return false;
  map.insert_or_assign(key, value);
  return true;
}

bool near(const Point2& a, const Point2& b) { return (a - b).norm() < 1e-6; }

}  // namespace

Result<Ok> Whiteboard::apply(const Command& command) {
  return std::visit([this](const auto& c) { return do_apply(c); }, command);
}

SketchMap Whiteboard::sketch() const {
  SketchMap sketch{sheet_width_px_, sheet_height_px_, {}};
  for (const Stroke& stroke : strokes_)
    if (!erased_.contains(stroke.id)) sketch.strokes.push_back(stroke);
  return sketch;
}

Goal* Whiteboard::find_goal(const std::string& id) {
  const auto it = std::find_if(goals.begin(), goals.end(), [&](const Goal& goal) { return goal.id == id; });
  return it == goals.end() ? nullptr : &*it;
}

Result<Ok> Whiteboard::stamp_frame(Place& place) const {
  if (const auto ok = finite(place.p, "the place"); !ok) return ok;
  if (place.frame == PlaceFrame::kLayoutPx) {
    if (!layout) return fail(Errc::kNotFound, "there is no plan to place anything on");
    place.revision = revisions.layout_frame;
  }
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const SetLayout& command) {
  if (const auto ok = check_layout(command.layout); !ok) return ok;
  const bool same_sheet = layout && layout->plan_id == command.plan_id &&
                          layout->layout.width_px == command.layout.width_px &&
                          layout->layout.height_px == command.layout.height_px;
  layout = std::make_shared<const LayoutView>(LayoutView{command.plan_id, command.layout});
  wall_verdicts.clear(), wall_lengths_m.clear(), corner_pins.clear();  // walls and corners are counted anew
  if (!same_sheet) {
    ++revisions.layout_frame;
    start.reset();
    anchors.clear();
    pair_verdicts.clear();
  }
  ++revisions.plan, ++revisions.sketch;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const SetStart& command) {
  if (!layout) return fail(Errc::kNotFound, "there is no plan to stand on");
  if (const auto ok = finite(command.p_layout_px, "the start"); !ok) return ok;
  if (!std::isfinite(command.heading_rad)) return fail(Errc::kInvalidArgument, "the heading is not a number");
  start = command;
  ++revisions.plan;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const AddAnchor& command) {
  if (!layout) return fail(Errc::kNotFound, "there is no plan to anchor");
  if (const auto ok = named(command.id, "an anchor"); !ok) return ok;
  if (const auto ok = finite(command.p_layout_px, "the anchor on the plan"); !ok) return ok;
  if (const auto ok = finite(command.p_map, "the anchor on the map"); !ok) return ok;
  const auto there = anchors.find(command.id);
  if (there == anchors.end() && anchors.size() >= kMostAnchors) return fail(Errc::kTooLarge, "there are 1000 anchors");
  if (there != anchors.end() && there->second.p_layout_px == command.p_layout_px &&
      there->second.p_map == command.p_map)
    return Ok{};
  anchors[command.id] = command;
  ++revisions.plan;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const RemoveAnchor& command) {
  if (anchors.erase(command.id) > 0) ++revisions.plan;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const JudgeWall& command) {
  if (!layout || command.layout_wall < 0 || command.layout_wall >= static_cast<int>(layout->layout.walls.size()))
    return fail(Errc::kNotFound, "the plan has no wall " + std::to_string(command.layout_wall));
  const bool changed = command.verdict == WallVerdict::kNone ? wall_verdicts.erase(command.layout_wall) > 0
                                                             : put(wall_verdicts, command.layout_wall, command.verdict);
  if (changed) ++revisions.plan;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const MeasureWall& command) {
  if (!layout || command.layout_wall < 0 || command.layout_wall >= static_cast<int>(layout->layout.walls.size()))
    return fail(Errc::kNotFound, "the plan has no wall " + std::to_string(command.layout_wall));
  if (command.length_m && !(*command.length_m >= kShortestWallM && *command.length_m <= kLongestWallM))
    return fail(Errc::kInvalidArgument, "a wall is 0.1 to 500 m long");
  const bool changed = command.length_m ? put(wall_lengths_m, command.layout_wall, *command.length_m)
                                        : wall_lengths_m.erase(command.layout_wall) > 0;
  if (changed) ++revisions.plan;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const PinCorner& command) {
  if (!layout || command.layout_corner < 0 || command.layout_corner >= static_cast<int>(layout->layout.corners.size()))
    return fail(Errc::kNotFound, "the plan has no corner " + std::to_string(command.layout_corner));
  if (command.p_map)
    if (const auto ok = finite(*command.p_map, "the corner on the map"); !ok) return ok;
  const bool changed = command.p_map ? put(corner_pins, command.layout_corner, *command.p_map)
                                     : corner_pins.erase(command.layout_corner) > 0;
  if (changed) ++revisions.plan;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const AddStroke& command) {
  const Stroke& stroke = command.stroke;
  if (const auto ok = named(stroke.id, "a stroke"); !ok) return ok;
  if (stroke.points_px.empty() || stroke.points_px.size() > 20'000)
    return fail(Errc::kInvalidArgument, "a stroke needs 1 to 20000 points");
  for (const Point2& p : stroke.points_px)
    if (const auto ok = finite(p, "a point of the stroke"); !ok) return ok;
  for (const Stroke& there : strokes_)
    if (there.id == stroke.id) return Ok{};  // strokes are immutable: the same one again
  if (strokes_.size() - erased_.size() >= kMostStrokes)
    return fail(Errc::kTooLarge, "the sketch has 5000 strokes; erase some first");
  if (strokes_.size() >= 2 * kMostStrokes) forget_erased_strokes();
  strokes_.push_back(stroke);
  ++revisions.sketch;
  return Ok{};
}

void Whiteboard::forget_erased_strokes() {
  std::erase_if(strokes_, [this](const Stroke& stroke) { return erased_.contains(stroke.id); });
  erased_.clear();
}

Result<Ok> Whiteboard::do_apply(const EraseStroke& command) {
  const bool known =
      std::any_of(strokes_.begin(), strokes_.end(), [&](const Stroke& s) { return s.id == command.stroke_id; });
  if (!known) return fail(Errc::kNotFound, "there is no such stroke");
  const bool changed =
      command.restore ? erased_.erase(command.stroke_id) > 0 : erased_.insert(command.stroke_id).second;
  if (changed) ++revisions.sketch;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const ClearSketch&) {
  if (strokes_.size() == erased_.size() && pair_verdicts.empty()) return Ok{};
  for (const Stroke& stroke : strokes_) erased_.insert(stroke.id);
  pair_verdicts.clear();
  ++revisions.sketch;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const SetSketchSheet& command) {
  if (command.width_px < 16 || command.height_px < 16 || command.width_px > 8192 || command.height_px > 8192)
    return fail(Errc::kInvalidArgument, "a sheet has 16 to 8192 pixels a side");
  if (sheet_width_px_ == command.width_px && sheet_height_px_ == command.height_px) return Ok{};
  sheet_width_px_ = command.width_px, sheet_height_px_ = command.height_px;
  ++revisions.sketch;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const JudgePair& command) {
  if (!layout) return fail(Errc::kNotFound, "there is no plan to match the sketch with");
  for (const Point2& p : {command.p_sketch_px, command.p_layout_px})
    if (const auto ok = finite(p, "the place"); !ok) return ok;
  const auto is_about_these = [&](const PairVerdict& v) {
    return near(v.p_sketch_px, command.p_sketch_px) && near(v.p_layout_px, command.p_layout_px);
  };
  if (!pair_verdicts.empty() && is_about_these(pair_verdicts.back()) && pair_verdicts.back().verdict == command.verdict)
    return Ok{};
  std::erase_if(pair_verdicts, is_about_these);
  if (pair_verdicts.size() >= kMostPairVerdicts) pair_verdicts.erase(pair_verdicts.begin());
  // Also kProposed is kept: it takes back whatever was said before about the same two regions (SketchReader resolves
  // it).
  pair_verdicts.push_back({command.p_sketch_px, command.p_layout_px, command.verdict});
  ++revisions.sketch;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const PlacePoi& command) {
  PointOfInterest poi = command.poi;
  if (const auto ok = named(poi.id, "a point of interest"); !ok) return ok;
  if (const auto ok = stamp_frame(poi.place); !ok) return ok;
  if (characters(poi.label) > 200) return fail(Errc::kTooLarge, "a label has at most 200 characters");
  if (pois.size() >= kMostPois) std::erase_if(pois, [](const auto& entry) { return entry.second.removed; });
  if (pois.size() >= kMostPois && !pois.contains(poi.id))
    return fail(Errc::kTooLarge, "there are 5000 points of interest");
  if (const auto it = pois.find(poi.id); it != pois.end()) poi.created = it->second.created;
  pois[poi.id] = std::move(poi);
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const RemovePoi& command) {
  const auto it = pois.find(command.id);
  if (it == pois.end()) return fail(Errc::kNotFound, "there is no such point of interest");
  it->second.removed = true;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const SetGoal& command) {
  Goal goal = command.goal;
  if (const auto ok = named(goal.id, "a goal"); !ok) return ok;
  if (goal.robot.empty()) return fail(Errc::kInvalidArgument, "a goal needs a robot");
  if (goal.heading_rad && !std::isfinite(*goal.heading_rad))
    return fail(Errc::kInvalidArgument, "the heading is not a number");
  if (find_goal(goal.id)) return Ok{};
  if (const auto ok = stamp_frame(goal.place); !ok) return ok;
  if (goals.size() >= kMostGoals) {  // what was reached long ago makes room
    const auto past = std::find_if(goals.begin(), goals.end(), [](const Goal& g) { return is_final(g.state); });
    if (past == goals.end()) return fail(Errc::kTooLarge, "1000 goals are waiting");
    goals.erase(past);
  }
  goal.state = GoalState::kQueued;
  goal.reason.clear();
  goals.push_back(std::move(goal));
  ++revisions.goals;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const CancelGoal& command) {
  Goal* goal = find_goal(command.id);
  if (!goal) return fail(Errc::kNotFound, "there is no such goal");
  if (is_final(goal->state)) return Ok{};
  goal->state = GoalState::kCancelled;
  ++revisions.goals;
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const EmergencyStop& command) {
  if (command.robot.empty()) {
    all_stopped = command.engaged;
    if (!command.engaged) stopped.clear();
  } else if (command.engaged) {
    stopped.insert(command.robot);
  } else {
    stopped.erase(command.robot);
  }
  return Ok{};
}

Result<Ok> Whiteboard::do_apply(const SetExploring& command) {
  if (command.robot.empty()) return fail(Errc::kInvalidArgument, "which robot?");
  exploring[command.robot] = command.exploring;
  return Ok{};
}

}  // namespace smokemap
