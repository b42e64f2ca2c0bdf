#include <algorithm>
#include <cmath>

#include "acg/graph_impl.hpp"
#include "acg/plan_stretch.hpp"
#include "acg/wall_rivals.hpp"

namespace smokemap {
namespace {

constexpr double kEnoughWay_m = 2.0;    ///< of way, before other places of drawn lines are looked for
constexpr double kSearchAgain_m = 3.0;  ///< of new way, before that is done again
constexpr double kOtherPlace_m = 0.4;   ///< a line that would move by less is in the same place
constexpr int kRearrangements = 4;      ///< each may reach as far as LineChain does
constexpr double kGain = 0.3;           ///< log odds, from which a line has a reason to move
constexpr double kBetter = 0.005;       ///< of standing; the beliefs have weighed the arrangement itself
constexpr double kRivalIsIt = 0.3;      ///< probability that a wall's rival is the drawn one
constexpr double kDoubt = 0.05;         ///< a probability of another place that is as good as none

/// Per line: what the chance adds that it, or the nearest one seen well, is really elsewhere. Lines that nobody saw go
/// with those; how far they may be from them the normal equations know.
std::vector<double> doubted_variance(const PlanModel& plan, std::size_t axis, const std::vector<LineBelief>& beliefs,
                                     const std::vector<double>& seen_m) {
  const auto variance = [](const LineBelief& belief) {
    return belief.elsewhere > kDoubt ? belief.elsewhere * belief.apart_m * belief.apart_m : 0;
  };
  std::vector<double> out(plan.lines[axis].size(), 0);
  for (std::size_t k = 0; k < out.size() && !beliefs.empty(); ++k) {
    double nearest = 1e9;
    for (std::size_t s = 0; s < out.size(); ++s) {
      const double away = std::abs(plan.lines[axis][s] - plan.lines[axis][k]);
      if (seen_m[s] < kLineSeen_m || away >= nearest) continue;
      nearest = away;
      out[k] = variance(beliefs[s]);
    }
    if (!beliefs.empty() && seen_m[k] > 0) out[k] = std::max(out[k], variance(beliefs[k]));
  }
  return out;
}

}  // namespace

LineHolds AutoCompleteGraph::Impl::line_holds(const Learnt& l) const {
  LineHolds holds;
  holds.gone.assign(plan->walls.size(), false);
  for (const auto& [wall, word] : judgements) holds.gone[static_cast<std::size_t>(wall)] = word == WallJudgement::kGone;
  for (const auto& [corner, p_map] : pins) holds.held_corners.push_back(corner);
  for (const AnchorLink& a : anchor_links(l))
    holds.held_corners.insert(holds.held_corners.end(), a.corners.begin(), a.corners.end());
  if (start) {
    holds.start_map = l.state.pose(0).translation();
    holds.start_layout = start->T_layout_robot.translation();
    holds.start_sigma_m = std::max(0.1, start->sigma_m);
  }
  return holds;
}

/// Links are made where the plan is expected, so a strip that was caught one wall too far stays there. Here all places
/// of all lines are compared at once, and another arrangement is taken if the whole graph stands clearly better with
/// it. What stays ambiguous is remembered in the beliefs.
Result<Ok> AutoCompleteGraph::Impl::rearrange(Learnt& l, SolveInput& last, const Progress& progress) const {
  const double way = nodes.way_m().back();
  if (way < kEnoughWay_m || (way < l.searched_way_m + kSearchAgain_m && !words_changed)) return Ok{};
  for (int attempt = 0; attempt <= kRearrangements; ++attempt) {
    l.beliefs = search_lines(nodes.views(), nodes.spaced(), *plan, l.state, line_holds(l), params);
    bool better = false;
    for (const std::size_t axis : {0u, 1u})
      for (const auto way_to_move : {&LineBelief::alone, &LineBelief::together}) {
        if (better || attempt == kRearrangements) continue;
        std::vector<LineBelief::Move> moves;
        for (const LineBelief& belief : l.beliefs[axis]) moves.push_back(belief.*way_to_move);
        const auto done = rearrange_axis(axis, moves, l, last, progress);
        if (!done) return done.error();
        better = *done;
      }
    if (!better) break;
  }
  l.searched_way_m = way;
  return Ok{};
}

/// True if the lines of this axis were moved and the graph stands better.
Result<bool> AutoCompleteGraph::Impl::rearrange_axis(std::size_t axis, const std::vector<LineBelief::Move>& moves,
                                                     Learnt& l, SolveInput& last, const Progress& progress) const {
  const auto elsewhere = [](const LineBelief::Move& move) { return std::abs(move.move_m) > kOtherPlace_m; };
  if (std::none_of(moves.begin(), moves.end(), [&](const auto& m) { return elsewhere(m) && m.gain > kGain; }))
    return false;
  const auto line_moves = [&](int corner) {
    return elsewhere(moves[static_cast<std::size_t>(plan->line_of_corner[axis][static_cast<std::size_t>(corner)])]);
  };
  Learnt other = l;
  for (std::size_t w = 0; w < plan->walls.size(); ++w) {
    if (!line_moves(plan->walls[w].corner_a) && !line_moves(plan->walls[w].corner_b)) continue;
    other.walls[w] = WallState::kUnseen;
    other.linked_m[w] = other.near_m[w] = 0;
  }
  std::vector<double> moves_m;
  for (const LineBelief::Move& move : moves) moves_m.push_back(move.move_m);
  move_lines(*plan, axis, moves_m, other.state);
  SolveInput input;
  if (const auto done = correct(other, false, progress, input); !done) return done.error();
  if (standing(input, nodes.spaced(), other) < standing(last, nodes.spaced(), l) + kBetter) return false;
  l = std::move(other);
  last = std::move(input);
  return true;
}

/// Probability that a wall is really elsewhere.
double AutoCompleteGraph::Impl::doubt_of(const Learnt& l, std::size_t wall) const {
  const double beside = wall < l.rivals_m.size() && l.rivals_m[wall] > 0 ? kRivalIsIt : 0;
  return std::max(beside, line_doubt_of(l, wall));
}

double AutoCompleteGraph::Impl::line_doubt_of(const Learnt& l, std::size_t wall) const {
  const int axis = plan->offset_axis(plan->walls[wall]);
  if (axis < 0 || l.beliefs[static_cast<std::size_t>(axis)].empty()) return 0;
  const auto& line_of = plan->line_of_corner[static_cast<std::size_t>(axis)];
  const auto line = static_cast<std::size_t>(line_of[static_cast<std::size_t>(plan->walls[wall].corner_a)]);
  return l.beliefs[static_cast<std::size_t>(axis)][line].elsewhere;
}

AcgParams AutoCompleteGraph::Impl::stretch_learnt(const Learnt& l) const {
  AcgParams out = params;
  out.sigma_wall_log_length = learnt_stretch(*plan, l.state, l.walls, l.linked_m, params);
  return out;
}

/// From the normal equations, with the stretch that this plan turned out to have, and from what is ambiguous.
Result<Ok> AutoCompleteGraph::Impl::work_out_sigmas(const SolveInput& last, const PoseGraph& graph, Learnt& l) const {
  if (l.sigma_m.size() == plan->corners.size() && l.updates % params.covariance_every != 0) return Ok{};
  std::map<std::string, std::size_t> newest;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) newest[graph.nodes[i].robot] = i;
  std::vector<std::size_t> poses;
  for (const auto& [robot, i] : newest) poses.push_back(i);
  auto sigmas = sigmas_at(last, stretch_learnt(l), l.state, poses);
  if (!sigmas) return sigmas.error();
  l.sigma_m = std::move(sigmas->corners_m);
  l.robot_sigma_m.clear();
  for (auto sigma = sigmas->poses_m.begin(); const auto& [robot, i] : newest) l.robot_sigma_m[robot] = *sigma++;
  for (const std::size_t axis : {0u, 1u}) {
    const std::vector<double> variance =
        doubted_variance(*plan, axis, l.beliefs[axis], seen_on_lines_m(*plan, axis, l.walls, l.linked_m));
    for (std::size_t c = 0; c < l.sigma_m.size(); ++c) {
      const auto line = static_cast<std::size_t>(plan->line_of_corner[axis][c]);
      l.sigma_m[c] = std::hypot(l.sigma_m[c], std::sqrt(0.5 * variance[line]));
    }
  }
  l.rivals_m = wall_rivals_m(nodes.views(), nodes.spaced(), *plan, l.state, l.walls);
  std::vector<double> beside_m(l.sigma_m.size(), 0);
  for (std::size_t w = 0; w < l.rivals_m.size(); ++w)
    for (const int c : {plan->walls[w].corner_a, plan->walls[w].corner_b})
      beside_m[static_cast<std::size_t>(c)] = std::max(beside_m[static_cast<std::size_t>(c)], l.rivals_m[w]);
  for (std::size_t c = 0; c < beside_m.size(); ++c)
    l.sigma_m[c] = std::hypot(l.sigma_m[c], std::sqrt(0.5 * kRivalIsIt) * beside_m[c]);
  return Ok{};
}

}  // namespace smokemap
