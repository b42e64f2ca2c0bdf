#include "acg/auto_complete_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "acg/association.hpp"
#include "acg/first_alignment.hpp"
#include "acg/gates.hpp"
#include "acg/new_walls.hpp"
#include "acg/node_store.hpp"
#include "acg/read_out.hpp"
#include "acg/solver.hpp"
#include "acg/wall_evidence.hpp"
#include "core/check.hpp"
#include "geometry/delaunay.hpp"

namespace smokemap {
namespace {

constexpr double kTakeUp_m = 3.0;         ///< of way between two rounds while the plan is taken up
constexpr double kAlignWay_m = 4.0;       ///< of way whose scans align the plan to a start
constexpr double kAlignReach_m = 5.0;     ///< farther hits would see too much of the plan's stretch
constexpr double kGlobalReach_m = 8.0;
constexpr double kCloserLook_m = 9.0;     ///< of way on which rival alignments are compared
constexpr double kTension = 0.02;         ///< share of explained length that one squared sigma per wall is worth
constexpr double kGlobalWay_m = 8.0;      ///< the same without any hint
constexpr double kGlobalExplained = 0.55; ///< share of hits on walls before an alignment without a hint is believed
constexpr double kGlobalMargin = 0.06;
constexpr double kFinest_m = 0.08;        ///< last robust width
constexpr int kReweights = 2;

struct Anchor {
  Point2 p_px, p_map;
};

}  // namespace

Result<Ok> AcgParams::validate() const {
  return ParamCheck("AcgParams")
      .positive("sigma_wall_log_length", sigma_wall_log_length)
      .positive("sigma_wall_turn_rad", sigma_wall_turn_rad)
      .positive("sigma_corner_draw_m", sigma_corner_draw_m)
      .positive("stretch_length_m", stretch_length_m)
      .positive("sigma_scale_log", sigma_scale_log)
      .positive("sigma_point_m", sigma_point_m)
      .positive("sigma_end_m", sigma_end_m)
      .positive("min_piece_m", min_piece_m)
      .positive("node_spacing_m", node_spacing_m)
      .in_range("gate_end_m", gate_end_m, 0.05, gate_start_m)
      .in_range("gate_angle_rad", gate_angle_rad, 0.01, kPi / 2)
      .in_range("rounds", rounds, 1, 50)
      .in_range("missing_share", missing_share, 0.05, 1)
      .in_range("fits_not_below", fits_not_below, 0, fits_above)
      .in_range("fits_above", fits_above, 0, 1)
      .in_range("covariance_every", covariance_every, 1, 1000)
      .result();
}

class AutoCompleteGraph::Impl {
 public:
  explicit Impl(const AcgParams& p) : params(p), nodes(p) {}

  /// What a failed update must not change is kept here and copied.
  struct Learnt {
    GraphState state;
    bool aligned = false;
    double taken_way_m = 0;
    std::vector<WallState> walls;
    std::vector<double> linked_m, near_m;  ///< per wall: length with pieces on it, within its gate
    std::vector<double> sigma_m;
    int updates = 0;
  };

  Result<MergedMap> update(const PoseGraph& graph, const Progress& progress);
  bool align(Learnt& learnt) const;
  void choose(const std::vector<PlanAlignment>& found, Learnt& learnt) const;
  double first_metres_explained(Learnt trial) const;
  void put_down(const PlanPlacement& placement, Learnt& learnt) const;
  Result<Ok> take_up(Learnt& learnt, const Progress& progress) const;
  Result<Ok> release_tense(Learnt& learnt, const SolveInput& input, const Progress& progress) const;
  Result<Ok> round(Learnt& learnt, const std::vector<bool>& use, double sharpness, bool poses_fixed,
                   const Progress& progress, SolveInput* kept) const;
  SolveInput make_input(const Learnt& learnt, bool poses_fixed) const;
  std::vector<AnchorLink> anchor_links() const;
  void judge_walls(const std::vector<WallEvidence>& evidence, Learnt& learnt) const;
  MergedMap read_out(const PoseGraph& graph, const SolveInput& input, Learnt& learnt) const;
  PlanFit plan_fit(const SolveInput& input, const Learnt& learnt) const;

