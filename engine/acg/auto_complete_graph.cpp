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

Result<Ok> AcgParams::validate() const {
  return ParamCheck("AcgParams")
      .positive("sigma_wall_log_length", sigma_wall_log_length)
      .positive("sigma_wall_turn_rad", sigma_wall_turn_rad)
      .positive("sigma_corner_draw_m", sigma_corner_draw_m)
      .positive("stretch_length_m", stretch_length_m)
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

PlanFit AutoCompleteGraph::Impl::plan_fit(const SolveInput& input, const Learnt& l) const {
  constexpr int kViewsForAVerdict = 4;  // one view from the start explains little of any plan
  double linked = 0, all = 0;
  int views = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes.spaced()[i] && ++views)
      for (const ScanPiece& p : nodes.views()[i].pieces) all += p.segment.length();
  for (const PieceLink& link : input.links) linked += link.weight > 0.3 ? link.part_robot.length() : 0;
  PlanFit fit;
  if (all < 10 || views < kViewsForAVerdict || !l.aligned) return fit;
  fit.score = std::min(1.0, linked / all);
  fit.verdict = fit.score >= params.fits_above       ? "fits"
                : fit.score >= params.fits_not_below ? "doubtful"
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
    SolvedPlan solved{&layout, &*plan, &l.state, {}, l.linked_m, {}, l.sigma_m, input.links};
    const std::vector<double> no_ends(plan->walls.size(), 0);
    solved.evidence = read_beams(nodes.views(), nodes.spaced(), *plan, l.state, no_ends).walls;
    judge_walls(solved.evidence, l);
    solved.wall_states = l.walls;
    read_out_plan(solved, params, out);
    for (const WallState s : l.walls) there.push_back(s != WallState::kMissing);
    out.fit = plan_fit(input, l);
  }
  const bool with_plan = !there.empty();
  read_out_new_walls(
      find_new_walls(nodes.views(), nodes.spaced(), with_plan ? &*plan : nullptr, l.state, there, params), out);
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
        if (const auto done = round(work, nodes.spaced(), sharpness, poses_fixed, progress, &input); !done)
          return done.error();
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
