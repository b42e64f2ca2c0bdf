#include "session/merger.hpp"

#include <cmath>

namespace smokemap {
namespace {

bool same_start(const std::optional<PlanStart>& a, const std::optional<PlanStart>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->T_layout_robot.vector() == b->T_layout_robot.vector() && a->sigma_m == b->sigma_m);
}

bool same_anchor(const AddAnchor& a, const AddAnchor& b) {
  return a.p_layout_px == b.p_layout_px && a.p_map == b.p_map;
}

}  // namespace

MergedMap plan_alone(const LayoutMap& layout, const std::optional<PlanStart>& start) {
  MergedMap merged;
  const Pose2 T_map_layout = start ? start->T_layout_robot.inverse() : Pose2();
  merged.layout_to_map = Deformation::from_similarity({1.0, T_map_layout});
  const PixelFrame frame = layout.frame();
  for (const LayoutCorner& corner : layout.corners)
    merged.corners.push_back(
        {corner.p_px, T_map_layout * frame.to_metres(corner.p_px), start ? start->sigma_m + 0.5 : 1.0, false});
  for (std::size_t i = 0; i < layout.walls.size(); ++i) {
    MergedWall wall;
    wall.layout_wall = static_cast<int>(i);
    const Segment2 m = layout.wall_m(static_cast<int>(i));
    wall.segment_map = {T_map_layout * m.a, T_map_layout * m.b};
    merged.walls.push_back(wall);
  }
  return merged;
}

/// Node ids have a new meaning: what was learnt from the old ones is void.
void Merger::start_over() {
  acg_ = AutoCompleteGraph();
  renderer_ = MapRenderer();
  known_ = {};
  has_plan_ = false;
}

void Merger::take_plan(const MergeInput& input) {
  if (input.floor.generation != known_.floor.generation) start_over();
  const bool new_plan = input.layout != known_.layout;
  if (new_plan) {
    has_plan_ = input.layout && acg_.set_plan(input.layout->layout, input.start).ok();
    if (!has_plan_) acg_.clear_plan();
    known_.anchors.clear(), known_.wall_verdicts.clear(), known_.wall_lengths_m.clear(), known_.corner_pins.clear();
  } else if (has_plan_ && input.start && !same_start(input.start, known_.start)) {
    acg_.set_start(*input.start);
  }
  if (has_plan_) take_word_of_people(input);
}

/// Tells the graph what changed since the last call.
void Merger::take_word_of_people(const MergeInput& input) {
  for (const auto& [id, anchor] : known_.anchors)
    if (!input.anchors.contains(id)) acg_.remove_anchor(id);
  for (const auto& [id, anchor] : input.anchors)
    if (const auto it = known_.anchors.find(id); it == known_.anchors.end() || !same_anchor(it->second, anchor))
      acg_.add_anchor(id, anchor.p_layout_px, anchor.p_map);
  for (const auto& [wall, verdict] : known_.wall_verdicts)
    if (!input.wall_verdicts.contains(wall)) (void)acg_.judge_wall(wall, WallJudgement::kNone);
  for (const auto& [wall, verdict] : input.wall_verdicts)
    (void)acg_.judge_wall(wall, verdict == WallVerdict::kGone ? WallJudgement::kGone : WallJudgement::kThere);
  for (const auto& [wall, length_m] : known_.wall_lengths_m)
    if (!input.wall_lengths_m.contains(wall)) (void)acg_.set_wall_length(wall, std::nullopt);
  for (const auto& [wall, length_m] : input.wall_lengths_m) (void)acg_.set_wall_length(wall, length_m);
  for (const auto& [corner, p_map] : known_.corner_pins)
    if (!input.corner_pins.contains(corner)) (void)acg_.pin_corner(corner, std::nullopt);
  for (const auto& [corner, p_map] : input.corner_pins) (void)acg_.pin_corner(corner, p_map);
}

std::shared_ptr<const MergedMap> Merger::merge(const MergeInput& input, const Progress& progress,
                                               std::string& complaint) {
  if (input.floor.graph->nodes.empty())
    return std::make_shared<const MergedMap>(input.layout ? plan_alone(input.layout->layout, input.start)
                                                          : MergedMap{});
  auto merged = acg_.update(*input.floor.graph, progress);
  if (merged) return std::make_shared<const MergedMap>(std::move(*merged));
  complaint = merged.error().message;
  return last_;
}

MergeResult Merger::run(const MergeInput& input, const Progress& progress) {
  take_plan(input);
  known_ = input;
  MergeResult result;
  auto merged = std::make_shared<MergedMap>(*merge(input, progress, result.complaint));
  merged->revision = ++revision_;
  result.merged = last_ = merged;
  std::vector<Pose2> T_map_nodes;
  for (const StampedPose& pose : merged->trajectory) T_map_nodes.push_back(pose.T_map_robot);
  const PoseGraph& graph = *input.floor.graph;
  for (std::size_t i = T_map_nodes.size(); i < graph.nodes.size(); ++i)
    T_map_nodes.push_back(graph.nodes[i].T_map_robot);
  T_map_nodes.resize(graph.nodes.size());
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    result.T_map_graph[graph.nodes[i].robot] = T_map_nodes[i] * graph.nodes[i].T_map_robot.inverse();
  result.generation = input.floor.generation;
  renderer_.update(graph, T_map_nodes);
  result.sensed = std::make_shared<const OccupancyGrid>(renderer_.occupancy());
  const LayoutMap* layout = input.layout ? &input.layout->layout : nullptr;
  if (auto cost_map = build_cost_map(*merged, *result.sensed, layout, {}))
    result.cost_map = std::make_shared<const CostMap>(std::move(*cost_map));
  return result;
}

}  // namespace smokemap