  AcgParams params;
  NodeStore nodes;
  LayoutMap layout;
  std::optional<PlanModel> plan;
  std::optional<PlanStart> start;
  std::map<std::string, Anchor> anchors;
  std::map<int, WallJudgement> judgements;
  Learnt learnt;
  int revision = 0;
};

bool AutoCompleteGraph::Impl::align(Learnt& l) const {
  AlignmentSearch search;
  search.scale_sigma = std::max(0.05, plan->scale_sigma);
  double way = kAlignWay_m;
  if (anchors.size() >= 2) {
    std::vector<PointPair> pairs;
    const PixelFrame frame{layout.height_px, plan->metres_per_pixel};
    for (const auto& [id, a] : anchors) pairs.push_back({a.p_map, frame.to_metres(a.p_px), 0.1});
    if (const auto fit = fit_similarity(pairs); fit.ok()) {
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
    way = kGlobalWay_m;
    if (nodes.way_m().back() < way) return false;
    way = std::max(way, std::min(30.0, nodes.way_m().back()));
  }
  const auto found = align_plan(*plan, first_hits(nodes.views(), l.state, way, start ? kAlignReach_m : kGlobalReach_m),
                                l.state.pose(0).translation(), search);
  if (!found) {
    if (search.guess) put_down(PlanPlacement::from(*search.guess, plan->axis_rad), l);
    return false;
  }
  if (!start && (found->front().explained < kGlobalExplained || found->front().margin < kGlobalMargin)) return false;
  choose(*found, l);
  return true;
}

/// Tries each alignment on the first metres of way with the full model and keeps the one that explains most.
void AutoCompleteGraph::Impl::choose(const std::vector<PlanAlignment>& found, Learnt& l) const {
  Learnt best;
  double best_score = -1;
  for (const PlanAlignment& a : found) {
    Learnt trial = l;
    put_down(a.placement, trial);
    const double score = found.size() > 1 ? first_metres_explained(trial) : 0;
    if (score <= best_score) continue;
    best_score = score;
    best = l;
    put_down(a.placement, best);
  }
  l = std::move(best);
}

double AutoCompleteGraph::Impl::first_metres_explained(Learnt trial) const {
  SolveInput input;
  std::vector<bool> use = nodes.spaced();
  for (std::size_t i = 0; i < use.size(); ++i) use[i] = use[i] && nodes.way_m()[i] <= kCloserLook_m;
  for (const double way : {0.4, 1.0}) {
    std::vector<bool> part = use;
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = part[i] && nodes.way_m()[i] <= way * kCloserLook_m;
    for (const double sharpness : {1.0, 0.4})
      if (!round(trial, part, sharpness, true, {}, &input)) return 0;
  }
  double linked = 0, all = 0;
  for (std::size_t i = 0; i < use.size(); ++i)
    if (use[i])
      for (const ScanPiece& p : nodes.views()[i].pieces) all += p.segment.length();
  for (const PieceLink& link : input.links) linked += link.weight * link.part_robot.length();
  return all > 0 ? linked / all - kTension * plan_tension(*plan, trial.state, params) : 0;
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
}

std::vector<AnchorLink> AutoCompleteGraph::Impl::anchor_links() const {
  std::vector<AnchorLink> links;
  const PixelFrame frame{layout.height_px, plan->metres_per_pixel};
  for (const auto& [id, a] : anchors) {
    // The three nearest corners that are not in line carry the point.
    const Point2 p = frame.to_metres(a.p_px);
    std::vector<int> order(plan->corners.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    const auto at = [&](int i) -> const Point2& { return plan->corners[static_cast<std::size_t>(i)]; };
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return (at(i) - p).norm() < (at(j) - p).norm(); });
    for (std::size_t k = 2; k < order.size(); ++k) {
      const Point2 u = at(order[1]) - at(order[0]), v = at(order[k]) - at(order[0]);
      if (u.norm() < 0.05 || std::abs(u.x() * v.y() - u.y() * v.x()) < 0.3 * u.norm() * v.norm()) continue;
      links.push_back({{order[0], order[1], order[k]}, barycentric(p, at(order[0]), at(order[1]), at(order[k])), a.p_map});
      break;
    }
  }
  return links;
}

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
  const std::vector<double> gates = wall_gates_m(*plan, l.state, l.walls, l.linked_m, params);
  SolveInput input = make_input(l, poses_fixed);
  input.links = link_pieces(nodes.views(), use, *plan, l.state, gates, params);
  std::vector<double> end_gates;
  for (const double g : gates) end_gates.push_back(g > 0 ? std::clamp(g, 0.3, 0.6) : 0);
  const BeamReading beams = read_beams(nodes.views(), use, *plan, l.state, end_gates, params);
  input.ends = beams.ends;
  for (PieceLink& link : input.links)
    link.weight = robust_weight(link.misfit_m, std::max(kFinest_m, sharpness * gates[static_cast<std::size_t>(link.wall)]));
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

PlanFit AutoCompleteGraph::Impl::plan_fit(const SolveInput& input, const Learnt& l) const {
  double linked = 0, all = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes.spaced()[i])
      for (const ScanPiece& p : nodes.views()[i].pieces) all += p.segment.length();
  for (const PieceLink& link : input.links) linked += link.weight > 0.3 ? link.part_robot.length() : 0;
  PlanFit fit;
  if (all < 10 || !l.aligned) return fit;
  fit.score = std::min(1.0, linked / all);
  fit.verdict = fit.score >= params.fits_above ? "fits" : fit.score >= params.fits_not_below ? "doubtful" : "does not fit";
  return fit;
}

