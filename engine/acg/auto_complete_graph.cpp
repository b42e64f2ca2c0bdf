#include "acg/auto_complete_graph.hpp"

#include <algorithm>
#include <cmath>

#include "acg/association.hpp"
#include "acg/graph_impl.hpp"
#include "acg/new_walls.hpp"
#include "acg/wall_evidence.hpp"
#include "core/check.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr int kWarmRounds = 1;
constexpr double kMostDoubted = 0.10;  ///< of the confirmed wall length, in a plan that fits
constexpr double kWarmWay_m = 4.0;     ///< more new way than this is no small growth

}  // namespace

Result<Ok> AcgParams::validate() const {
  return ParamCheck("AcgParams")
      .positive("sigma_wall_log_length", sigma_wall_log_length)
      .positive("sigma_wall_turn_rad", sigma_wall_turn_rad)
      .positive("sigma_corner_draw_m", sigma_corner_draw_m)
      .positive("stretch_length_m", stretch_length_m)
      .positive("sigma_point_m", sigma_point_m)
      .positive("sigma_end_m", sigma_end_m)
      .positive("sigma_seen_corner_m", sigma_seen_corner_m)
      .positive("min_piece_m", min_piece_m)
      .positive("node_spacing_m", node_spacing_m)
      .positive("gate_start_m", gate_start_m)
      .in_range("gate_end_m", gate_end_m, 0.05, gate_start_m)
      .in_range("gate_angle_rad", gate_angle_rad, 0.01, kPi / 2)
      .in_range("rounds", rounds, 1, 50)
      .positive("mature_m", mature_m)
      .positive("new_wall_min_m", new_wall_min_m)
      .positive("moved_m", moved_m)
      .in_range("missing_share", missing_share, 0.05, 1)
      .in_range("fits_not_below", fits_not_below, 0, fits_above)
      .in_range("fits_above", fits_above, 0, 1)
      .in_range("covariance_every", covariance_every, 1, 1000)
      .result();
}

/// Asked from both sides, for each alone can be fooled: how much of what was sensed the plan explains (furniture is not
/// drawn), and on how much of the wall length that sensors spoke about plan and sensors agree (a plan bent onto the
/// wrong walls has many that beams go through, and leaves many to be new). What fits, but might as well lie elsewhere,
/// is doubtful.
PlanFit AutoCompleteGraph::Impl::plan_fit(const SolveInput& input, const MergedMap& merged, const Learnt& l) const {
  constexpr int kViewsForAVerdict = 4;  // one view from the start explains little of any plan
  double linked = 0, all = 0, agreed = 0, spoken = 0, doubted = 0;
  int views = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes.spaced()[i] && ++views)
      for (const ScanPiece& p : nodes.views()[i].pieces) all += p.segment.length();
  for (const PieceLink& link : input.links) linked += link.weight > 0.3 ? link.part_robot.length() : 0;
  for (const MergedWall& w : merged.walls) {
    const bool agrees = w.state == WallState::kConfirmed || w.state == WallState::kMoved;
    agreed += agrees ? w.evidence_m : 0;
    doubted += agrees ? w.evidence_m * line_doubt_of(l, static_cast<std::size_t>(*w.layout_wall)) : 0;
    spoken += w.state != WallState::kUnseen ? w.evidence_m : 0;
  }
  PlanFit fit;
  if (all < 10 || views < kViewsForAVerdict || !l.aligned) return fit;
  fit.score = 0.5 * (std::min(1.0, linked / all) + (spoken > 0 ? agreed / spoken : 0));
  fit.verdict = fit.score >= params.fits_above && doubted <= kMostDoubted * agreed ? "fits"
                : fit.score >= params.fits_not_below                               ? "doubtful"
                                                                                   : "does not fit";
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
    SolvedPlan solved{&layout, &*plan, &l.state, {}, l.linked_m, {}, {}, l.sigma_m, input.corners};
    const std::vector<double> no_ends(plan->walls.size(), 0);
    solved.evidence = l.beams.read(nodes.views(), nodes.spaced(), *plan, l.state, no_ends).walls;
    judge_walls(solved.evidence, l);
    solved.wall_states = l.walls;
    for (std::size_t w = 0; w < l.walls.size(); ++w) solved.doubt.push_back(doubt_of(l, w));
    read_out_plan(solved, params, out);
    for (const WallState s : l.walls) there.push_back(s != WallState::kMissing);
    out.anchors = read_anchors(l);
  }
  const bool with_plan = !there.empty();
  read_out_new_walls(
      find_new_walls(nodes.views(), nodes.spaced(), with_plan ? &*plan : nullptr, l.state, there, params), out);
  if (with_plan) out.robot_sigma_m = l.robot_sigma_m;
  if (with_plan) out.fit = plan_fit(input, out, l);
  l.fits = out.fit.verdict == "fits";
  return out;
}

