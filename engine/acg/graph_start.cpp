#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "acg/gates.hpp"
#include "acg/graph_impl.hpp"

namespace smokemap {
namespace {

constexpr double kAlignWay_m = 4.0;    ///< of way whose scans align the plan to a start
constexpr double kAlignReach_m = 5.0;  ///< farther hits would see too much of the plan's stretch
constexpr double kGlobalReach_m = 8.0;
constexpr double kCloserLook_m = 9.0;       ///< of way on which rival alignments are compared
constexpr double kTension = 0.02;           ///< share of explained length that one squared sigma per wall is worth
constexpr double kGlobalWay_m = 8.0;        ///< of way before a plan is looked for without any hint
constexpr double kGlobalLook_m = 20.0;      ///< of way on which rivals without a hint are compared
constexpr double kGlobalStanding = 0.45;    ///< below, an alignment without a hint is not believed
constexpr double kGlobalLead = 0.08;        ///< by which it must beat the best one somewhere else
constexpr double kRetry = 1.3;              ///< times the way, before a search without a hint is tried again
constexpr double kLookAgain = 1.5;          ///< times the way, before the alignment is questioned
constexpr double kSettled_m = 15.0;         ///< of way; an alignment that fits is not questioned any more
constexpr double kDoubtfulStanding = 0.60;  ///< right merges stand at 0.6 to 0.85
constexpr double kClearlyBetter = 0.03;
constexpr double kElsewhere_m = 1.0;  ///< mean over corners; alignments that end nearer are the same

/// An alignment after a closer look.
struct StartTrial {
  double score = 0;
  std::vector<std::array<double, 2>> corners;
  PlanPlacement placement;
};

double corners_apart_m(const std::vector<std::array<double, 2>>& a, const std::vector<std::array<double, 2>>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::hypot(a[i][0] - b[i][0], a[i][1] - b[i][1]);
  return sum / static_cast<double>(std::max<std::size_t>(1, a.size()));
}

}  // namespace

bool AutoCompleteGraph::Impl::align(Learnt& l) const {
  StartSearch search;
  search.scale_sigma = std::max(0.05, plan->scale_sigma);
  double way = kAlignWay_m;
  if (anchors.size() >= 2) {
    if (const auto fit = fit_similarity(trusted_pairs(anchor_pairs(), outlying_anchors(l))); fit.ok()) {
      put_down(PlanPlacement::from(*fit, plan->axis_rad), l);
      return true;
    }
  }
  if (start) {
    const Pose2 T_map_layout = l.state.pose(0) * start->T_layout_robot.inverse();
    search.guess = Similarity2{1, T_map_layout};
    search.sigma_m = std::max(0.05, start->sigma_m);
    search.sigma_rad = std::max(0.01, start->sigma_rad);
  } else {
    way = std::min(30.0, nodes.way_m().back());
    if (way < std::max(kGlobalWay_m, kRetry * l.aligned_way_m)) return false;
  }
  l.aligned_way_m = nodes.way_m().back();
  const auto found = align_plan(*plan, first_hits(nodes.views(), l.state, way, start ? kAlignReach_m : kGlobalReach_m),
                                l.state.pose(0).translation(), search);
  if (!found) {
    if (search.guess) put_down(PlanPlacement::from(*search.guess, plan->axis_rad), l);
    return false;
  }
  return choose(*found, l);
}

/// Tries each alignment on the first metres of way with the full model and keeps the one that stands best. Without a
/// hint it must stand well, and clearly better than any that came to lie elsewhere.
bool AutoCompleteGraph::Impl::choose(const std::vector<PlanAlignment>& found, Learnt& l) const {
  std::vector<StartTrial> trials;
  for (const PlanAlignment& a : found) {
    Learnt trial = l;
    put_down(a.placement, trial);
    const double way = start ? kCloserLook_m : kGlobalLook_m;
    const double score = found.size() > 1 || !start ? first_metres_explained(trial, way) : 0;
    trials.push_back({score, std::move(trial.state.corners), a.placement});
  }
  const auto best = std::max_element(trials.begin(), trials.end(),
                                     [](const StartTrial& a, const StartTrial& b) { return a.score < b.score; });
  const bool rivalled = std::any_of(trials.begin(), trials.end(), [&](const StartTrial& t) {
    return t.score > best->score - kGlobalLead && corners_apart_m(t.corners, best->corners) > kElsewhere_m;
  });
  if (!start && (best->score < kGlobalStanding || rivalled)) return false;
  put_down(best->placement, l);
  return true;
}

double AutoCompleteGraph::Impl::first_metres_explained(Learnt& trial, double way_m) const {
  SolveInput input;
  std::vector<bool> use = nodes.spaced();
  for (std::size_t i = 0; i < use.size(); ++i) use[i] = use[i] && nodes.way_m()[i] <= way_m;
  for (const double share : {0.4, 1.0}) {
    std::vector<bool> part = use;
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = part[i] && nodes.way_m()[i] <= share * way_m;
    for (const double sharpness : {1.0, 0.4})
      if (!round(trial, part, sharpness, {}, {}, &input)) return 0;
  }
  return standing(input, use, trial);
}

/// How well a way to lay down the plan stands: the share of what was sensed that it explains, less what it costs in
/// bent walls.
double AutoCompleteGraph::Impl::standing(const SolveInput& input, const std::vector<bool>& use, const Learnt& l) const {
  double linked = 0, all = 0;
  for (std::size_t i = 0; i < use.size(); ++i)
    if (use[i])
      for (const ScanPiece& p : nodes.views()[i].pieces) all += p.segment.length();
  for (const PieceLink& link : input.links) linked += link.weight * link.part_robot.length();
  return all > 0 ? linked / all - kTension * plan_tension(*plan, l.state, params) : 0;
}

/// A plan that was laid down after the first glance is questioned while the robot sees more; one that hardly stands is
/// taken up again with walls looked for nearer and farther, for a wall caught by its neighbour drags all behind it.
Result<Ok> AutoCompleteGraph::Impl::question(Learnt& l, SolveInput& last, const Progress& progress) const {
  const double way = nodes.way_m().back();
  const bool more_seen = way > 1 && way >= kLookAgain * l.aligned_way_m && (way < kSettled_m || !l.fits);
  const bool first = l.updates == 0 && way > kCloserLook_m;
  if (anchors.size() >= 2 || !(more_seen || first)) return Ok{};
  std::vector<double> gate_shares{1.0};
  if (way > kCloserLook_m && standing(last, nodes.spaced(), l) < kDoubtfulStanding) gate_shares = {0.5, 1.0, 1.6};
  for (const double share : gate_shares) {
    if (!more_seen && share == l.gate_share) continue;
    if (const auto done = look_again(share, l, last, progress); !done) return done;
  }
  l.aligned_way_m = way;
  return Ok{};
}

/// Lays the plan down anew with everything seen since, and keeps that if it stands clearly better.
Result<Ok> AutoCompleteGraph::Impl::look_again(double gate_share, Learnt& l, SolveInput& last,
                                               const Progress& progress) const {
  Learnt other = l;
  other.state.poses = nodes.slam_poses();
  other.gate_share = gate_share;
  other.aligned_way_m = 0;
  if (!align(other)) return Ok{};
  SolveInput input;
  if (const auto done = take_up(other, progress); !done) return done.error();
  if (const auto done = correct(other, false, progress, input); !done) return done.error();
  if (standing(input, nodes.spaced(), other) < standing(last, nodes.spaced(), l) + kClearlyBetter) return Ok{};
  l = std::move(other);
  last = std::move(input);
  return Ok{};
}

void AutoCompleteGraph::Impl::put_down(const PlanPlacement& s, Learnt& l) const {
  l.state.turn = s.turn_rad;
  l.state.log_scale = s.scale.array().log().mean();
  l.state.corners.clear();
  for (const Point2& p : plan->corners) {
    const Point2 q = s * p;
    l.state.corners.push_back({q.x(), q.y()});
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double heading = plan->axis_rad + static_cast<double>(axis) * kPi / 2;
    const Point2 u(std::cos(heading), std::sin(heading)), u_map = Pose2(0, 0, l.state.turn) * u;
    l.state.lines[axis].clear();
    for (const double at : plan->lines[axis]) l.state.lines[axis].push_back(u_map.dot(s * (at * u)));
  }
  l.walls.assign(plan->walls.size(), WallState::kUnseen);
  l.linked_m.assign(plan->walls.size(), 0);
  l.near_m.assign(plan->walls.size(), 0);
  l.sigma_m.clear();
  l.taken_way_m = 0;
  l.searched_way_m = 0;
  l.beliefs = {};
}

}  // namespace smokemap