MergedMap AutoCompleteGraph::Impl::read_out(const PoseGraph& graph, const SolveInput& input, Learnt& l) const {
  MergedMap out;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    StampedPose pose;
    pose.stamp = graph.nodes[i].stamp;
    pose.T_map_robot = l.state.pose(i);
    out.trajectory.push_back(pose);
  }
  std::vector<bool> there;
  if (plan && !l.state.corners.empty()) {
    SolvedPlan solved{&layout, &*plan, &l.state, {}, l.linked_m, {}, l.sigma_m, input.links};
    const std::vector<double> no_ends(plan->walls.size(), 0);
    solved.evidence = read_beams(nodes.views(), nodes.spaced(), *plan, l.state, no_ends, params).walls;
    judge_walls(solved.evidence, l);
    solved.wall_states = l.walls;
    read_out_plan(solved, params, out);
    for (const WallState s : l.walls) there.push_back(s != WallState::kMissing);
    out.fit = plan_fit(input, l);
  }
  const bool with_plan = !there.empty();
  read_out_new_walls(find_new_walls(nodes.views(), nodes.spaced(), with_plan ? &*plan : nullptr, l.state, there, params), out);
  return out;
}

Result<MergedMap> AutoCompleteGraph::Impl::update(const PoseGraph& graph, const Progress& progress) {
  Learnt work = learnt;
  nodes.take(graph, work.state);
  SolveInput input;
  if (plan && nodes.size() > 0) {
    if (!work.aligned) work.aligned = align(work);
    if (work.aligned) {
      if (const auto done = take_up(work, progress); !done) return done.error();
      double sharpness = 0.6;
      for (int k = 0; k < params.rounds; ++k, sharpness *= 0.6) {
        const bool poses_fixed = k < params.rounds / 2;
        if (const auto done = round(work, nodes.spaced(), sharpness, poses_fixed, progress, &input); !done) return done.error();
        progress.tell(0.6 + 0.3 * (k + 1) / params.rounds, "correcting plan and map");
      }
      if (work.sigma_m.size() != plan->corners.size() || work.updates % params.covariance_every == 0) {
        auto sigmas = corner_sigmas_m(input, params, work.state);
        if (!sigmas) return sigmas.error();
        work.sigma_m = std::move(*sigmas);
      }
      ++work.updates;
    } else {
      work.sigma_m.assign(plan->corners.size(), start ? 1.0 : 10.0);
    }
  }
  MergedMap out = read_out(graph, input, work);
  out.revision = ++revision;
  learnt = std::move(work);
  return out;
}

AutoCompleteGraph::AutoCompleteGraph(const AcgParams& params) : impl_(std::make_unique<Impl>(params)) {
  ENGINE_EXPECT(params.validate().ok());
}
AutoCompleteGraph::~AutoCompleteGraph() = default;
AutoCompleteGraph::AutoCompleteGraph(AutoCompleteGraph&&) noexcept = default;
AutoCompleteGraph& AutoCompleteGraph::operator=(AutoCompleteGraph&&) noexcept = default;

Result<Ok> AutoCompleteGraph::set_plan(const LayoutMap& plan, const std::optional<PlanStart>& start) {
  auto model = make_plan_model(plan, impl_->params);
  if (!model) return model.error();
  clear_plan();
  impl_->layout = plan;
  impl_->plan = std::move(*model);
  impl_->start = start;
  return Ok{};
}

void AutoCompleteGraph::clear_plan() {
  impl_->plan.reset();
  impl_->start.reset();
  impl_->anchors.clear();
  impl_->judgements.clear();
  const GraphState poses{impl_->learnt.state.poses, {}, 0, 0, {}};
  impl_->learnt = {};
  impl_->learnt.state = poses;
}

void AutoCompleteGraph::set_start(const PlanStart& start) {
  impl_->start = start;
  impl_->learnt.aligned = false;
  impl_->learnt.state.corners.clear();
}

void AutoCompleteGraph::add_anchor(const std::string& id, const Point2& p_layout_px, const Point2& p_map) {
  impl_->anchors[id] = {p_layout_px, p_map};
  if (impl_->anchors.size() == 2 && !impl_->start) impl_->learnt.aligned = false;
}

void AutoCompleteGraph::remove_anchor(const std::string& id) { impl_->anchors.erase(id); }

Result<Ok> AutoCompleteGraph::judge_wall(int layout_wall, WallJudgement judgement) {
  if (!impl_->plan || layout_wall < 0 || layout_wall >= static_cast<int>(impl_->plan->walls.size()))
    return fail(Errc::kNotFound, "the plan has no wall " + std::to_string(layout_wall));
  impl_->judgements[layout_wall] = judgement;
  return Ok{};
}

Result<MergedMap> AutoCompleteGraph::update(const PoseGraph& slam_graph, const Progress& progress) {
  return impl_->update(slam_graph, progress);
}

}  // namespace smokemap