/// Rounds over everything; a graph that only grew a little since the last time needs but the last of them.
Result<Ok> AutoCompleteGraph::Impl::correct(Learnt& l, bool warm, const Progress& progress, SolveInput& last) const {
  const int first = warm ? std::max(0, params.rounds - kWarmRounds) : 0;
  for (int k = first; k < params.rounds; ++k) {
    const PoseRange free_poses{0, k < params.rounds / 2 ? 0 : nodes.size()};
    const double sharpness = std::pow(0.6, k + 1);
    if (const auto done = round(l, nodes.spaced(), sharpness, free_poses, progress, &last); !done) return done.error();
    progress.tell(0.6 + 0.3 * (k + 1) / params.rounds, "correcting plan and map");
  }
  return Ok{};
}

Result<MergedMap> AutoCompleteGraph::Impl::update(const PoseGraph& graph, const Progress& progress) {
  Learnt work = learnt;
  const GraphChange change = nodes.take(graph, work.state);
  if (change == GraphChange::kAnother) work.beams = {};
  SolveInput input;
  if (plan && nodes.size() > 0) {
    bool warm = work.aligned && change == GraphChange::kGrown && !words_changed;
    if (!work.aligned) work.aligned = align(work);
    if (work.aligned) {
      warm = warm && nodes.way_m().back() - work.taken_way_m < kWarmWay_m;
      if (const auto done = take_up(work, progress); !done) return done.error();
      if (const auto done = correct(work, warm, progress, input); !done) return done.error();
      if (const auto done = question(work, input, progress); !done) return done.error();
      if (const auto done = rearrange(work, input, progress); !done) return done.error();
      if (const auto done = work_out_sigmas(input, graph, work); !done) return done.error();
      ++work.updates;
    } else {
      work.sigma_m.assign(plan->corners.size(), start ? 1.0 : 10.0);
    }
  }
  MergedMap out = read_out(graph, input, work);
  out.revision = ++revision;
  learnt = std::move(work);
  words_changed = false;
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
  (void)even_out(impl_->params, *model);
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
  impl_->pins.clear();
  impl_->lengths_m.clear();
  const GraphState poses{impl_->learnt.state.poses, {}, 0, 0, {}};
  impl_->learnt = {};
  impl_->learnt.state = poses;
}

void AutoCompleteGraph::set_start(const PlanStart& start) {
  impl_->start = start;
  impl_->learnt.aligned = false;
  impl_->learnt.aligned_way_m = 0;
  impl_->learnt.state.corners.clear();
}

void AutoCompleteGraph::add_anchor(const std::string& id, const Point2& p_layout_px, const Point2& p_map) {
  impl_->anchors[id] = {p_layout_px, p_map};
  impl_->words_changed = true;
  if (impl_->anchors.size() == 2 && !impl_->start) impl_->learnt.aligned = false, impl_->learnt.aligned_way_m = 0;
}

void AutoCompleteGraph::remove_anchor(const std::string& id) {
  impl_->anchors.erase(id);
  impl_->words_changed = true;
}

Result<Ok> AutoCompleteGraph::judge_wall(int layout_wall, WallJudgement judgement) {
  if (!impl_->plan || layout_wall < 0 || layout_wall >= static_cast<int>(impl_->plan->walls.size()))
    return fail(Errc::kNotFound, "the plan has no wall " + std::to_string(layout_wall));
  impl_->judgements[layout_wall] = judgement;
  impl_->words_changed = true;
  return Ok{};
}

Result<Ok> AutoCompleteGraph::pin_corner(int layout_corner, const std::optional<Point2>& p_map) {
  if (!impl_->plan || layout_corner < 0 || layout_corner >= static_cast<int>(impl_->plan->corners.size()))
    return fail(Errc::kNotFound, "the plan has no corner " + std::to_string(layout_corner));
  if (p_map && !p_map->allFinite()) return fail(Errc::kInvalidArgument, "a pin's place is not finite");
  if (p_map)
    impl_->pins[layout_corner] = *p_map;
  else
    impl_->pins.erase(layout_corner);
  impl_->words_changed = true;
  return Ok{};
}

Result<Ok> AutoCompleteGraph::set_wall_length(int layout_wall, const std::optional<double>& length_m) {
  if (!impl_->plan || layout_wall < 0 || layout_wall >= static_cast<int>(impl_->plan->walls.size()))
    return fail(Errc::kNotFound, "the plan has no wall " + std::to_string(layout_wall));
  if (length_m && !(*length_m > 0.05 && *length_m < 1000))
    return fail(Errc::kInvalidArgument, "a wall is not " + std::to_string(*length_m) + " m long");
  if (length_m)
    impl_->lengths_m[layout_wall] = *length_m;
  else
    impl_->lengths_m.erase(layout_wall);
  impl_->words_changed = true;
  return Ok{};
}

Result<MergedMap> AutoCompleteGraph::update(const PoseGraph& slam_graph, const Progress& progress) {
  return impl_->update(slam_graph, progress);
}

}  // namespace smokemap
