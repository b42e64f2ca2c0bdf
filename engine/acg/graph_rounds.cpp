#include <algorithm>
#include <cmath>

#include "acg/association.hpp"
#include "acg/gates.hpp"
#include "acg/graph_impl.hpp"
#include "acg/wall_evidence.hpp"

namespace smokemap {
namespace {

constexpr double kTakeUp_m = 3.0;   ///< of way between two rounds while the plan is taken up
constexpr double kFinest_m = 0.08;  ///< last robust width
constexpr int kReweights = 2;

}  // namespace

SolveInput AutoCompleteGraph::Impl::make_input(const Learnt& l, bool poses_fixed) const {
  SolveInput input;
  input.plan = &*plan;
  input.edges = nodes.edges();
  input.anchors = anchor_links();
  input.poses_fixed = poses_fixed;
  input.iterations = poses_fixed ? 6 : 8;
  for (const WallState state : l.walls) input.wall_firmness.push_back(state == WallState::kMissing ? 0.1 : 1.0);
  return input;
}

/// One round: links with the estimates as they are, then solves with weights that tighten.
Result<Ok> AutoCompleteGraph::Impl::round(Learnt& l, const std::vector<bool>& use, double sharpness, bool poses_fixed,
                                          const Progress& progress, SolveInput* kept) const {
  const std::vector<double> gates = wall_gates_m(*plan, l.walls, l.linked_m, params);
  SolveInput input = make_input(l, poses_fixed);
  input.links = link_pieces(nodes.views(), use, *plan, l.state, gates, params);
  std::vector<double> end_gates;
  for (const double g : gates) end_gates.push_back(g > 0 ? std::clamp(g, 0.3, 0.6) : 0);
  const BeamReading beams = read_beams(nodes.views(), use, *plan, l.state, end_gates);
  input.ends = beams.ends;
  for (PieceLink& link : input.links)
    link.weight =
        robust_weight(link.misfit_m, std::max(kFinest_m, sharpness * gates[static_cast<std::size_t>(link.wall)]));
  l.linked_m = linked_length_m(input.links, *plan, l.state);
  l.near_m = linked_length_m(input.links, *plan, l.state, 0);
  drop_immature(l.near_m, *plan, params, input.links);
  judge_walls(beams.walls, l);
  for (int k = 0; k < kReweights; ++k) {
    if (const auto done = solve(input, params, progress, l.state); !done) return done.error();
    for (PieceLink& link : input.links) {
      if (link.weight <= 0) continue;
      link.misfit_m = misfit_m(link, *plan, l.state);
      const double c = std::max(kFinest_m, 0.7 * sharpness * gates[static_cast<std::size_t>(link.wall)]);
      link.weight = robust_weight(link.misfit_m, c);
    }
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
  for (PieceLink& link : without.links)
    if (tense[static_cast<std::size_t>(link.wall)]) link.weight = 0;
  return solve(without, params, progress, l.state);
}

void AutoCompleteGraph::Impl::judge_walls(const std::vector<WallEvidence>& evidence, Learnt& l) const {
  for (std::size_t w = 0; w < evidence.size(); ++w) {
    l.walls[w] = judge_wall_state(evidence[w], l.linked_m[w], l.near_m[w], params);
    const auto word = judgements.find(static_cast<int>(w));
    if (word == judgements.end() || word->second == WallJudgement::kNone) continue;
    l.walls[w] = word->second == WallJudgement::kGone ? WallState::kMissing : WallState::kConfirmed;
  }
}

/// Outward from the start, a few metres of way at a time, with the poses as SLAM has them.
Result<Ok> AutoCompleteGraph::Impl::take_up(Learnt& l, const Progress& progress) const {
  const double all = nodes.way_m().back();
  while (l.taken_way_m < all) {
    l.taken_way_m = std::min(all, l.taken_way_m + kTakeUp_m);
    std::vector<bool> use = nodes.spaced();
    for (std::size_t i = 0; i < use.size(); ++i) use[i] = use[i] && nodes.way_m()[i] <= l.taken_way_m;
    SolveInput input;
    for (const double sharpness : {1.0, 0.4}) {
      if (const auto done = round(l, use, sharpness, true, progress, &input); !done) return done.error();
    }
    if (const auto done = release_tense(l, input, progress); !done) return done.error();
    progress.tell(0.6 * l.taken_way_m / std::max(1e-6, all), "taking up the plan");
  }
  return Ok{};
}

}  // namespace smokemap
