#include <algorithm>
#include <cmath>
#include <set>

#include "acg/association.hpp"
#include "acg/corner_links.hpp"
#include "acg/gates.hpp"
#include "acg/graph_impl.hpp"
#include "acg/wall_evidence.hpp"

namespace smokemap {
namespace {

constexpr double kTakeUp_m = 3.0;   ///< of way between two rounds while the plan is taken up
constexpr double kWindow_m = 8.0;   ///< of way whose poses are free meanwhile
constexpr double kFinest_m = 0.08;  ///< last robust width
constexpr int kReweights = 2;
constexpr double kSure = 0.5;         ///< weight of a link that bears out others
constexpr double kCornerWidth = 1.5;  ///< a crossing is less sure than a face

/// Graduated non-convexity: weights from the misfits and each wall's width as it is in this round.
void weigh(SolveInput& input, const std::vector<double>& width_m) {
  const auto width = [&](int wall) { return std::max(kFinest_m, width_m[static_cast<std::size_t>(wall)]); };
  std::set<std::pair<std::size_t, int>> on_wall;  // which node sees a face of which wall, for sure
  for (PieceLink& link : input.links) {
    if (link.weight > 0) link.weight = robust_weight(link.misfit_m, width(link.wall));
    if (link.weight > kSure) on_wall.insert({link.node, link.wall});
  }
  for (CornerLink& link : input.corners) {
    if (link.weight <= 0) continue;
    // Another link of the node bears it out, or both walls do: their faces are those that meet.
    const bool by_walls = on_wall.contains({link.node, link.walls[0]}) && on_wall.contains({link.node, link.walls[1]});
    link.weight = (by_walls ? 1.0 : link.borne_out) *
                  robust_weight(link.misfit_m, kCornerWidth * std::max(width(link.walls[0]), width(link.walls[1])));
  }
}

}  // namespace

SolveInput AutoCompleteGraph::Impl::make_input(const Learnt& l, const PoseRange& free_poses) const {
  SolveInput input;
  input.plan = &*plan;
  input.edges = nodes.edges();
  input.anchors = anchor_links(l);
  for (const auto& [corner, p_map] : pins) input.pins.push_back({corner, p_map});
  for (const auto& [wall, length_m] : lengths_m) input.lengths.push_back({wall, length_m});
  if (start) input.start = StartHold{l.state.pose(0), start->T_layout_robot, start->sigma_m, start->sigma_rad};
  input.free_poses = free_poses;
  input.iterations = free_poses.empty() ? 6 : 8;
  for (const WallState state : l.walls) input.wall_firmness.push_back(state == WallState::kMissing ? 0.1 : 1.0);
  return input;
}

/// All links with the estimates as they are, not yet weighted.
SolveInput AutoCompleteGraph::Impl::link(Learnt& l, const std::vector<bool>& use, const std::vector<double>& gates,
                                         double sharpness, const PoseRange& free_poses) const {
  SolveInput input = make_input(l, free_poses);
  input.links = link_pieces(nodes.views(), use, *plan, l.state, gates, params);
  input.corners = link_corners(nodes.views(), use, *plan, l.state, gates);
  std::vector<double> end_gates;
  for (const double g : gates) end_gates.push_back(g > 0 ? std::clamp(g, 0.3, 0.6) : 0);
  BeamReading beams = l.beams.read(nodes.views(), use, *plan, l.state, end_gates);
  input.ends = std::move(beams.ends);
  l.near_m = linked_length_m(input.links, *plan, l.state, 0);
  std::vector<double> widths = gates;
  for (double& w : widths) w *= sharpness;
  weigh(input, widths);
  l.linked_m = linked_length_m(input.links, *plan, l.state);
  drop_immature(l.near_m, *plan, params, input.links);
  drop_immature(l.near_m, *plan, params, input.corners);
  judge_walls(beams.walls, l);
  return input;
}

/// One round: links with the estimates as they are, then solves with weights that tighten.
Result<Ok> AutoCompleteGraph::Impl::round(Learnt& l, const std::vector<bool>& use, double sharpness,
                                          const PoseRange& free_poses, const Progress& progress,
                                          SolveInput* kept) const {
  std::vector<double> widths = wall_gates_m(*plan, l.walls, l.linked_m, params);
  for (double& w : widths) w *= l.gate_share;
  SolveInput input = link(l, use, widths, sharpness, free_poses);
  for (double& w : widths) w *= 0.7 * sharpness;
  for (int k = 0; k < kReweights; ++k) {
    const GraphState before = l.state;
    if (const auto done = solve(input, params, progress, l.state); !done) return done.error();
    follow(before, free_poses, l.state);
    for (PieceLink& link : input.links) link.misfit_m = misfit_m(link, *plan, l.state);
    for (CornerLink& link : input.corners) link.misfit_m = misfit_m(link, l.state);
    weigh(input, widths);
  }
  if (kept != nullptr) *kept = std::move(input);
  return Ok{};
}

/// Walls that were caught by something else (furniture before them) go back to where the plan expects them, and may be
/// linked anew from there.
Result<Ok> AutoCompleteGraph::Impl::release_tense(Learnt& l, const SolveInput& input, const Progress& progress) const {
  const std::vector<bool> tense = tense_walls(*plan, l.state, params);
  if (std::none_of(tense.begin(), tense.end(), [](bool t) { return t; })) return Ok{};
  SolveInput without = input;
  without.free_poses = {};
  for (PieceLink& link : without.links)
    if (tense[static_cast<std::size_t>(link.wall)]) link.weight = 0;
  return solve(without, params, progress, l.state);
}

void AutoCompleteGraph::Impl::judge_walls(const std::vector<WallEvidence>& evidence, Learnt& l) const {
  for (std::size_t w = 0; w < evidence.size(); ++w) {
    l.walls[w] = judge_wall_state(evidence[w], l.linked_m[w], l.near_m[w], params);
  }
  stubs_go_with_their_walls(*plan, l.walls);
  for (std::size_t w = 0; w < evidence.size(); ++w) {
    const auto word = judgements.find(static_cast<int>(w));
    if (word == judgements.end() || word->second == WallJudgement::kNone) continue;
    l.walls[w] = word->second == WallJudgement::kGone ? WallState::kMissing : WallState::kConfirmed;
  }
}

/// Poses behind the free ones keep their place against the last free one of their robot.
void AutoCompleteGraph::Impl::follow(const GraphState& before, const PoseRange& free_poses, GraphState& state) const {
  if (free_poses.empty()) return;
  std::map<int, Pose2> T_after_before;
  for (std::size_t i = free_poses.from; i < free_poses.to; ++i)
    T_after_before[nodes.views()[i].robot] = state.pose(i) * before.pose(i).inverse();
  for (std::size_t i = free_poses.to; i < state.poses.size(); ++i) {
    const auto moved = T_after_before.find(nodes.views()[i].robot);
    if (moved == T_after_before.end()) continue;
    const Pose2 pose = moved->second * before.pose(i);
    state.poses[i] = {pose.x(), pose.y(), pose.heading()};
  }
}

/// Outward from the start, a few metres of way at a time. The poses of the last metres are free, so that a slip of SLAM
/// is taken back where it happened, before the plan is bent by it.
Result<Ok> AutoCompleteGraph::Impl::take_up(Learnt& l, const Progress& progress) const {
  const double all = nodes.way_m().back();
  while (l.taken_way_m < all) {
    l.taken_way_m = std::min(all, l.taken_way_m + kTakeUp_m);
    std::vector<bool> use = nodes.spaced();
    for (std::size_t i = 0; i < use.size(); ++i) use[i] = use[i] && nodes.way_m()[i] <= l.taken_way_m;
    PoseRange window{0, use.size()};
    while (window.to > 0 && nodes.way_m()[window.to - 1] > l.taken_way_m) --window.to;
    while (window.from < window.to && nodes.way_m()[window.from] < l.taken_way_m - kWindow_m) ++window.from;
    SolveInput input;
    if (const auto done = round(l, use, 1.0, {}, progress, &input); !done) return done.error();
    if (const auto done = round(l, use, 0.4, window, progress, &input); !done) return done.error();
    if (const auto done = release_tense(l, input, progress); !done) return done.error();
    progress.tell(0.6 * l.taken_way_m / std::max(1e-6, all), "taking up the plan");
  }
  return Ok{};
}

}  // namespace smokemap
